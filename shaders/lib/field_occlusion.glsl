// How much of the hemisphere over a point is open, by the cosine, from the world field. Three ways: five taps along the
// normal (Evans 2006, the lecture), the same along a few rays of the hemisphere (thesis 7.2.2), and narrow cones that
// are traced. Taps compare distances with what an open plane would give, so that a plane is open to the last bit.
#include "lib/world_field.glsl"
#include "shared/field_occlusion_params.h"

struct OcclusionPoint {
  vec3 origin; // anchored; on the surface
  vec3 normal; // of the surface, unit
  float texel; // metres, of the field there
};

struct OcclusionSearch {
  int form;     // OCCLUSION_*
  int cones;    // a point
  float radius; // metres: what is farther hides nothing
};

const int TAPS = 5, TAP_RAYS = 5, MOST_OCCLUSION_READS = 48;
const float OCCLUSION_LIFT_TEXELS = 1.25, OCCLUSION_LIFT_FADE = 0.67, MOST_OCCLUSION_FADE_TEXELS = 16.0;
const float OCCLUSION_LEAST_STEP_TEXELS = 0.5, LEAVING_STEP_TEXELS = 0.3, LEAST_RISE_TEXELS = 0.01;
// Of its way a cone is so wide that neighbours of one spiral touch, times this; wider ones fatten what they pass.
const float CONE_SHARE = 0.2;
// A cone over an open plane rises by its cosine; as wide as this part of it, errors of the field do not reach it.
const float CONE_CLEAR = 0.5;
const float LEAST_CONE_TEXELS = 0.2;
// A sheet midway between texels is interpolated to nothing deeper than 0.
const float BLOCKED_TEXELS = 0.01;
// A cone ends so much before the radius: what a reading there tells of lies beyond it.
const float END_TEXELS = 0.5;
const float CONE_LEAD = 16.0; // just outside of things a cone is free to lead / (1 + lead)
const float OCCLUSION_GOLDEN_ANGLE = 2.39996323;

uint occlusionReads = 0u; // of this thread

FieldReading readForOcclusion(vec3 pointAnchored) {
  ++occlusionReads;
  return readWorldField(pointAnchored);
}

float texelOfReading(FieldReading reading) {
  return field.cascades[reading.cascade < 0 ? int(field.counts.x) - 1 : reading.cascade].texel.x;
}

// Right, up, normal.
mat3 basisOfNormal(vec3 normal) {
  vec3 right = normalize(abs(normal.y) < 0.9 ? vec3(normal.z, 0.0, -normal.x) : vec3(0.0, -normal.z, normal.y));
  return mat3(right, cross(normal, right), normal);
}

// Weights halve from tap to tap: near things hide most. A texel off the surface, for sheets are thick in the field.
float openOfTaps(OcclusionPoint point, vec3 direction, float radius) {
  vec3 origin = point.origin + OCCLUSION_LIFT_TEXELS * point.texel * point.normal;
  float cosine = dot(point.normal, direction), missing = 0.0, most = 0.0, weight = 0.5;
  for (int i = 1; i <= TAPS; ++i, weight *= 0.5) {
    float way = radius * float(i) / float(TAPS);
    float open = way * cosine, found = readForOcclusion(origin + way * direction).distanceWorld;
    missing += weight * clamp(open - found, 0.0, open);
    most += weight * open;
  }
  return 1.0 - missing / most;
}

// One of a spherical Fibonacci hemisphere (Keinert and others 2015): equal solid angles, weighed by the cosine.
float openOfTapRay(OcclusionPoint point, float radius, int ray) {
  float cosine = 1.0 - (float(ray) + 0.5) / float(TAP_RAYS), sine = sqrt(1.0 - cosine * cosine);
  float angle = OCCLUSION_GOLDEN_ANGLE * float(ray);
  vec3 direction = basisOfNormal(point.normal) * vec3(sine * cos(angle), sine * sin(angle), cosine);
  return cosine / (0.5 * float(TAP_RAYS)) * openOfTaps(point, direction, radius);
}

// How free a cone is where it is touched most; as traceRay of lib/field_shadow.glsl, from a surface on: the lift fades by
// what the cone climbs, and a cone that begins beside a sheet, within the half texel that the field adds to it, may leave it.
float openOfCone(OcclusionPoint point, vec3 direction, float spread, float radius) {
  float cosine = dot(point.normal, direction);
  spread = min(spread, CONE_CLEAR * cosine);
  float fade = max(OCCLUSION_LIFT_FADE * cosine, OCCLUSION_LIFT_TEXELS / MOST_OCCLUSION_FADE_TEXELS);
  float t = 0.0, end = radius, free = 1.0, within = -3e38; // the last reading while it was within what it begins beside
  for (int i = 0; i < MOST_OCCLUSION_READS && t < end; ++i) {
    float lift = max(OCCLUSION_LIFT_TEXELS * point.texel - fade * t, 0.0);
    FieldReading reading = readForOcclusion(point.origin + lift * point.normal + t * direction);
    if (reading.cascade < 0 && t > 0.0) break; // outside of the field nothing is known to hide anything
    float texel = texelOfReading(reading), past = reading.distanceWorld - BLOCKED_TEXELS * texel;
    end = radius - END_TEXELS * texel;
    if (past <= 0.0) {
      if (reading.distanceWorld < within + LEAST_RISE_TEXELS * texel) return 0.0;
      within = reading.distanceWorld;
      t += LEAVING_STEP_TEXELS * texel;
      continue;
    }
    within = 3e38;
    float width = spread * t;
    free = min(free, (past + CONE_LEAD * width) / (max(width, LEAST_CONE_TEXELS * texel) + CONE_LEAD * width));
    t += max(reading.distanceWorld, OCCLUSION_LEAST_STEP_TEXELS * texel);
  }
  return free;
}

// Directions by the cosine: a spiral of equal parts of the disk below the hemisphere, turned and shifted by the place in
// the pattern, so that all of a square together have as many times more.
//
// cell  0 to OCCLUSION_PATTERN_SIDE² - 1
float openOfSpiralCone(OcclusionPoint point, OcclusionSearch search, uint cell, int cone) {
  const float cells = float(OCCLUSION_PATTERN_SIDE * OCCLUSION_PATTERN_SIDE);
  float turn = 6.2831853 * float(bitfieldReverse(cell) >> 28) / cells, shift = (float(cell) + 0.5) / cells;
  float spread = CONE_SHARE * inversesqrt(float(search.cones));
  float disk2 = (float(cone) + shift) / float(search.cones), angle = OCCLUSION_GOLDEN_ANGLE * float(cone) + turn;
  vec3 direction = basisOfNormal(point.normal) * vec3(sqrt(disk2) * vec2(cos(angle), sin(angle)), sqrt(1.0 - disk2));
  return openOfCone(point, direction, spread, search.radius) / float(search.cones);
}

OcclusionPoint occlusionPoint(vec3 origin, vec3 normal) {
  return OcclusionPoint(origin, normal, texelOfReading(readForOcclusion(origin)));
}

// The open share, 0 to 1, is the sum of so many parts.
int partsOfOcclusion(OcclusionSearch search) {
  return search.form == OCCLUSION_TAPS ? 1 : search.form == OCCLUSION_RAYS ? TAP_RAYS : search.cones;
}

// As with shadows the cell may be any of the pattern's.
float openPart(OcclusionPoint point, OcclusionSearch search, uint cell, int part) {
  switch (search.form) {
    case OCCLUSION_TAPS: return openOfTaps(point, point.normal, search.radius);
    case OCCLUSION_RAYS: return openOfTapRay(point, search.radius, part);
    default: return openOfSpiralCone(point, search, cell, part);
  }
}
