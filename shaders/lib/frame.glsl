// The frame's uniform buffer and what follows from it: rays and depths. Reverse Z: near 1, infinity 0.
//
//   world --minus eyeWorld--> eye space (the world's axes) --clipFromEye--> clip space
#include "shared/bindings.h"
#include "shared/frame_params.h"

layout(std140, binding = kFrameUniformBinding) uniform FrameBlock { FrameParams frame; };

// Ray through a point of the picture in NDC. Twin of scene/view.h primaryRay (t = 0 at the eye or the eye's plane).
void viewRay(vec2 ndc, out vec3 originEye, out vec3 directionWorld) {
  vec2 pointView = (ndc - frame.jitter.xy) / frame.projection.xy;
  bool orthographic = frame.projection.z > 0.5;
  vec3 directionView = orthographic ? vec3(0.0, 0.0, -1.0) : normalize(vec3(pointView, -1.0));
  vec3 offsetView = orthographic ? vec3(pointView, 0.0) : vec3(0.0);
  originEye = mat3(frame.worldFromView) * offsetView;
  directionWorld = mat3(frame.worldFromView) * directionView;
}

// Unit; from a place relative to the eye, with the world's axes.
vec3 directionToEye(vec3 pointEye) { return frame.projection.z > 0.5 ? frame.worldFromView[2].xyz : normalize(-pointEye); }

vec2 ndcFromPixel(vec2 pixel) { return pixel / vec2(frame.size.xy) * 2.0 - 1.0; }

// Ray parameter at which a ray reaches a stored depth: solves clip.z = depth * clip.w, both linear in t.
// Depth 0 is infinity.
float rayParameterOfDepth(vec3 originEye, vec3 directionWorld, float depth) {
  vec4 clipOrigin = frame.clipFromEye * vec4(originEye, 1.0);
  vec4 clipDirection = frame.clipFromEye * vec4(directionWorld, 0.0);
  float slope = clipDirection.z - depth * clipDirection.w;
  float t = (depth * clipOrigin.w - clipOrigin.z) / slope;
  return slope == 0.0 || !(t >= 0.0) ? 3.4e38 : t;
}

// Where the ray crosses the near plane.
float rayParameterOfNear(vec3 directionWorld) {
  float cosine = dot(directionWorld, -frame.worldFromView[2].xyz);
  return frame.eyeWorld.w / cosine;
}

float depthOfPoint(vec3 pointEye) {
  vec4 clip = frame.clipFromEye * vec4(pointEye, 1.0);
  return clip.z / clip.w;
}
