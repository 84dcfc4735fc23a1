// The motion vector of each pixel from what it shows and where that was a frame before; of the sky by the camera's turn
// alone. Meshes that deform, and what else no transform of its node tells, have drawn their own.
#include "lib/gbuffer.glsl"
#include "lib/motion.glsl"
#include "lib/sdf_space.glsl"
#include "shared/mesh_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = kSdfInstanceBinding) readonly buffer SdfInstanceBlock { SdfInstance sdfInstances[]; };
layout(std430, binding = kPassBufferABinding) readonly buffer NodeMotionBlock { NodeMotion nodeMotions[]; };
layout(std430, binding = kPassBufferBBinding) readonly buffer SdfMotionBlock { SdfMotion sdfMotions[]; };
layout(binding = 0, rgba16f) writeonly uniform image2D motion;

vec3 motionOfSky(vec3 directionWorld) {
  if (frame.projection.z > 0.5) return vec3(0.0, 0.0, 1.0);
  vec4 now = frame.clipFromEye * vec4(directionWorld, 0.0), before = frame.previousClipFromEye * vec4(directionWorld, 0.0);
  if (before.w <= 0.0) return vec3(6e4, 6e4, 1.0);
  return vec3((now.xy / now.w - frame.jitter.xy - before.xy / before.w) * 0.5 * vec2(frame.size.xy), 1.0);
}

// From the eye of now.
vec3 previousPlaceOfSdf(uint number, vec3 pointEye) {
  SdfInstance instance = sdfInstances[number];
  SdfMotion then = sdfMotions[number];
  if (then.previousWorldFromGrid == instance.worldFromGrid) return pointEye; // to the last bit
  instance.worldFromGrid = then.previousWorldFromGrid;
  return eyeFromGrid(instance, gridFromEye(sdfInstances[number], pointEye));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 originEye, directionWorld;
  viewRay(ndcFromPixel(vec2(pixel) + 0.5), originEye, directionWorld);
  uint packedId = texelFetch(id, pixel, 0).r, kind = kindOfId(packedId), number = numberOfId(packedId);
  vec3 moved;
  if (kind == KIND_NONE) {
    moved = motionOfSky(directionWorld);
  } else {
    vec3 pointEye = originEye + rayParameterOfDepth(originEye, directionWorld, texelFetch(depth, pixel, 0).r) * directionWorld;
    if (kind == KIND_SDF) {
      moved = motionOf(pointEye, previousPlaceOfSdf(number, pointEye));
    } else {
      NodeMotion then = nodeMotions[number];
      if (then.isDrawn.x != 0) return;
      moved = motionOf(pointEye, vec4(pointEye, 1.0) * mat3x4(then.previousEyeFromEye[0], then.previousEyeFromEye[1], then.previousEyeFromEye[2]));
    }
  }
  imageStore(motion, pixel, vec4(moved, 0.0));
}
