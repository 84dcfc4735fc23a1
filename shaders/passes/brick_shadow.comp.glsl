// Soft shadows of the first lights by the world field, and beside surfaces by the bricks of objects.
const bool ENDS_DARK = true;
const float LIFT_TOWARDS_EYE = 0.5;
// Bricks hold sheets as slabs, up to 0.56 voxels deep.
const float SHEET_MOST_GRAINS = 0.6;
#include "lib/field_shadow.glsl"
#include "lib/near_bricks.glsl"
// As many as there may be leave few registers to each: on an H200 faster than 8x4, by a tenth and more.
const int GROUP_WIDTH = 32, GROUP_HEIGHT = 32;
#include "lib/shadow_frame.glsl"

uniform int raysOfPenumbra;
uniform float softness;

// What sheets are thickened by in the field. Where it says that nothing is as near, its bound is enough to step by and
// to fade by, for what is beyond fades little.
const float SHADOW_BRICKS_TEXELS = 0.5;

ShadowReading readForShadow(vec3 pointAnchored, float mostMetres, bool keepsObjects) {
  FieldReading reading = FieldReading(mostMetres, 0);
  float texel = 0.0;
  if (!keepsObjects) {
    ++shadowReads;
    reading = readWorldField(pointAnchored);
    texel = texelOf(reading);
    if (!isBesideSurface(reading, SHADOW_BRICKS_TEXELS * texel)) return ShadowReading(reading.distanceWorld, texel, texel);
    FieldCascade cascade = field.cascades[reading.cascade];
    findRows(cascade, ivec3(floor(pointAnchored * cascade.texel.y - 0.5)));
  }
  NearDistance nearest = NearDistance(3.4e38, texel, 0u);
  joinRows(pointAnchored, reading.distanceWorld, abs(reading.distanceWorld) + THICKENED_TEXELS * texel, 0.0, nearest);
  shadowReads += nearest.reads;
  if (!keepsObjects && !isMeant(nearest, reading.distanceWorld, texel)) return ShadowReading(reading.distanceWorld, texel, texel);
  return ShadowReading(nearest.distanceWorld, nearest.grain, areAllBetweenTexels ? nearest.grain : texel);
}

uint readsOfThread() { return shadowReads; }
float visibleShare(ShadowCone cone, int light, ivec2 pixel, int cell) { return shadowOf(cone, raysOfPenumbra, softness, cell); }
bool isOfCell() { return isMeanOfCell; }
