// Soft shadows of the first lights by the world field alone.
#include "lib/field_shadow.glsl"
#include "lib/shadow_frame.glsl"

uniform int raysOfPenumbra;
uniform float softness;

ShadowReading readForShadow(vec3 pointAnchored) {
  ++shadowReads;
  FieldReading reading = readWorldField(pointAnchored);
  return ShadowReading(reading.distanceWorld, texelOf(reading));
}

uint readsOfThread() { return shadowReads; }
float grainAt(vec3 pointAnchored) { return texelOf(readWorldField(pointAnchored)); }
float coarsestGrain(vec3 pointAnchored, float grain) { return grain; }
float visibleShare(ShadowCone cone, ivec2 pixel, int light) { return shadowOf(cone, raysOfPenumbra, softness); }
