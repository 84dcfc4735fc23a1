// Nothing here recurses: chains of a hundred thousand nodes are legal.
#include "scene/gltf_node.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_accessor.h"
#include "scene/gltf_extras.h"
#include "scene/gltf_schema.h"

namespace brickfield {

namespace {

using nlohmann::json;

// A rotation may be this far from unit length by rounding: the error of components with two decimals is 0.01.
constexpr float kUnitTolerance = 0.01f;
// The last row of an affine matrix is exact in every exporter that we know; some compute it.
constexpr float kAffineTolerance = 1e-4f;

class NodeReader {
public:
  NodeReader(GltfDocument& document, std::size_t index)
      : document_(document),
        source_(document.model->nodes[index]),
        json_(document.json["nodes"][index]),
        element_(elementLabel("node", index, source_.name)) {}

  Node read() {
    Node node;
    node.name = source_.name;
    node.children = source_.children;
    node.mesh = source_.mesh;
    node.skin = source_.skin;
    node.camera = source_.camera;
    if (node.skin >= 0 && node.mesh < 0) document_.refuse(element_, "has a skin but no mesh");
    if (!source_.weights.empty() && node.mesh < 0) document_.refuse(element_, "has weights but no mesh");
    for (const double weight : source_.weights) node.morphWeights.push_back(finite(weight, "weights"));
    readTransform(node);
    node.sdf = readSdfSettings(document_, json_, element_, node.mesh >= 0);
    const auto extensions = json_.find("extensions");
    if (extensions == json_.end()) return node;
    if (const auto light = extensions->find("KHR_lights_punctual"); light != extensions->end())
      node.light = (*light)["light"].get<int>();
    if (const auto instancing = extensions->find("EXT_mesh_gpu_instancing"); instancing != extensions->end())
      readInstances((*instancing)["attributes"], node);
    return node;
  }

private:
  float finite(double number, std::string_view member) const {
    const auto value = static_cast<float>(number);
    if (!std::isfinite(value)) document_.refuse(element_, fmt::format("{} holds {}, out of range", member, number));
    return value;
  }

  void readTransform(Node& node) {
    if (json_.contains("matrix")) {
      for (const char* other : {"translation", "rotation", "scale"})
        if (json_.contains(other)) document_.refuse(element_, fmt::format("has both matrix and {}", other));
      glm::mat4& matrix = node.matrix.emplace(1.0f);
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = finite(source_.matrix[static_cast<std::size_t>(i)], "matrix");
      const glm::vec4 lastRow(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
      if (glm::any(glm::greaterThan(glm::abs(lastRow - glm::vec4(0, 0, 0, 1)), glm::vec4(kAffineTolerance))))
        document_.refuse(element_, "its matrix is not affine: the last row is not 0 0 0 1");
      for (int column = 0; column < 4; ++column) matrix[column][3] = column == 3 ? 1.0f : 0.0f;
      return;
    }
    for (int i = 0; i < 3 && !source_.translation.empty(); ++i)
      node.translation[i] = finite(source_.translation[static_cast<std::size_t>(i)], "translation");
    for (int i = 0; i < 3 && !source_.scale.empty(); ++i)
      node.scale[i] = finite(source_.scale[static_cast<std::size_t>(i)], "scale");
    if (source_.rotation.empty()) return;
    glm::vec4 xyzw;
    for (int i = 0; i < 4; ++i) xyzw[i] = finite(source_.rotation[static_cast<std::size_t>(i)], "rotation");
    node.rotation = unitRotation(xyzw, "rotation");
  }

  glm::quat unitRotation(glm::vec4 xyzw, std::string_view member) {
    const float length = glm::length(xyzw);
    if (!(length > 0.0f) || !std::isfinite(length))
      document_.refuse(element_, fmt::format("{} is no quaternion: its length is {}", member, length));
    if (std::abs(length - 1.0f) > kUnitTolerance && !hasWarned_) {
      document_.warnings.push_back(fmt::format("{}: {} has length {} and is scaled to 1", element_, member, length));
      hasWarned_ = true;
    }
    xyzw /= length;
    return glm::quat(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
  }

  std::vector<float> instanceAttribute(const json& attributes, const char* name, const AccessorFormat& format,
                                       std::size_t& count) {
    const auto it = attributes.find(name);
    if (it == attributes.end()) return {};
    const int accessor = it->get<int>();
    checkFormat(document_, accessor, format, fmt::format("{}: instance {}", element_, name));
    const std::uint64_t elements = accessorCount(document_, accessor);
    if (count != 0 && elements != count)
      document_.refuse(element_, fmt::format("instance {} has {} elements, others have {}", name, elements, count));
    if (count == 0) document_.spendVertices(elements, element_);
    count = elements;
    return readFloats(document_, accessor);
  }

  void readInstances(const json& attributes, Node& node) {
    if (node.mesh < 0) document_.refuse(element_, "has instances but no mesh");
    if (node.skin >= 0)
      document_.warnings.push_back(fmt::format("{}: instances of a skinned mesh all follow the joints", element_));
    std::size_t count = 0;
    const std::vector<float> translations = instanceAttribute(attributes, "TRANSLATION", {"VEC3", "f32"}, count);
    const std::vector<float> rotations = instanceAttribute(attributes, "ROTATION", {"VEC4", "f32 i8n i16n"}, count);
    const std::vector<float> scales = instanceAttribute(attributes, "SCALE", {"VEC3", "f32"}, count);
    node.nodeFromInstance.assign(count, glm::mat4(1.0f));
    for (std::size_t i = 0; i < count; ++i) {
      glm::mat4& matrix = node.nodeFromInstance[i];
      if (!rotations.empty())
        matrix = glm::mat4_cast(
            unitRotation({rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2], rotations[4 * i + 3]},
                         fmt::format("ROTATION of instance {}", i)));
      for (std::size_t k = 0; k < 3 && !scales.empty(); ++k) matrix[static_cast<int>(k)] *= scales[3 * i + k];
      for (std::size_t k = 0; k < 3 && !translations.empty(); ++k)
        matrix[3][static_cast<int>(k)] = translations[3 * i + k];
      if (!isFinite(matrix)) document_.refuse(element_, fmt::format("instance {} is out of range", i));
    }
  }

  GltfDocument& document_;
  const tinygltf::Node& source_;
  const json& json_;
  std::string element_;
  bool hasWarned_ = false;
};

// Gives every child its parent, then proves that following parents ends: with one parent each, a cycle is exactly what
// no root reaches.
void linkHierarchy(const GltfDocument& document, Scene& scene) {
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    for (const int child : scene.nodes[i].children) {
      int& parent = scene.nodes[static_cast<std::size_t>(child)].parent;
      if (parent >= 0)
        document.refuse(nodeLabel(scene, child), fmt::format("has two parents, node {} and node {}", parent, i));
      parent = static_cast<int>(i);
    }
  std::vector<int> pending;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].parent < 0) pending.push_back(static_cast<int>(i));
  std::vector<bool> isReached(scene.nodes.size(), false);
  while (!pending.empty()) {
    const auto node = static_cast<std::size_t>(pending.back());
    pending.pop_back();
    isReached[node] = true;
    pending.insert(pending.end(), scene.nodes[node].children.begin(), scene.nodes[node].children.end());
  }
  for (std::size_t i = 0; i < isReached.size(); ++i)
    if (!isReached[i]) document.refuse(nodeLabel(scene, static_cast<int>(i)), "is its own ancestor");
}

void importScenes(GltfDocument& document, Scene& scene) {
  for (std::size_t i = 0; i < document.model->scenes.size(); ++i) {
    const tinygltf::Scene& source = document.model->scenes[i];
    for (const int root : source.nodes)
      if (scene.nodes[static_cast<std::size_t>(root)].parent >= 0)
        document.refuse(elementLabel("scene", i, source.name),
                        fmt::format("names {}, which has a parent", nodeLabel(scene, root)));
    scene.scenes.push_back({source.name, source.nodes});
  }
  scene.defaultScene = document.model->defaultScene;
  if (scene.defaultScene < 0 && !scene.scenes.empty()) scene.defaultScene = 0;
  if (scene.scenes.empty()) {
    scene.defaultScene = -1;
    document.warnings.push_back("the file has no scene: nothing is shown");
  }
}

} // namespace

void importNodes(GltfDocument& document, Scene& scene) {
  for (std::size_t i = 0; i < document.model->nodes.size(); ++i) scene.nodes.push_back(NodeReader(document, i).read());
  linkHierarchy(document, scene);
  importScenes(document, scene);
}

std::vector<MeshUse> meshUses(const GltfDocument& document, const Scene& scene) {
  std::vector<MeshUse> uses(document.model->meshes.size());
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0 || node.skin < 0) continue;
    MeshUse& use = uses[static_cast<std::size_t>(node.mesh)];
    use.isSkinned = true;
    use.jointLimit = std::min(use.jointLimit, scene.skins[static_cast<std::size_t>(node.skin)].joints.size());
  }
  return uses;
}

void checkNodes(const GltfDocument& document, const Scene& scene) {
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.morphWeights.empty()) continue;
    const std::size_t targets = scene.meshes[static_cast<std::size_t>(node.mesh)].morphWeights.size();
    if (node.morphWeights.size() != targets)
      document.refuse(nodeLabel(scene, static_cast<int>(i)),
                      fmt::format("has {} weights, its mesh has {} morph targets", node.morphWeights.size(), targets));
  }
}

} // namespace brickfield
