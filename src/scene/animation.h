// What animations do to nodes: which of them play, and the local transforms and morph weights at one moment. Inner
// header of `poseScene`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace brickfield {

/// A node's own transform, before its parents.
struct LocalTransform {
  std::optional<glm::mat4> matrix; ///< if there: instead of the three others
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};

  glm::mat4 parentFromNode() const;
};

/// All nodes at one moment.
struct LocalPose {
  std::vector<LocalTransform> transforms;
  std::vector<std::vector<float>> morphWeights; ///< empty where neither node nor animation has any
};

/// The nodes as the file rests.
LocalPose restPose(const Scene& scene);

/// Numbers of the animations that a text names: "all", a name (first match), or a number.
/// error BadInput: none of them
std::vector<std::size_t> chooseAnimations(const Scene& scene, const std::string& text);

/// A channel's value at a time, clamped to its first and last key (glTF 2.0, appendix C).
///
/// value     as many floats as channel.components; rotations come out unit
/// proved by tests/unit/scene/pose_test.cpp
void sampleChannel(const AnimationChannel& channel, double seconds, std::span<float> value);

/// Overwrites what the animations move; where two move one property of one node the first wins.
void animate(const Scene& scene, std::span<const std::size_t> animations, double seconds, LocalPose& pose);

} // namespace brickfield
