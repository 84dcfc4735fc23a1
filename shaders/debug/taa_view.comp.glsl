// Motion vectors as colours, or how many frames a pixel's average holds.
#include "lib/debug_colors.glsl"
#include "lib/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kMotionUnit) uniform sampler2D motion;
layout(binding = kHistoryUnit) uniform sampler2D history;
layout(binding = kIdUnit) uniform usampler2D id;
layout(binding = 0, rgba8) writeonly uniform image2D picture;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 shown;
  if (frame.size.w == DEBUG_VIEW_MOTION) {
    vec2 moved = texelFetch(id, pixel, 0).r == 0u ? vec2(0.0) : texelFetch(motion, pixel, 0).rg;
    shown = vec3(0.5 + clamp(moved / frame.debugRange.y, -1.0, 1.0) * 0.5, 0.5);
  } else {
    shown = heat(texelFetch(history, pixel, 0).a / frame.debugRange.y);
  }
  imageStore(picture, pixel, vec4(shown, 1.0));
}
