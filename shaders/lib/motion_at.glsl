// The motion vector of any pixel: of surfaces as they were drawn, of the sky by the camera's turn alone.
#include "lib/gbuffer.glsl"
#include "lib/motion.glsl"

layout(binding = kMotionUnit) uniform sampler2D motion;

vec3 motionAt(ivec2 pixel) {
  if (kindOfId(texelFetch(id, pixel, 0).r) != KIND_NONE) return texelFetch(motion, pixel, 0).rgb;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  if (frame.projection.z > 0.5) return vec3(0.0, 0.0, 1.0);
  vec4 now = frame.clipFromEye * vec4(directionWorld, 0.0), before = frame.previousClipFromEye * vec4(directionWorld, 0.0);
  if (before.w <= 0.0) return vec3(6e4, 6e4, 1.0);
  return vec3((now.xy / now.w - frame.jitter.xy - before.xy / before.w) * 0.5 * vec2(frame.size.xy), 1.0);
}
