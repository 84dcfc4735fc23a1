// Soft shadows of the first lights by the world field alone.
// The field alone is too dark as it is: things are thick in it, and few rays come through gaps.
const bool ENDS_DARK = false;
// Its texels are wide: half of one towards the eye passes by what stands beside the point.
const float LIFT_TOWARDS_EYE = 0.0;
// As far below a sheet the field is outside of it again, but solids may be little more than a texel thick.
const float SHEET_MOST_GRAINS = 0.2;
#include "lib/field_shadow.glsl"
// One warp: the barrier of the mean waits for nobody.
const int GROUP_WIDTH = 8, GROUP_HEIGHT = 4;
#include "lib/shadow_frame.glsl"

uniform int raysOfPenumbra;
uniform float softness;

ShadowReading readForShadow(vec3 pointAnchored, float mostMetres, bool keepsObjects) {
  ++shadowReads;
  FieldReading reading = readWorldField(pointAnchored);
  float texel = texelOf(reading);
  return ShadowReading(keepsObjects ? 3.4e38 : reading.distanceWorld, texel, texel);
}

uint readsOfThread() { return shadowReads; }
float visibleShare(ShadowCone cone, int light, ivec2 pixel, int cell) { return shadowOf(cone, raysOfPenumbra, softness, cell); }
bool isOfCell() { return isMeanOfCell; }
