// The eye: which camera, its matrices, its primary rays. Shared by the renderer and the reference tracer, so that both
// see the same pixels.
#pragma once

#include <optional>
#include <string>

#include "scene/pose.h"

namespace brickfield {

struct CameraRequest {
  std::string camera = "";      ///< name, number in traversal order, "auto", or "" (the first, else auto)
  std::optional<glm::vec3> eye; ///< with target: overrides the camera's place
  std::optional<glm::vec3> target;
  std::optional<float> verticalFovDegrees;
  glm::uvec2 sizePixels{1280, 720};
};

/// Reverse Z on [0,1]: the near plane has depth 1, infinity depth 0.
struct View {
  glm::mat4 worldFromView{1.0f}; ///< rigid; the camera looks along -Z
  glm::mat4 viewFromWorld{1.0f};
  glm::mat4 clipFromView{1.0f};
  glm::mat4 viewFromClip{1.0f};
  glm::mat4 clipFromWorld{1.0f};
  glm::mat4 worldFromClip{1.0f};
  glm::vec3 eyeWorld{0.0f};
  float nearDistance = 0.01f;
  bool orthographic = false;
  glm::uvec2 sizePixels{1280, 720};
  glm::vec2 jitterNdc{0.0f}; ///< by which the picture is moved, clipFromEye and primaryRay alone know of it
};

/// Chooses, places and projects. "auto" frames the pose's bounds from the front, slightly above and to the right.
/// The image's aspect rules; a camera with an aspect of its own keeps its vertical field of view.
/// error BadInput: unknown camera; eye equal to target; field of view out of (0, 180)
View makeView(const Scene& scene, const Pose& pose, const CameraRequest& request);

/// A view built by hand: perspective with infinite far plane.
View makePerspectiveView(glm::vec3 eyeWorld, glm::vec3 targetWorld, float verticalFovRadians, float nearDistance,
                         glm::uvec2 sizePixels);

/// A parallel view built by hand: looks along forwardWorld with its up as near to +Y as may be, a square of
/// 2 * halfExtent metres; depth 1 at nearDistance, 0 at farDistance. The axes depend on forwardWorld alone.
View makeParallelView(glm::dvec3 eyeWorld, glm::dvec3 forwardWorld, double halfExtent, double nearDistance,
                      double farDistance, glm::uvec2 sizePixels);

/// Clip space from eye space: the world's axes with the eye as origin. For points near the eye it keeps the digits that
/// clipFromWorld loses far from the origin.
glm::dmat4 clipFromEye(const View& view);

/// Ray of a pixel: from the eye (orthographic: from the eye's plane), unit direction; pixel centres lie at +0.5,
/// y counts downwards from the top row. tNear is where the ray crosses the near plane.
struct PrimaryRay {
  glm::vec3 originWorld;
  glm::vec3 directionWorld;
  float tNear;
};
PrimaryRay primaryRay(const View& view, glm::vec2 pixel);

} // namespace brickfield
