// Soft shadows from the world field. One cone from the point to the whole light goes first: most points see all of the
// light or none of it, a read a step. Where something first reaches into the cone, narrow rays go on from there over
// the light's disk, a share of it each.
//
//        light            p: point, lifted off its surface by a texel, which fades out over eight
//      \  ---  /          t: first touched; from there on the rays
//       \ | | /
//        \|||/ ___ caster
//         \|/ t
//          p
#include "lib/world_field.glsl"

const int MOST_CONE_READS = 96, MOST_RAY_READS = 64;
const float LIFT_TEXELS = 1.0, LIFT_FADE_TEXELS = 8.0, LEAST_STEP_TEXELS = 0.5;
// Nothing in the field is sharper than this.
const float LEAST_WIDTH_TEXELS = 0.2;
const float SURE_DEPTH_TEXELS = 0.4;
const float FADE = 0.8; // of the distance between rays, about
const float LIT = -1.0, DARK = -2.0;

struct ShadowCone {
  vec3 origin; // anchored; on the surface
  vec3 normal; // of the surface, unit
  vec3 axis;   // to the middle of the light, unit
  float spread; // radius a metre
  float end;    // metres: the light is there
  float texel;  // metres, of the field at the origin
};

uint shadowReads = 0u; // of this thread

struct ShadowReading {
  float distanceWorld;
  float texel;
};

ShadowReading readForShadow(vec3 pointAnchored) {
  ++shadowReads;
  FieldReading reading = readWorldField(pointAnchored);
  return ShadowReading(reading.distanceWorld,
                       field.cascades[reading.cascade < 0 ? int(field.counts.x) - 1 : reading.cascade].texel.x);
}

// Where the middle of the cone is after t metres.
vec3 onAxis(ShadowCone cone, float t) {
  float lift = LIFT_TEXELS * cone.texel * max(1.0 - t / (LIFT_FADE_TEXELS * cone.texel), 0.0);
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
    float radius = cone.spread * t, ball = reading.distanceWorld;
    if (ball < -max(radius, LEAST_WIDTH_TEXELS * reading.texel)) return DARK;
    if (ball < max(radius, LEAST_WIDTH_TEXELS * reading.texel)) return t;
    t += max(stepInBall(ball, radius, cone.spread), LEAST_STEP_TEXELS * reading.texel);
    if (t >= cone.end) return LIT;
  }
  return t;
}

// How free a ray is, where it is touched most, fading over `share` of the cone's radius so that few rays show no steps.
// It is blocked no deeper than things are sure to reach, which are a texel thick at least: deep within a wide fade the
// umbrae of sheets would be lit.
// across  where on the light's disk it goes, radius 1, as a vector of the world
float traceRay(ShadowCone cone, vec3 across, float share, float start) {
  float t = start, free = 1.0;
  for (int i = 0; i < MOST_RAY_READS; ++i) {
    ShadowReading reading = readForShadow(onAxis(cone, t) + t * cone.spread * across);
    float width = max(share * cone.spread * t, LEAST_WIDTH_TEXELS * reading.texel);
    float depth = min(0.5 * width, SURE_DEPTH_TEXELS * reading.texel);
    free = min(free, (reading.distanceWorld + depth) / width);
    if (free <= 0.0) return 0.0;
    t += max(reading.distanceWorld, LEAST_STEP_TEXELS * reading.texel);
    if (t >= cone.end) return free;
  }
  return 0.0; // what creeps along a surface for so long
}

// The visible share of the light, 0 to 1.
//
// rays  at most so many
float shadowOf(ShadowCone cone, int rays) {
  if (dot(cone.normal, cone.axis) < -cone.spread) return 0.0; // behind the surface's horizon
  float start = traceCone(cone);
  if (start < 0.0) return start == LIT ? 1.0 : 0.0;
  vec3 right = normalize(abs(cone.axis.y) < 0.9 ? vec3(cone.axis.z, 0.0, -cone.axis.x) : vec3(0.0, -cone.axis.z, cone.axis.y));
  vec3 up = cross(right, cone.axis);
  if (cone.spread == 0.0) rays = 1;
  float sum = 0.0;
  for (int i = 0; i < rays; ++i) { // Vogel's spiral: equal shares of the disk
    float radius = rays == 1 ? 0.0 : sqrt((float(i) + 0.5) / float(rays)), angle = 2.39996323 * float(i);
    sum += traceRay(cone, radius * (cos(angle) * right + sin(angle) * up), FADE * inversesqrt(float(rays)), start);
  }
  return sum / float(rays);
}
