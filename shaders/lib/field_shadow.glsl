// Soft shadows from the world field, and from bricks where it is too coarse. One cone from the point to the whole light
// goes first: most points see all of the light or none of it, a read a step. Where something first reaches into the
// cone, narrow rays go on from there to parts of the light, a share of it each.
//
//        light            p: point, lifted off its surface by a grain, which fades out over eight
//      \  ---  /          t: first touched; from there on the rays
//       \ | | /
//        \|||/ ___ caster
//         \|/ t
//          p
// A grain is what nothing in a reading is finer than: a texel of the field, a voxel of bricks.
#include "lib/shadow_cone.glsl"

const int MOST_CONE_READS = 96, MOST_BACK_READS = 32, MOST_RAY_READS = 64;
const float LIFT_GRAINS = 1.0, LIFT_FADE_GRAINS = 8.0, LEAST_STEP_GRAINS = 0.5;
// Nothing in the field is sharper than this.
const float LEAST_WIDTH_GRAINS = 0.2;
// A sheet midway between texels is interpolated to nothing deeper than 0: what is as near as this is in the way.
const float BLOCKED_GRAINS = 0.05;
// Of what a ball permits.
const float RELAXED = 1.6;
// Of a penumbra's radius for each ray: where steps are narrower than this none are seen, and sharing would only blur.
const float SHARED_PIXELS = 1.0;
const int LEAST_SURE_RAYS = 3;
const float FADE = 0.7; // of the distance between rays, about
const float LIT = -1.0, DARK = -2.0;

uint shadowReads = 0u; // of this thread
bool isMeanOfCell = false; // what was traced last, see partOfLight

struct ShadowReading {
  float distanceWorld;
  float grain;
};
// By whoever includes this: from the field alone, or with bricks.
//
// fineMetres  what is told apart: distances beyond it are all the same but for steps
ShadowReading readForShadow(vec3 pointAnchored, float fineMetres);
// Metres to the objects with bricks that the last reading was of, near it; much where it was of the field alone.
float distanceToRead(vec3 pointAnchored, float most);

// Where the middle of the cone is after t metres.
vec3 onAxis(ShadowCone cone, float t) {
  float lift = LIFT_GRAINS * cone.grain * max(1.0 - t / (LIFT_FADE_GRAINS * cone.grain), 0.0);
  return cone.origin + lift * cone.normal + t * cone.axis;
}

// How far the cone goes on, and back (y), inside a ball around its axis that nothing reaches into.
vec2 wayInBall(float ball, float radius, float spread) {
  float along = radius * spread, a = 1.0 + spread * spread;
  float reach = sqrt(max(along * along + a * (ball * ball - radius * radius), 0.0));
  return vec2(reach - along, reach + along) / a;
}

// Whether an object that the first reading was of, a saucer over the floor, lies between the surface and where the cone
// begins: from there back down, as far as the surface itself cannot be meant.
bool isLiftedThrough(ShadowCone cone, ShadowReading first) {
  const float LEAST_STEP = 0.1, OWN_SURFACE_GRAINS = 2.0;
  float lift = LIFT_GRAINS * cone.grain, above = lift, ball = first.distanceWorld;
  for (int i = 0; i < 10; ++i) {
    above -= max(ball, LEAST_STEP * lift);
    if (above < OWN_SURFACE_GRAINS * first.grain) return false;
    ball = distanceToRead(cone.origin + above * cone.normal, lift);
    if (ball < 0.0) return true;
  }
  return false;
}

// Steps go farther than a ball (Keinert and others 2014): where the next ball does not reach back to it, they go back.
//
// returns metres along the axis where the cone is first touched; LIT, DARK: it is free, or all of it is blocked
float traceCone(ShadowCone cone) {
  float t = 0.0, sure = 0.0; // metres; free up to there
  float relaxed = RELAXED;
  for (int i = 0; i < MOST_CONE_READS; ++i) {
    float radius = cone.spread * t;
    ShadowReading reading = readForShadow(onAxis(cone, t), radius);
    float ball = reading.distanceWorld, touch = max(radius, LEAST_WIDTH_GRAINS * reading.grain);
    if (i == 0 && reading.grain < cone.grain && isLiftedThrough(cone, reading)) return DARK;
    vec2 way = wayInBall(ball, radius, cone.spread);
    if (t > sure && (ball < touch || t - way.y > sure)) {
      t = sure;
      relaxed = 1.0;
      continue;
    }
    if (ball < -touch) return DARK;
    if (ball < touch) return t;
    float on = max(way.x, LEAST_STEP_GRAINS * reading.grain);
    sure = t + on;
    if (sure >= cone.end) return LIT;
    t = min(t + relaxed * on, cone.end);
    relaxed = RELAXED;
  }
  return sure;
}

// From the light backwards: metres along the axis, beyond which the cone is free.
float lastTouched(ShadowCone cone, float start) {
  float t = cone.end;
  for (int i = 0; i < MOST_BACK_READS && t > start; ++i) {
    float radius = cone.spread * t;
    ShadowReading reading = readForShadow(onAxis(cone, t), radius);
    if (reading.distanceWorld < max(radius, LEAST_WIDTH_GRAINS * reading.grain)) return t;
    t -= max(wayInBall(reading.distanceWorld, radius, cone.spread).y, LEAST_STEP_GRAINS * reading.grain);
  }
  return max(t, start);
}

// How free a ray is, where it is touched most, fading over `share` of the cone's radius so that few rays show no steps.
// The fade would go on as far inside, but sheets reach no depth: let half of it begin at the surface, and thin closed things
// leak (a saucer). Before the light itself the fade narrows, lest what holds a panel dims it.
// across      to which part of the light, metres a metre along the axis
// start, end  metres along the axis, beyond which nothing is in the way
float traceRay(ShadowCone cone, vec3 across, float share, float start, float end) {
  float pace = inversesqrt(dot(cone.axis + across, cone.axis + across)), horizon = dot(cone.normal, cone.axis + across) * pace;
  float t = start, free = clamp(0.5 + horizon / max(share * cone.spread, 1e-4), 0.0, 1.0);
  if (free <= 0.0) return 0.0;
  for (int i = 0; i < MOST_RAY_READS; ++i) {
    float width = min(share * cone.spread * t, 0.5 * (cone.lightAt - t));
    ShadowReading reading = readForShadow(onAxis(cone, t) + t * across, width);
    float ball = reading.distanceWorld;
    float past = ball - BLOCKED_GRAINS * reading.grain;
    if (past <= 0.0) return 0.0;
    free = min(free, past / max(width, LEAST_WIDTH_GRAINS * reading.grain));
    t += pace * max(ball, LEAST_STEP_GRAINS * reading.grain);
    if (t >= end) return free;
  }
  return 0.0; // what creeps along a surface for so long
}

// The visible share of the light, 0 to 1. Every second ray goes first: where all of these see the light, or none does,
// so do the others.
//
// rays      at most so many
// softness  of the fade between them: 1 as wide as they are apart, about
// cell      of partOfLight
float shadowOf(ShadowCone cone, int rays, float softness, int cell) {
  isMeanOfCell = false;
  if (dot(cone.normal, cone.axis) < -cone.spread) return 0.0; // behind the surface's horizon
  float start = traceCone(cone);
  if (start < 0.0) return start == LIT ? 1.0 : 0.0;
  if (cone.spread == 0.0) rays = 1;
  isMeanOfCell = cone.spread * start > SHARED_PIXELS * float(rays) * cone.pixel;
  float sum = 0.0, share = softness * FADE * inversesqrt(float(rays));
  // Of a rectangle, of the disk of its area: 4 a b / pi.
  if (cone.isRectangle) share *= sqrt(1.2732395 * length(cone.right) * length(cone.up)) / cone.spread;
  int first = (rays + 1) / 2;
  float end = cone.end;
  for (int i = 0; i < rays; ++i) {
    if (i == first && first >= LEAST_SURE_RAYS && sum == float(first)) return sum / float(first);
    int ray = i < first ? 2 * i : 2 * (i - first) + 1;
    vec2 part = isMeanOfCell ? partOfLight(cone, ray, rays, cell) : partOfLight(cone, ray, rays);
    float free = traceRay(cone, part.x * cone.right + part.y * cone.up, share, start, end);
    if (free > 0.0 && sum == 0.0 && i < rays - 1) end = lastTouched(cone, start); // others may end there
    sum += free;
  }
  return sum / float(rays);
}
