// What is timed by `bench world-field`: scenes with something in them that moves, and where everything stands in a
// frame. All of it is a function of the frame's number alone.
#pragma once

#include <functional>

#include "resident/resident_scene.h"
#include "scene/pose.h"

namespace brickfield {

/// The pose of a frame, of which there are kFramesOfTurn different ones.
using PoseOfFrame = std::function<Pose(int frame)>;
inline constexpr int kFramesOfTurn = 60;

/// What moves while it is measured.
enum class FieldMotion : std::uint8_t { Everything, Mover, Nothing };

/// A copy of the scene with one more node, "Mover", last: a torus of about 6,000 triangles, a twelfth of the scene's
/// longest side across. What the published figures call a moving object.
///
/// pose  of the scene; its bounds decide the mover's size
Scene withMover(const Scene& scene, const Pose& pose);

/// The mover circles in the scene's middle; with Everything all else trembles by a ten-thousandth of the scene: too
/// little to change a figure, but every triangle is in another place.
///
/// rest  of a scene made by withMover, with the mover where it pleases
PoseOfFrame motionOf(const Scene& withMover, const Pose& rest, FieldMotion motion);

/// A scene of SDF objects alone, each of which circles and turns.
struct MoverCrowd {
  Scene scene;
  SceneFields fields;
  std::vector<glm::vec3> centers; ///< a node each, metres
  Box boundsWorld;                ///< of all frames
};
inline constexpr float kMoverSize = 1;       ///< metres along the longest side of a mover
inline constexpr float kMoverSpacing = 2;    ///< of the cubic grid that they stand on
inline constexpr float kMoverJitter = 0.4f;  ///< to each side of their grid's points, along each axis
inline constexpr float kMoverCircle = 0.25f; ///< radius

/// `count` objects on a jittered cubic grid around the origin; the fields of the scene's SDF objects take turns.
///
/// fields  of the scene; at least one node has one
MoverCrowd makeMoverCrowd(const Scene& scene, SceneFields fields, int count);
PoseOfFrame motionOf(const MoverCrowd& crowd); ///< the crowd must outlive it

} // namespace brickfield
