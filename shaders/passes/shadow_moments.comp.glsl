// Moments of warped depths, blurred over 15 texels: once along x from the map, once along y to where they are read.
#include "lib/shadow_moments.glsl"
#include "shared/bindings.h"
#include "shared/shadow_map_params.h"

layout(local_size_x = 16, local_size_y = 16) in;

layout(std140, binding = kShadowMapUniformBinding) uniform ShadowMapBlock { ShadowMapParams shadowMaps; };
layout(binding = kShadowMapUnit) uniform sampler2DArray shadow_map;
layout(binding = kShadowMomentsUnit) uniform sampler2DArray blurred_along_x;
layout(binding = 0, rgba32f) writeonly uniform image2DArray result;

uniform int layerIndex;
uniform bool alongY;

// A Gauss curve that has fallen to a fifteenth at the last texel: 15 texels are used, and none stands out as an edge.
const float kSigmaTexels = 3.0;

vec4 momentsAt(ivec2 texel) {
  texel = clamp(texel, ivec2(0), ivec2(shadowMaps.size.x - 1));
  if (alongY) return texelFetch(blurred_along_x, ivec3(texel, 0), 0);
  ShadowMapLayer layer = shadowMaps.layers[layerIndex];
  float depth = texelFetch(shadow_map, ivec3(texel, layerIndex), 0).r;
  float metres = layer.depth.x / max(depth, 1e-30);
  bool parallel = layer.depth.z > 0.5;
  return momentsOf(parallel ? 1.0 - depth : clamp((metres - layer.depth.x) / (layer.depth.y - layer.depth.x), 0.0, 1.0));
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(shadowMaps.size.x)))) return;
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = -SHADOW_BLUR_RADIUS; i <= SHADOW_BLUR_RADIUS; ++i) {
    float weight = exp(-0.5 * float(i * i) / (kSigmaTexels * kSigmaTexels));
    weights += weight;
    sum += weight * momentsAt(texel + (alongY ? ivec2(0, i) : ivec2(i, 0)));
  }
  imageStore(result, ivec3(texel, alongY ? layerIndex : 0), sum / weights);
}
