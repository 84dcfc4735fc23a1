// Cameras to matrices and rays. Everything is computed in double and rounded once, so that a primary ray meets the
// projection of its own pixel as closely as single precision can say.
#include "scene/view.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "core/error.h"

namespace brickfield {

namespace {

/// What a view is made of, before matrices.
struct Placement {
  glm::dvec3 eye{0.0};
  glm::dmat3 axes{1.0}; ///< right, up, backward in world space; orthonormal
  Camera camera;
};

/// Right, up and backward for a gaze; any other up where the gaze runs along it.
glm::dmat3 axesFrom(glm::dvec3 forward, glm::dvec3 up) {
  const glm::dvec3 backward = -glm::normalize(forward);
  glm::dvec3 right = glm::cross(up, backward);
  // Below this sine the direction of `right` would be rounding noise of single precision input.
  constexpr double kParallel = 1e-6;
  if (!(glm::length(right) > kParallel * glm::length(up)) || !(glm::length(up) > 0.0))
    right = glm::cross(std::abs(backward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1), backward);
  right = glm::normalize(right);
  return {right, glm::cross(backward, right), backward};
}

/// The rigid part of a camera node: gaze kept exactly, up as near as it may be, scale and mirroring dropped.
Placement placeNode(const Scene& scene, const Pose& pose, int node) {
  const glm::dmat4 worldFromNode(pose.worldFromNode[static_cast<std::size_t>(node)]);
  Placement placement;
  placement.camera = scene.cameras[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].camera)];
  placement.eye = glm::dvec3(worldFromNode[3]);
  const glm::dvec3 forward = -glm::dvec3(worldFromNode[2]);
  placement.axes = axesFrom(glm::length(forward) > 0.0 ? forward : glm::dvec3(0, 0, -1), glm::dvec3(worldFromNode[1]));
  return placement;
}

double boundsRadius(const Box& bounds) {
  const double radius = 0.5 * glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
  return bounds.isEmpty() || !(radius > 0.0) ? 1.0 : radius;
}

glm::dvec3 boundsCenter(const Box& bounds) {
  return bounds.isEmpty() ? glm::dvec3(0.0) : 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
}

/// Where the eye must stand beside the axis so that the picture's margins are equal, left and right, above and below.
/// The outermost projections move monotonically with the eye: bisection.
glm::dvec2 centeringOffset(const std::array<glm::dvec3, 8>& pointsInView, double distance) {
  glm::dvec2 offset(0.0);
  for (int axis = 0; axis < 2; ++axis) {
    double low = pointsInView[0][axis], high = low;
    for (const glm::dvec3& point : pointsInView) low = std::min(low, point[axis]), high = std::max(high, point[axis]);
    constexpr int kRounds = 48; // of double precision
    for (int round = 0; round < kRounds; ++round) {
      offset[axis] = 0.5 * (low + high);
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (const glm::dvec3& point : pointsInView) {
        const double projected = (point[axis] - offset[axis]) / (distance - point.z);
        least = std::min(least, projected), most = std::max(most, projected);
      }
      (least + most > 0.0 ? low : high) = offset[axis];
    }
  }
  return offset;
}

/// The nearest eye with a fixed gaze that has all eight corners of the bounds in the picture, with a margin.
///
/// In view axes about the centre, an eye at (cx, cy, d) sees a corner (x, y, z) if |x - cx| <= w (d - z) and
/// |y - cy| <= h (d - z), w and h being half the picture's sides one metre away. Each axis by itself is solved by
/// d = (A + B) / 2w, cx = (A - B) / 2 with A = max(x + w z), B = max(-x + w z); the larger d serves both.
Placement placeAround(const Pose& pose, double verticalFovRadians, double aspect) {
  constexpr double kShareOfPicture = 0.92;
  const glm::dvec3 kFromTarget(0.45, 0.35, 1.0); // in front, to the right, slightly above
  constexpr double kNearPerRadius = 1e-3;
  const Box bounds = pose.boundsWorld.isEmpty() ? Box{glm::vec3(-1.0f), glm::vec3(1.0f)} : pose.boundsWorld;
  const double radius = boundsRadius(bounds);
  const double halfHeight = std::tan(0.5 * verticalFovRadians) * kShareOfPicture;
  const glm::dvec2 half(halfHeight * aspect, halfHeight);

  Placement placement;
  placement.camera.verticalFovRadians = static_cast<float>(verticalFovRadians);
  placement.camera.nearDistance = static_cast<float>(kNearPerRadius * radius);
  placement.axes = axesFrom(-kFromTarget, glm::dvec3(0, 1, 0));
  const glm::dvec3 center = boundsCenter(bounds);
  glm::dvec2 upper(-std::numeric_limits<double>::infinity()), lower = upper;
  double front = 0.0;
  std::array<glm::dvec3, 8> cornersInView;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1 ? bounds.max : bounds.min).x, (corner & 2 ? bounds.max : bounds.min).y,
                           (corner & 4 ? bounds.max : bounds.min).z);
    const glm::dvec3 inView = glm::transpose(placement.axes) * (point - center);
    cornersInView[static_cast<std::size_t>(corner)] = inView;
    upper = glm::max(upper, glm::dvec2(inView) + half * inView.z);
    lower = glm::max(lower, -glm::dvec2(inView) + half * inView.z);
    front = std::max(front, inView.z);
  }
  const glm::dvec2 distances = (upper + lower) / (2.0 * half);
  // A line seen end on would let the eye touch it.
  const double distance = std::max({distances.x, distances.y, front + 0.01 * radius});
  placement.eye = center + placement.axes * glm::dvec3(centeringOffset(cornersInView, distance), distance);
  return placement;
}

int findCameraNode(const Scene& scene, const Pose& pose, const std::string& text) {
  for (const int node : pose.cameraNodes) {
    const Node& source = scene.nodes[static_cast<std::size_t>(node)];
    if (text == source.name || text == scene.cameras[static_cast<std::size_t>(source.camera)].name) return node;
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number < pose.cameraNodes.size())
    return pose.cameraNodes[number];
  throw BadInput(scene.name, "camera \"" + text + "\"",
                 pose.cameraNodes.empty() ? "the scene has no cameras; use \"auto\""
                                          : "no such name or number; the scene has " +
                                                std::to_string(pose.cameraNodes.size()) + ", counted from 0");
}

void applyEyeAndTarget(const Pose& pose, const CameraRequest& request, Placement& placement) {
  if (!request.eye && !request.target) return;
  if ((request.eye && !isFinite(*request.eye)) || (request.target && !isFinite(*request.target)))
    throw BadInput("camera", request.eye ? "eye" : "target", "is not finite");
  if (request.eye) placement.eye = glm::dvec3(*request.eye);
  const glm::dvec3 target = request.target ? glm::dvec3(*request.target) : boundsCenter(pose.boundsWorld);
  if (target == placement.eye) throw BadInput("camera", "", "eye and target are the same point");
  placement.axes = axesFrom(target - placement.eye, glm::dvec3(0, 1, 0));
}

/// Far enough for the bounds seen from the eye; only orthographic depth needs an end.
double orthographicFar(const Pose& pose, const Placement& placement) {
  const double least = std::max(2.0 * placement.camera.nearDistance, placement.camera.nearDistance + 1e-3);
  if (placement.camera.farDistance) return std::max<double>(*placement.camera.farDistance, least);
  const double reach = glm::length(boundsCenter(pose.boundsWorld) - placement.eye) + boundsRadius(pose.boundsWorld);
  return std::max(2.0 * reach, least);
}

/// clip.z / clip.w = near / distance: 1 at the near plane, 0 at infinity.
glm::dmat4 perspectiveClipFromView(double verticalFovRadians, double aspect, double nearDistance) {
  const double scale = 1.0 / std::tan(0.5 * verticalFovRadians);
  glm::dmat4 clipFromView(0.0);
  clipFromView[0][0] = scale / aspect;
  clipFromView[1][1] = scale;
  clipFromView[2][3] = -1.0;
  clipFromView[3][2] = nearDistance;
  return clipFromView;
}

/// 1 at the near plane, 0 at the far one.
glm::dmat4 orthographicClipFromView(glm::dvec2 halfExtent, double nearDistance, double farDistance) {
  glm::dmat4 clipFromView(1.0);
  clipFromView[0][0] = 1.0 / halfExtent.x;
  clipFromView[1][1] = 1.0 / halfExtent.y;
  clipFromView[2][2] = 1.0 / (farDistance - nearDistance);
  clipFromView[3][2] = farDistance / (farDistance - nearDistance);
  return clipFromView;
}

View finishView(const Placement& placement, const glm::dmat4& clipFromView, glm::uvec2 sizePixels) {
  const glm::dmat4 worldFromView(glm::dvec4(placement.axes[0], 0), glm::dvec4(placement.axes[1], 0),
                                 glm::dvec4(placement.axes[2], 0), glm::dvec4(placement.eye, 1));
  const glm::dmat4 viewFromWorld = glm::inverse(worldFromView);
  View view;
  view.worldFromView = glm::mat4(worldFromView);
  view.viewFromWorld = glm::mat4(viewFromWorld);
  view.clipFromView = glm::mat4(clipFromView);
  view.viewFromClip = glm::mat4(glm::inverse(clipFromView));
  view.clipFromWorld = glm::mat4(clipFromView * viewFromWorld);
  view.worldFromClip = glm::mat4(worldFromView * glm::inverse(clipFromView));
  view.eyeWorld = glm::vec3(placement.eye);
  view.nearDistance = placement.camera.nearDistance;
  view.orthographic = placement.camera.orthographic;
  view.sizePixels = sizePixels;
  if (!isFinite(view.worldFromView) || !isFinite(view.clipFromWorld))
    throw BadInput("camera", "", "the view is not finite: the scene or the camera's numbers are too large");
  return view;
}

double aspectOf(glm::uvec2 sizePixels) {
  if (sizePixels.x == 0 || sizePixels.y == 0) throw BadInput("camera", "size", "an image needs at least one pixel");
  return static_cast<double>(sizePixels.x) / sizePixels.y;
}

} // namespace

View makeView(const Scene& scene, const Pose& pose, const CameraRequest& request) {
  const double aspect = aspectOf(request.sizePixels);
  if (request.verticalFovDegrees && !(*request.verticalFovDegrees > 0.0f && *request.verticalFovDegrees < 180.0f))
    throw BadInput("camera", "field of view", "must be between 0 and 180 degrees");

  int node = -1;
  if (request.camera.empty() && !pose.cameraNodes.empty()) node = pose.cameraNodes.front();
  if (!request.camera.empty() && request.camera != "auto") node = findCameraNode(scene, pose, request.camera);
  const double autoFov = request.verticalFovDegrees ? glm::radians(double{*request.verticalFovDegrees})
                                                    : double{Camera().verticalFovRadians};
  Placement placement = node >= 0 ? placeNode(scene, pose, node) : placeAround(pose, autoFov, aspect);
  if (request.verticalFovDegrees) {
    placement.camera.orthographic = false; // who asks for a field of view wants a perspective
    placement.camera.verticalFovRadians = static_cast<float>(autoFov);
  }
  applyEyeAndTarget(pose, request, placement);

  Camera& camera = placement.camera;
  if (!camera.orthographic) {
    if (!(camera.nearDistance > 0.0f)) camera.nearDistance = static_cast<float>(1e-3 * boundsRadius(pose.boundsWorld));
    return finishView(placement, perspectiveClipFromView(camera.verticalFovRadians, aspect, camera.nearDistance),
                      request.sizePixels);
  }
  const glm::dvec2 halfExtent(std::abs(camera.halfExtent.y) * aspect, std::abs(camera.halfExtent.y));
  return finishView(placement,
                    orthographicClipFromView(halfExtent, camera.nearDistance, orthographicFar(pose, placement)),
                    request.sizePixels);
}

View makePerspectiveView(glm::vec3 eyeWorld, glm::vec3 targetWorld, float verticalFovRadians, float nearDistance,
                         glm::uvec2 sizePixels) {
  if (eyeWorld == targetWorld) throw BadInput("camera", "", "eye and target are the same point");
  Placement placement;
  placement.eye = glm::dvec3(eyeWorld);
  placement.axes = axesFrom(glm::dvec3(targetWorld) - placement.eye, glm::dvec3(0, 1, 0));
  placement.camera.nearDistance = nearDistance;
  placement.camera.verticalFovRadians = verticalFovRadians;
  return finishView(placement, perspectiveClipFromView(verticalFovRadians, aspectOf(sizePixels), nearDistance),
                    sizePixels);
}

View makeParallelView(glm::dvec3 eyeWorld, glm::dvec3 forwardWorld, double halfExtent, double nearDistance,
                      double farDistance, glm::uvec2 sizePixels) {
  Placement placement;
  placement.eye = eyeWorld;
  placement.axes = axesFrom(forwardWorld, glm::dvec3(0, 1, 0));
  placement.camera.nearDistance = static_cast<float>(nearDistance);
  placement.camera.orthographic = true;
  return finishView(placement, orthographicClipFromView(glm::dvec2(halfExtent), nearDistance, farDistance), sizePixels);
}

glm::dmat4 clipFromEye(const View& view) {
  const glm::dmat3 axes(view.worldFromView);
  glm::dmat4 clip = glm::dmat4(view.clipFromView) * glm::dmat4(glm::transpose(axes));
  if (view.jitterNdc == glm::vec2(0)) return clip;
  for (int column = 0; column < 4; ++column) {
    clip[column].x += double{view.jitterNdc.x} * clip[column].w;
    clip[column].y += double{view.jitterNdc.y} * clip[column].w;
  }
  return clip;
}

PrimaryRay primaryRay(const View& view, glm::vec2 pixel) {
  const glm::dvec2 ndc(2.0 * pixel.x / view.sizePixels.x - 1.0 - view.jitterNdc.x,
                       1.0 - 2.0 * pixel.y / view.sizePixels.y - view.jitterNdc.y);
  const glm::dvec2 onPlane(ndc.x / view.clipFromView[0][0], ndc.y / view.clipFromView[1][1]);
  const glm::dmat4 worldFromView(view.worldFromView);
  if (view.orthographic)
    return {glm::vec3(worldFromView * glm::dvec4(onPlane, 0.0, 1.0)), glm::vec3(-worldFromView[2]), view.nearDistance};
  const glm::dvec3 directionView(onPlane, -1.0); // one metre deep, so that its length is t per metre of depth
  const double length = glm::length(directionView);
  return {view.eyeWorld, glm::vec3(glm::dmat3(worldFromView) * (directionView / length)),
          static_cast<float>(view.nearDistance * length)};
}

} // namespace brickfield
