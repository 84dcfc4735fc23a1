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

const int MOST_CONE_READS = 96, MOST_RAY_READS = 64;
const float LIFT_GRAINS = 1.0, LIFT_FADE_GRAINS = 8.0, LEAST_STEP_GRAINS = 0.5;
// Nothing in the field is sharper than this.
const float LEAST_WIDTH_GRAINS = 0.2;
// A sheet midway between texels is interpolated to nothing deeper than 0: what is as near as this is in the way.
const float BLOCKED_GRAINS = 0.05;
const float FADE = 0.8; // of the distance between rays, about
const float LIT = -1.0, DARK = -2.0;

uint shadowReads = 0u; // of this thread

struct ShadowReading {
  float distanceWorld;
  float grain;
};
// By whoever includes this: from the field alone, or with bricks.
ShadowReading readForShadow(vec3 pointAnchored);

// Where the middle of the cone is after t metres.
vec3 onAxis(ShadowCone cone, float t) {
  float lift = LIFT_GRAINS * cone.grain * max(1.0 - t / (LIFT_FADE_GRAINS * cone.grain), 0.0);
  return cone.origin + lift * cone.normal + t * cone.axis;
}

// How far the cone goes on inside a ball around its axis that nothing reaches into.
float stepInBall(float ball, float radius, float spread) {
  float along = radius * spread, a = 1.0 + spread * spread;
  return (sqrt(max(along * along + a * (ball * ball - radius * radius), 0.0)) - along) / a;
}

// returns metres along the axis where the cone is first touched; LIT, DARK: it is free, or all of it is blocked
float traceCone(ShadowCone cone) {
  float t = 0.0;
  for (int i = 0; i < MOST_CONE_READS; ++i) {
    ShadowReading reading = readForShadow(onAxis(cone, t));
    float radius = cone.spread * t, ball = reading.distanceWorld, touch = max(radius, LEAST_WIDTH_GRAINS * reading.grain);
    if (ball < -touch) return DARK;
    if (ball < touch) return t;
    t += max(stepInBall(ball, radius, cone.spread), LEAST_STEP_GRAINS * reading.grain);
    if (t >= cone.end) return LIT;
  }
  return t;
}

// How free a ray is, where it is touched most, fading over `share` of the cone's radius so that few rays show no steps.
// The fade would go on as far inside, but sheets reach no depth: it ends where a ray is sure to meet them. Before the
// light itself it narrows, lest what holds a panel dims it.
// across  to which part of the light, metres a metre along the axis
float traceRay(ShadowCone cone, vec3 across, float share, float start) {
  float pace = inversesqrt(dot(cone.axis + across, cone.axis + across)), horizon = dot(cone.normal, cone.axis + across) * pace;
  float t = start, free = clamp(0.5 + horizon / max(share * cone.spread, 1e-4), 0.0, 1.0);
  if (free <= 0.0) return 0.0;
  for (int i = 0; i < MOST_RAY_READS; ++i) {
    ShadowReading reading = readForShadow(onAxis(cone, t) + t * across);
    float width = max(min(share * cone.spread * t, 0.5 * (cone.lightAt - t)), LEAST_WIDTH_GRAINS * reading.grain);
    free = min(free, (reading.distanceWorld - BLOCKED_GRAINS * reading.grain) / width);
    if (free <= 0.0) return 0.0;
    t += pace * max(reading.distanceWorld, LEAST_STEP_GRAINS * reading.grain);
    if (t >= cone.end) return free;
  }
  return 0.0; // what creeps along a surface for so long
}

// The visible share of the light, 0 to 1.
//
// rays      at most so many
// softness  of the fade between them: 1 as wide as they are apart, about
float shadowOf(ShadowCone cone, int rays, float softness) {
  if (dot(cone.normal, cone.axis) < -cone.spread) return 0.0; // behind the surface's horizon
  float start = traceCone(cone);
  if (start < 0.0) return start == LIT ? 1.0 : 0.0;
  if (cone.spread == 0.0) rays = 1;
  float sum = 0.0, share = softness * FADE * inversesqrt(float(rays));
  // Of a rectangle, of the disk of its area: 4 a b / pi.
  if (cone.isRectangle) share *= sqrt(1.2732395 * length(cone.right) * length(cone.up)) / cone.spread;
  for (int i = 0; i < rays; ++i) {
    vec2 part = partOfLight(cone, i, rays);
    sum += traceRay(cone, part.x * cone.right + part.y * cone.up, share, start);
  }
  return sum / float(rays);
}
