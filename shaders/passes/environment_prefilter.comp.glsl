// Radiance of the surroundings filtered by GGX lobes, one roughness a mip (Karis 2013, viewer along the normal). Each
// sample reads the source mip whose texel covers its share of the lobe (Krivanek and Colbert 2008), so that bright
// lamps do not become dots.
#include "lib/environment.glsl"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kEnvironmentUnit) uniform sampler2D environment_source; // with box-filtered mips
layout(binding = 0, rgba16f) writeonly uniform image2D environment_prefiltered;

uniform float roughness;
uniform uint sampleCount;

void main() {
  ivec2 size = imageSize(environment_prefiltered);
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  vec3 n = directionFromEquirect((vec2(texel) + 0.5) / vec2(size));
  vec3 up = abs(n.y) < 0.99 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 tangent = normalize(cross(up, n)), bitangent = cross(n, tangent);
  vec2 sourceSize = vec2(textureSize(environment_source, 0));
  float texelSteradians = 2.0 * kEnvironmentPi * kEnvironmentPi / (sourceSize.x * sourceSize.y);
  float alpha = roughness * roughness;
  vec3 sum = vec3(0.0);
  float weight = 0.0;
  for (uint i = 0u; i < sampleCount; ++i) {
    vec3 h = sampleGgx(hammersley(i, sampleCount), alpha);
    vec3 l = 2.0 * h.z * h - vec3(0.0, 0.0, 1.0);
    if (l.z <= 0.0) continue;
    float d = h.z * h.z * (alpha * alpha - 1.0) + 1.0;
    float density = alpha * alpha / (kEnvironmentPi * d * d) / 4.0; // of l, with v = n
    float lod = 0.5 * log2(1.0 / (float(sampleCount) * density * texelSteradians)) + 1.0;
    vec3 direction = l.x * tangent + l.y * bitangent + l.z * n;
    sum += l.z * textureLod(environment_source, equirectFromDirection(direction), max(lod, 0.0)).rgb;
    weight += l.z;
  }
  imageStore(environment_prefiltered, texel, vec4(sum / max(weight, 1e-6), 1.0));
}
