// Leaf cards are thinner than any field can show, and stored as slabs a voxel thick: where a ray meets one aslant it is
// asked where it crosses the card within. The twin of field/card_crossing.cpp, which says how.
#include "lib/brick_attributes.glsl"

const float CARD_AXES = 127.0, CARD_GOLDEN_ANGLE = 2.39996323;
const uint CARD_UNLIT = 128u, CARD_UNLIT_NONE = 255u;
const float CARD_STEEP_FACING = 0.5;
const float CARD_ASIDE_VOXELS = 1.25, CARD_FIRST_VOXELS = 0.5, CARD_APART_VOXELS = 2.0, CARD_MOST_WAY_VOXELS = 32.0;
const float CARD_LEAST_SLOPE = 1e-3;

vec3 cardAxis(uint number) {
  float z = (float(number) + 0.5) / CARD_AXES, angle = CARD_GOLDEN_ANGLE * float(number);
  return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z);
}

// Of the sample nearest to a point.
uint cardByteAt(SdfLevel level, vec3 pointLevel) {
  vec3 p = clamp(pointLevel, vec3(0.0), vec3(level.cells.yzw * BRICK_CELLS));
  ivec3 brick = brickOfPoint(level, p);
  ivec3 texel = texelOfSlot(cellOfBrick(level.attributes.x, level, brick)) + ivec3(floor(p - vec3(brick) * float(BRICK_CELLS) + 0.5));
  return uint(texelFetch(brick_material, texel, 0).a * 255.0 + 0.5);
}

float heightOverCard(SdfLevel level, vec3 pointLevel, vec3 axis) {
  vec3 aside = CARD_ASIDE_VOXELS * axis;
  return 0.5 * (fieldDistance(level, pointLevel + aside) - fieldDistance(level, pointLevel - aside));
}

// Whether a ray sees what it meets: by coverage, of cards aslant where the ray crosses the card itself.
//
// direction   of the ray, unit
// attributes  of the surface there
// cost        a read where there is a card, six where it is seen aslant
bool isCovered(SdfLevel level, vec3 pointLevel, vec3 direction, bool isBack, BrickAttributes attributes) {
  bool isCoveredHere = attributes.colorAndCoverage.a >= 0.5;
  if (attributes.material.a <= 0.0 || attributes.material.a >= 1.0) return isCoveredHere; // no sample around is a card's
  uint byte = cardByteAt(level, pointLevel);
  if (byte == 0u || byte == CARD_UNLIT_NONE) return isCoveredHere;
  vec3 axis = cardAxis(byte - (byte < CARD_UNLIT ? 1u : CARD_UNLIT));
  vec3 inwards = isBack ? -direction : direction;
  if (abs(dot(axis, inwards)) >= CARD_STEEP_FACING) return isCoveredHere;
  vec3 first = pointLevel + CARD_FIRST_VOXELS * inwards;
  float height = heightOverCard(level, first, axis);
  float slope = (heightOverCard(level, first + CARD_APART_VOXELS * inwards, axis) - height) / CARD_APART_VOXELS;
  if (abs(slope) < CARD_LEAST_SLOPE) slope = CARD_LEAST_SLOPE;
  float way = -height / slope;
  return abs(way) <= CARD_MOST_WAY_VOXELS && coverageAt(level, first + way * inwards) >= 0.5;
}
