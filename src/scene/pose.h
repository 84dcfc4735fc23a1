// A scene at one moment: world transforms, morph weights, joint matrices, lights; and deformation of geometry on the
// CPU, the twin of the GPU's deform pass.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace brickfield {

struct PoseRequest {
  std::optional<double> seconds; ///< nothing: the rest pose. Clamped to the keys.
  std::string animation = "all"; ///< name, number or "all"; where two move one thing the first wins
  int scene = -1;                ///< which of Scene::scenes; -1: the default one
};

/// One drawn occurrence of a mesh. Skinned ones have worldFromObject = identity: their joints carry them to the world.
struct PosedInstance {
  int node = -1;
  int mesh = -1;
  int skin = -1;    ///< -1: rigid
  int instance = 0; ///< number among the node's instances
  glm::mat4 worldFromObject{1.0f};
  std::vector<float> morphWeights;      ///< as many as the mesh has targets
  std::vector<glm::mat4> worldFromBind; ///< a joint each; skinned only
};

struct PosedLight {
  int node = -1; ///< -1: from the command line
  Light light;
  glm::vec3 positionWorld{0.0f};
  glm::vec3 directionWorld{0.0f, 0.0f, -1.0f}; ///< where the light travels, unit
  glm::vec3 rightWorld{1.0f, 0.0f, 0.0f};      ///< along a rectangle's width, unit, square to the direction
};

/// Unit, level (square to +Y) and square to a unit direction; +X where that points straight up or down.
glm::vec3 levelRightOf(glm::vec3 directionWorld);

struct Pose {
  std::vector<glm::mat4> worldFromNode; ///< every node of the scene; identity where not reached
  std::vector<PosedInstance> instances; ///< in traversal order
  std::vector<PosedLight> lights;
  std::vector<int> cameraNodes; ///< nodes with cameras in traversal order: how cameras are numbered
  Box boundsWorld;              ///< of all deformed geometry
};

/// error BadInput: unknown animation or scene; an animated transform that is not finite
Pose poseScene(const Scene& scene, const PoseRequest& request);

/// A primitive after morphing and skinning, in the space that PosedInstance::worldFromObject leads out of.
struct DeformedPrimitive {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< unit
  std::vector<glm::vec4> tangents; ///< empty as in the primitive
};
DeformedPrimitive deformPrimitive(const Primitive& primitive, const PosedInstance& instance);

/// True where the positions differ from the primitive's own.
bool isDeformed(const Primitive& primitive, const PosedInstance& instance);

} // namespace brickfield
