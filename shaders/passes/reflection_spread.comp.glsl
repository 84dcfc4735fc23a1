// What the pixels mirror whose rays were not traced: what the traced ones around them do, or the surroundings.
#include "lib/reflected_pixel.glsl"
#include "lib/reflection_code.glsl"
#include "lib/surface_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kReflectionHitUnit) uniform usampler2D reflection_hit;
layout(binding = kReflectionUnit) uniform sampler2D reflection_traced;
layout(binding = 0, rgba16f) writeonly uniform image2D reflection;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  uvec4 code = texelFetch(reflection_hit, pixel, 0);
  if (isTracedCode(code)) return;
  vec4 weights = weightsOfCode(code);
  vec3 radiance = vec3(0.0);
  if (weights == vec4(0.0)) {
    ReflectedPixel own = reflectedPixel(pixel);
    radiance = environmentAround(own.direction, own.roughness);
  }
  for (int i = 0; i < 4; ++i)
    if (weights[i] > 0.0) radiance += weights[i] * texelFetch(reflection_traced, tracedPlace(pixel, scale, i), 0).rgb;
  imageStore(reflection, pixel, vec4(min(radiance, vec3(65504.0)), 1.0));
}
