// Soft shadows from the world field, and from bricks where it is too coarse. One cone from the point to the whole light
// goes first: most points see all of the light or none of it, a read a step. Where something first reaches into the
// cone, narrow rays go on from there to parts of the light, a share of it each.
//
//        light            p: point, lifted off its surface by a grain, which fades out as the light climbs
//      \  ---  /          t: first touched; from there on the rays
//       \ | | /
//        \|||/ ___ caster
//         \|/ t
//          p
// A grain is what nothing in a reading is finer than: a texel of the field, a voxel of bricks.
#include "lib/shadow_cone.glsl"

const int MOST_CONE_READS = 96, MOST_RAY_READS = 64;
// Steps of 0.6 pass through some of the slabs that bricks hold for sheets.
const float LIFT_GRAINS = 1.0, LEAST_STEP_GRAINS = 0.5;
// The lift fades by this part of what the light climbs over the surface, so that the way never sinks back into it, but
// ends after so many grains.
const float LIFT_FADE = 0.67, MOST_LIFT_FADE_GRAINS = 16.0;
// What hard edges fade over.
const float LEAST_WIDTH_GRAINS = 0.1;
// A sheet midway between texels is interpolated to nothing deeper than 0: what is as near as this is in the way.
const float BLOCKED_GRAINS = 0.01;
// Of what a ball permits.
const float RELAXED = 1.6;
// Of a penumbra's radius for each ray: where steps are narrower than this none are seen, and sharing would only blur.
const float SHARED_PIXELS = 1.0;
const int LEAST_SURE_RAYS = 3;
const float FADE = 0.5; // of the distance between rays, about
const float LEAD = 8.0; // see traceRay
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

// On the way to a part of the light, after t metres along the axis. Where bricks end, or a cascade, the field begins to
// make the surface thicker than the lift: what lies in the way there is asked once more, a coarser grain higher.
//
// across      metres a metre along the axis
// fineMetres  what is told apart, and what touches the reader
ShadowReading readOnWay(ShadowCone cone, vec3 across, float t, float fineMetres) {
  float climbed = t * max(LIFT_FADE * dot(cone.normal, cone.axis), LIFT_GRAINS / MOST_LIFT_FADE_GRAINS), grain = cone.grain;
  ShadowReading reading;
  for (int i = 0; i < 2; ++i) {
    vec3 lift = max(LIFT_GRAINS * grain - climbed, 0.0) * cone.normal;
    reading = readForShadow(cone.origin + lift + t * (cone.axis + across), fineMetres);
    bool isTouched = reading.distanceWorld < max(fineMetres, LEAST_WIDTH_GRAINS * reading.grain);
    if (!isTouched || reading.grain <= grain || LIFT_GRAINS * reading.grain <= climbed) break;
    grain = reading.grain;
  }
  return reading;
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

// A point at a wall's foot lies within the half texel that the field adds to sheets. The light comes from the free side
// where the way leads out of it from the first small step on: from the far side it would cross the sheet first.
//
// returns metres along the axis, out of it; DARK
float leaveNeighbour(ShadowCone cone, float ball) {
  const float STEP_GRAINS = 0.2, LEAST_RISE_GRAINS = 0.02;
  for (int i = 1; i <= 8; ++i) {
    float t = float(i) * STEP_GRAINS * cone.grain;
    ShadowReading reading = readOnWay(cone, vec3(0.0), t, 0.0);
    if (reading.distanceWorld < ball + LEAST_RISE_GRAINS * cone.grain) return DARK;
    ball = reading.distanceWorld;
    if (ball > LEAST_WIDTH_GRAINS * reading.grain) return t;
  }
  return DARK;
}

// Steps go farther than a ball (Keinert and others 2014): where the next ball does not reach back to it, they go back.
//
// returns metres along the axis where the cone is first touched; LIT, DARK: it is free, or all of it is blocked
float traceCone(ShadowCone cone) {
  float t = 0.0, sure = 0.0; // metres; free up to there
  float relaxed = RELAXED;
  for (int i = 0; i < MOST_CONE_READS; ++i) {
    float radius = cone.spread * t;
    ShadowReading reading = readOnWay(cone, vec3(0.0), t, radius);
    float ball = reading.distanceWorld, touch = max(radius, LEAST_WIDTH_GRAINS * reading.grain);
    if (i == 0 && reading.grain < cone.grain && isLiftedThrough(cone, reading)) return DARK;
    if (i == 0 && ball < touch) {
      sure = t = leaveNeighbour(cone, ball);
      if (t < 0.0) return DARK;
      continue;
    }
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

// How free a ray is, where it is touched most. It is blocked at the surface; just outside it is free to LEAD / (1 + LEAD),
// for were it darker, all edges would move outwards and gaps narrower than the fade go dark; few rays then show steps,
// which the sharing of pixels hides where penumbrae are wide, and a small fade where they are narrow. The fade would go on
// inside, but sheets reach no depth: let it begin there, and thin closed things leak (a saucer). Before the light itself it
// narrows, lest what holds a panel dims it.
// across      to which part of the light, metres a metre along the axis
// share       of the cone's radius to fade over
// start       metres along the axis, nothing is in the way before
float traceRay(ShadowCone cone, vec3 across, float share, float start) {
  float pace = inversesqrt(dot(cone.axis + across, cone.axis + across)), horizon = dot(cone.normal, cone.axis + across) * pace;
  float t = start, free = clamp(0.5 + horizon / max(share * cone.spread, 1e-4), 0.0, 1.0);
  if (free <= 0.0) return 0.0;
  for (int i = 0; i < MOST_RAY_READS; ++i) {
    float width = min(share * cone.spread * t, 0.5 * (cone.lightAt - t));
    ShadowReading reading = readOnWay(cone, across, t, width);
    float ball = reading.distanceWorld;
    float past = ball - BLOCKED_GRAINS * reading.grain;
    if (past <= 0.0) return 0.0;
    free = min(free, (past + LEAD * width) / (max(width, LEAST_WIDTH_GRAINS * reading.grain) + LEAD * width));
    t += pace * max(ball, LEAST_STEP_GRAINS * reading.grain);
    if (t >= cone.end) return free;
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
  for (int i = 0; i < rays; ++i) {
    if (i == first && first >= LEAST_SURE_RAYS && sum == float(first)) return sum / float(first);
    int ray = i < first ? 2 * i : 2 * (i - first) + 1;
    vec2 part = isMeanOfCell ? partOfLight(cone, ray, rays, cell) : partOfLight(cone, ray, rays);
    sum += traceRay(cone, part.x * cone.right + part.y * cone.up, share, start);
  }
  return sum / float(rays);
}
