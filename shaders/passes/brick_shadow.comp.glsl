// Soft shadows of the first lights by the world field, and beside surfaces by the bricks of objects.
#include "lib/field_shadow.glsl"
#include "lib/near_bricks.glsl"
#include "lib/shadow_frame.glsl"

uniform int raysOfPenumbra;
uniform float softness;

ShadowReading readForShadow(vec3 pointAnchored) {
  FieldReading reading = readWorldField(pointAnchored);
  NearDistance refined = refineByBricks(pointAnchored, reading, texelOf(reading));
  shadowReads += 1u + refined.reads;
  return ShadowReading(refined.distanceWorld, refined.grain);
}

uint readsOfThread() { return shadowReads; }
float grainAt(vec3 pointAnchored) {
  FieldReading reading = readWorldField(pointAnchored);
  return refineByBricks(pointAnchored, reading, texelOf(reading)).grain;
}
float coarsestGrain(vec3 pointAnchored, float grain) {
  FieldReading reading = readWorldField(pointAnchored);
  float texel = texelOf(reading);
  bool isNear = abs(reading.distanceWorld) < BRICKS_ALONE_TEXELS * texel;
  return isNear ? max(grain, refineByBricks(pointAnchored, reading, texel).grain) : grain;
}
float visibleShare(ShadowCone cone, ivec2 pixel, int light) { return shadowOf(cone, raysOfPenumbra, softness); }
