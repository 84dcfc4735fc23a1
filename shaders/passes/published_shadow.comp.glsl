// Shadows of the first lights by the estimators of others.
#include "lib/published_shadows.glsl"
// One warp, as field_shadow.comp.glsl.
const int GROUP_WIDTH = 8, GROUP_HEIGHT = 4;
#include "lib/shadow_frame.glsl"

uniform uint estimator; // ESTIMATOR_*
uniform int raysOfPenumbra;
uniform float mostStep; // of half the coarsest window
uniform uint seed;

uint readsOfThread() { return shadowReads; }
bool isOfCell() { return false; }
float visibleShare(ShadowCone cone, int light, ivec2 pixel, int cell) {
  cone.grain = texelAt(cone.origin);
  FieldCascade coarsest = field.cascades[int(field.counts.x) - 1];
  float step = mostStep * 0.5 * float(coarsest.window.w) * coarsest.texel.x;
  return publishedShadow(cone, estimator, raysOfPenumbra, step, uvec3(pixel, seed + 31u * uint(light)));
}
