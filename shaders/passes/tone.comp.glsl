// Exposure, filmic tone curve, sRGB; twin of app/tone_curve.h.
#include "lib/frame.glsl"
#include "lib/tone_curve.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kColorUnit) uniform sampler2D color;
layout(binding = 0, rgba8) writeonly uniform image2D picture;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 linear = filmicCurve(texelFetch(color, pixel, 0).rgb * frame.projection.w);
  imageStore(picture, pixel, vec4(srgbFromLinear(linear), 1.0));
}
