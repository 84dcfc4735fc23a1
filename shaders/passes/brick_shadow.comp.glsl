// Soft shadows of the first lights by the world field, and beside surfaces by the bricks of objects.
#include "lib/field_shadow.glsl"
#include "lib/near_bricks.glsl"
// Of six sizes the fastest on an H200, by a third against 8x8; why was not found out.
const int GROUP_WIDTH = 16, GROUP_HEIGHT = 16;
#include "lib/shadow_frame.glsl"

uniform int raysOfPenumbra;
uniform float softness;

ShadowReading readForShadow(vec3 pointAnchored, float fineMetres) {
  FieldReading reading = readWorldField(pointAnchored);
  NearDistance refined = refineByBricks(pointAnchored, reading, texelOf(reading), fineMetres);
  shadowReads += 1u + refined.reads;
  return ShadowReading(refined.distanceWorld, refined.grain);
}

float distanceToRead(vec3 pointAnchored, float most) {
  NearDistance nearest = NearDistance(3.4e38, 0.0, 0u);
  joinRows(pointAnchored, most, 0.0, nearest);
  shadowReads += nearest.reads;
  return nearest.distanceWorld;
}

uint readsOfThread() { return shadowReads; }
float grainAt(vec3 pointAnchored) {
  FieldReading reading = readWorldField(pointAnchored);
  return refineByBricks(pointAnchored, reading, texelOf(reading), 0.0).grain;
}
float visibleShare(ShadowCone cone, int light, ivec2 pixel, int cell) { return shadowOf(cone, raysOfPenumbra, softness, cell); }
bool isOfCell() { return isMeanOfCell; }
