// The accumulated picture back to where the frame goes on, sharpened on the way by what a pixel differs from its four
// neighbours; held between the darkest and the brightest of them, so that no rims appear.
#include "lib/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kHistoryUnit) uniform sampler2D history;
layout(binding = 0, rgba16f) writeonly uniform image2D color;

uniform float sharpness;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), last = ivec2(frame.size.xy) - 1;
  if (any(greaterThan(pixel, last))) return;
  vec3 own = texelFetch(history, pixel, 0).rgb;
  vec3 low = own, high = own, sum = vec3(0.0);
  const ivec2 ways[4] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
  for (int i = 0; i < 4; ++i) {
    vec3 c = texelFetch(history, clamp(pixel + ways[i], ivec2(0), last), 0).rgb;
    low = min(low, c), high = max(high, c), sum += c;
  }
  vec3 sharp = sharpness > 0.0 ? clamp(own + sharpness * (own - 0.25 * sum), low, high) : own;
  imageStore(color, pixel, vec4(sharp, 1.0));
}
