// The node hierarchy at one moment: world transforms, instances, lights, cameras, bounds. Animations are in
// animation.cpp, deformation of geometry in deform.cpp.
#include "scene/pose.h"

#include <algorithm>

#include "core/error.h"
#include "scene/animation.h"
#include "scene/deform.h"

namespace brickfield {

namespace {

/// The roots that are shown; none where the file has no scene.
const std::vector<int>& chooseRoots(const Scene& scene, int wanted) {
  static const std::vector<int> kNothing;
  const int count = static_cast<int>(scene.scenes.size());
  if (wanted < -1 || wanted >= count)
    throw BadInput(scene.name, "scene " + std::to_string(wanted),
                   "the file has " + std::to_string(count) + " scenes, counted from 0");
  const int chosen = wanted >= 0 ? wanted : scene.defaultScene;
  return chosen >= 0 && chosen < count ? scene.scenes[static_cast<std::size_t>(chosen)].nodes : kNothing;
}

/// Fills worldFromNode of all that the roots reach. With a stack of its own: chains may be deeper than the machine's.
/// returns nodes depth first, children in order
std::vector<int> traverse(const Scene& scene, const std::vector<int>& roots, const LocalPose& local, Pose& pose) {
  std::vector<int> order;
  std::vector<bool> reached(scene.nodes.size(), false);
  std::vector<std::pair<int, int>> stack; // node, parent
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.emplace_back(*root, -1);
  while (!stack.empty()) {
    const auto [node, parent] = stack.back();
    stack.pop_back();
    const auto index = static_cast<std::size_t>(node);
    if (reached[index]) continue;
    reached[index] = true;
    order.push_back(node);
    const glm::mat4 worldFromParent =
        parent >= 0 ? pose.worldFromNode[static_cast<std::size_t>(parent)] : glm::mat4(1.0f);
    pose.worldFromNode[index] = worldFromParent * local.transforms[index].parentFromNode();
    if (!isFinite(pose.worldFromNode[index]))
      throw BadInput(scene.name, nodeLabel(scene, node), "its transform is not finite");
    const std::vector<int>& children = scene.nodes[index].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) stack.emplace_back(*child, node);
  }
  return order;
}

std::vector<float> morphWeightsOf(const Mesh& mesh, const std::vector<float>& ofNode) {
  std::size_t targetCount = 0;
  for (const Primitive& primitive : mesh.primitives) targetCount = std::max(targetCount, primitive.morphTargets.size());
  std::vector<float> weights = ofNode.empty() ? mesh.morphWeights : ofNode;
  weights.resize(targetCount, 0.0f);
  return weights;
}

void addSkinnedInstance(const Scene& scene, PosedInstance instance, Pose& pose) {
  const Skin& skin = scene.skins[static_cast<std::size_t>(instance.skin)];
  instance.worldFromBind.reserve(skin.joints.size());
  for (std::size_t j = 0; j < skin.joints.size(); ++j)
    instance.worldFromBind.push_back(pose.worldFromNode[static_cast<std::size_t>(skin.joints[j])] *
                                     skin.jointFromBind[j]);
  pose.instances.push_back(std::move(instance));
}

/// Skins place vertices by their joints alone, so that neither the node nor EXT_mesh_gpu_instancing moves them.
void addInstances(const Scene& scene, int node, const std::vector<float>& morphWeights, Pose& pose) {
  const Node& source = scene.nodes[static_cast<std::size_t>(node)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(source.mesh)];
  PosedInstance instance;
  instance.node = node;
  instance.mesh = source.mesh;
  instance.morphWeights = morphWeightsOf(mesh, morphWeights);
  const bool hasInfluences =
      std::ranges::any_of(mesh.primitives, [](const Primitive& p) { return p.influencesPerVertex > 0; });
  if (source.skin >= 0 && hasInfluences) {
    instance.skin = source.skin;
    addSkinnedInstance(scene, std::move(instance), pose);
    return;
  }
  instance.worldFromObject = pose.worldFromNode[static_cast<std::size_t>(node)];
  if (source.nodeFromInstance.empty()) {
    pose.instances.push_back(std::move(instance));
    return;
  }
  const glm::mat4 worldFromNode = instance.worldFromObject;
  for (std::size_t i = 0; i < source.nodeFromInstance.size(); ++i) {
    instance.instance = static_cast<int>(i);
    instance.worldFromObject = worldFromNode * source.nodeFromInstance[i];
    pose.instances.push_back(instance);
  }
}

PosedLight poseLight(const Scene& scene, int node, const glm::mat4& worldFromNode) {
  PosedLight posed;
  posed.node = node;
  posed.light = scene.lights[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].light)];
  posed.positionWorld = glm::vec3(worldFromNode[3]);
  const glm::vec3 direction = -glm::vec3(worldFromNode[2]);
  const float length = glm::length(direction);
  if (length > 0.0f && std::isfinite(length)) posed.directionWorld = direction / length;
  // Square to the direction, also under a sheared node.
  const glm::vec3 width = glm::vec3(worldFromNode[0]);
  const glm::vec3 right = width - glm::dot(width, posed.directionWorld) * posed.directionWorld;
  const float rightLength = glm::length(right);
  posed.rightWorld =
      rightLength > 0.0f && std::isfinite(rightLength) ? right / rightLength : levelRightOf(posed.directionWorld);
  return posed;
}

/// Boxes of undeformed primitives, made once for all instances of a mesh.
class ObjectBoxes {
public:
  explicit ObjectBoxes(const Scene& scene) : scene_(scene), boxes_(scene.meshes.size()) {}

  const Box& boxOf(int mesh, std::size_t primitive) {
    std::vector<Box>& boxes = boxes_[static_cast<std::size_t>(mesh)];
    const Mesh& source = scene_.meshes[static_cast<std::size_t>(mesh)];
    if (boxes.empty())
      for (const Primitive& p : source.primitives) {
        Box& box = boxes.emplace_back();
        for (const glm::vec3 position : p.positions) box.extend(position);
      }
    return boxes[primitive];
  }

private:
  const Scene& scene_;
  std::vector<std::vector<Box>> boxes_;
};

Box boundsOf(const Scene& scene, const PosedInstance& instance, ObjectBoxes& objectBoxes) {
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
  Box bounds;
  bool finite = true;
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const Primitive& primitive = mesh.primitives[i];
    if (primitive.positions.empty()) continue;
    Box box;
    if (isDeformed(primitive, instance))
      for (const glm::vec3 position : deformPositions(primitive, instance)) {
        // A box forgets what is not a number, so each point is asked.
        finite = finite && isFinite(position);
        box.extend(position);
      }
    else
      box = objectBoxes.boxOf(instance.mesh, i);
    box = transformBox(instance.worldFromObject, box);
    finite = finite && isFinite(box.min) && isFinite(box.max);
    bounds.extend(box);
  }
  if (!finite) throw BadInput(scene.name, nodeLabel(scene, instance.node), "its posed geometry is not finite");
  return bounds;
}

} // namespace

glm::vec3 levelRightOf(glm::vec3 directionWorld) {
  const glm::vec3 right = glm::cross(directionWorld, glm::vec3(0.0f, 1.0f, 0.0f));
  const float length = glm::length(right);
  constexpr float kLeastSine = 1e-6f; // below it the cross product is mostly rounding
  return length > kLeastSine ? right / length : glm::vec3(1.0f, 0.0f, 0.0f);
}

Pose poseScene(const Scene& scene, const PoseRequest& request) {
  const std::vector<std::size_t> animations = chooseAnimations(scene, request.animation);
  LocalPose local = restPose(scene);
  if (request.seconds) {
    if (std::isnan(*request.seconds)) throw BadInput(scene.name, "time", "is not a number");
    animate(scene, animations, *request.seconds, local);
  }

  Pose pose;
  pose.worldFromNode.assign(scene.nodes.size(), glm::mat4(1.0f));
  const std::vector<int> order = traverse(scene, chooseRoots(scene, request.scene), local, pose);
  for (const int node : order) {
    const auto index = static_cast<std::size_t>(node);
    const Node& source = scene.nodes[index];
    if (source.mesh >= 0) addInstances(scene, node, local.morphWeights[index], pose);
    if (source.light >= 0) pose.lights.push_back(poseLight(scene, node, pose.worldFromNode[index]));
    if (source.camera >= 0) pose.cameraNodes.push_back(node);
  }
  ObjectBoxes objectBoxes(scene);
  for (const PosedInstance& instance : pose.instances) pose.boundsWorld.extend(boundsOf(scene, instance, objectBoxes));
  return pose;
}

} // namespace brickfield
