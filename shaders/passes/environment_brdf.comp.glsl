// Scale and bias of f0 in the split sum (Karis 2013): x = cosine to the viewer, y = roughness.
#include "lib/brdf.glsl"
#include "lib/environment.glsl"
#include "lib/visible_normals.glsl"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rg16f) writeonly uniform image2D environment_brdf;

void main() {
  ivec2 size = imageSize(environment_brdf);
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 unit = (vec2(texel) + 0.5) / vec2(size);
  float nDotV = unit.x, alpha = alphaOfRoughness(unit.y);
  vec3 v = vec3(sqrt(1.0 - nDotV * nDotV), 0.0, nDotV);
  const uint kSamples = 256u;
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < kSamples; ++i) {
    vec3 h = visibleNormal(alpha, v, hammersley(i, kSamples));
    float vDotH = max(dot(v, h), 0.0), nDotL = 2.0 * vDotH * h.z - nDotV;
    if (nDotL <= 0.0) continue;
    float share = smithShadowing(alpha, nDotV, nDotL), fresnel = pow(1.0 - vDotH, 5.0);
    sum += vec2(1.0 - fresnel, fresnel) * share;
  }
  imageStore(environment_brdf, texel, vec4(sum / float(kSamples), 0.0, 0.0));
}
