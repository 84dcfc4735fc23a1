// The estimators that others have published, for comparison; each reads the world field alone, along one ray to the
// middle of the light unless it says otherwise. All of them treat the light as a disk.
#include "lib/shadow_cone.glsl"

const uint ESTIMATOR_HARD = 1u, ESTIMATOR_MIN_RATIO = 2u, ESTIMATOR_COVERAGE = 3u, ESTIMATOR_RTSDF = 4u,
           ESTIMATOR_UMBRA = 5u;
const int MOST_MARCH_READS = 128; // the RTSDF paper's number

uint shadowReads = 0u; // of this thread

float readForMarch(vec3 pointAnchored) {
  ++shadowReads;
  return fieldDistanceWorld(pointAnchored);
}

// Where all of them start: lifted off the surface by a texel, the least that the RTSDF paper (2.5.3) allows.
vec3 marchStart(ShadowCone cone) { return cone.origin + cone.grain * cone.normal; }

// A ray that comes nearer to a surface than a tenth of a texel is dark; so is one that runs out of reads.
float hardShadow(ShadowCone cone, vec3 direction) {
  vec3 start = marchStart(cone);
  float t = 0.0;
  for (int i = 0; i < MOST_MARCH_READS; ++i) {
    float near = readForMarch(start + t * direction);
    if (near < 0.1 * cone.grain) return 0.0;
    t += near;
    if (t >= cone.end) return 1.0;
  }
  return 0.0;
}

// The least k d / t along the ray (the ray marching lecture; the thesis, 7.1, after Quilez): k is one over the light's
// spread, at which the least that still shines is what touches the light's rim.
float minRatioShadow(ShadowCone cone) {
  vec3 start = marchStart(cone);
  float t = cone.grain, free = 1.0, k = 1.0 / max(cone.spread, 1e-4);
  for (int i = 0; i < MOST_MARCH_READS; ++i) {
    float near = abs(readForMarch(start + t * cone.axis));
    if (near < 0.1 * cone.grain) return 0.0;
    free = min(free, k * near / t);
    t += near;
    if (t >= cone.end) return free;
  }
  return free;
}

// Of a disk of radius 1 what lies on the free side of a straight edge, `along` from its middle.
float diskBeyondEdge(float along) {
  float x = clamp(along, -1.0, 1.0);
  return 0.5 + (x * sqrt(1.0 - x * x) + asin(x)) / 3.14159265;
}

// A signed march: goes on through what it meets, and takes the least share of the disk that a straight edge at the
// signed distance would leave free. Distances inside never exceed half a thickness, so that walls and sheets leak.
float coverageShadow(ShadowCone cone) {
  vec3 start = marchStart(cone);
  float t = cone.grain, free = 1.0;
  for (int i = 0; i < MOST_MARCH_READS; ++i) {
    float near = readForMarch(start + t * cone.axis), radius = max(cone.spread * t, 0.1 * cone.grain);
    free = min(free, diskBeyondEdge(near / radius));
    if (free <= 0.0) return 0.0;
    t += max(abs(near), 0.5 * cone.grain);
    if (t >= cone.end) return free;
  }
  return free;
}

uint hashOf(uvec3 value) {
  uint x = value.x * 1597334677u ^ value.y * 3812015801u ^ value.z * 2798796415u;
  x = (x ^ x >> 15) * 0x2c1b3c6du;
  x = (x ^ x >> 12) * 0x297a2d39u;
  return x ^ x >> 15;
}
float unitOf(uint hash) { return float(hash >> 8) * (1.0 / 16777216.0); }

// RTSDF, 2.5.2: the least k d / t, where d and t are of the point between two samples that triangulation (Aaltonen 2018)
// takes for the nearest; no step longer than `mostStep`; the start jittered by up to a texel.
float rtsdfShadow(ShadowCone cone, float mostStep, uvec3 seed) {
  vec3 start = marchStart(cone);
  float t = cone.grain * (1.0 + unitOf(hashOf(seed))), free = 1.0, k = 1.0 / max(cone.spread, 1e-4), before = 1e20;
  for (int i = 0; i < MOST_MARCH_READS; ++i) {
    float near = readForMarch(start + t * cone.axis);
    if (near < 0.1 * cone.grain) return 0.0;
    float back = near * near / (2.0 * before), aside = sqrt(max(near * near - back * back, 0.0));
    free = min(free, k * aside / max(t - back, 1e-6));
    before = near;
    t += min(near, mostStep);
    if (t >= cone.end) return free;
  }
  return free;
}

// RTSDF, 3.3: rays to random points of the light, each weighted by how near it came to anything, so that less noise
// is left: here one is free where nothing came nearer than half the light's radius divided by the root of their number.
float umbraShadow(ShadowCone cone, int rays, float mostStep, uvec3 seed) {
  vec3 start = marchStart(cone);
  float sum = 0.0, k = 2.0 * sqrt(float(rays)) / max(cone.spread, 1e-4);
  for (int ray = 0; ray < rays; ++ray) {
    uint random = hashOf(seed + uvec3(0u, 0u, 7919u * uint(ray + 1)));
    float radius = sqrt(unitOf(random)), angle = 6.2831853 * unitOf(hashOf(uvec3(random, seed.xy)));
    vec2 part = cone.isRectangle ? 2.0 * vec2(unitOf(random), angle / 6.2831853) - 1.0 : radius * vec2(cos(angle), sin(angle));
    vec3 direction = normalize(cone.axis + part.x * cone.right + part.y * cone.up);
    float t = cone.grain, free = 1.0;
    for (int i = 0; i < MOST_MARCH_READS && t < cone.end; ++i) {
      float near = readForMarch(start + t * direction);
      free = near < 0.1 * cone.grain ? 0.0 : min(free, k * near / t);
      if (free <= 0.0) break;
      t += min(near, mostStep);
    }
    sum += free;
  }
  return sum / float(rays);
}

float publishedShadow(ShadowCone cone, uint estimator, int rays, float mostStep, uvec3 seed) {
  if (dot(cone.normal, cone.axis) <= 0.0) return 0.0;
  switch (estimator) {
    case ESTIMATOR_MIN_RATIO: return minRatioShadow(cone);
    case ESTIMATOR_COVERAGE: return coverageShadow(cone);
    case ESTIMATOR_RTSDF: return rtsdfShadow(cone, mostStep, seed);
    case ESTIMATOR_UMBRA: return umbraShadow(cone, rays, mostStep, seed);
    default: return hardShadow(cone, cone.axis);
  }
}
