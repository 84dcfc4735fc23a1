// Motion vectors: how far a surface's place in the picture is from where it was a frame before, without the jitter of
// either frame. In pixels, and with it the ratio of its depths then and now, which tells disocclusion apart.
#include "lib/frame.glsl"

// A depth that grows away from the eye: metres along the view; of parallel views, whose clip.w is 1, from 1 to 2.
float viewDepth(vec4 clip) { return frame.projection.z > 0.5 ? 2.0 - clip.z : clip.w; }

// previousPointEye  where it was, from the eye of now
vec3 motionOf(vec3 pointEye, vec3 previousPointEye) {
  vec4 now = frame.clipFromEye * vec4(pointEye, 1.0), before = frame.previousClipFromEye * vec4(previousPointEye, 1.0);
  if (before.w <= 0.0) return vec3(6e4, 6e4, 1.0); // behind the eye then: out of every picture
  vec2 moved = now.xy / now.w - frame.jitter.xy - before.xy / before.w;
  return vec3(clamp(moved * 0.5 * vec2(frame.size.xy), -6e4, 6e4), viewDepth(before) / viewDepth(now));
}
