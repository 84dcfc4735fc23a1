// Skins: joints that hang together and their inverse bind matrices.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include "scene/gltf_accessor.h"
#include "scene/gltf_node.h"
#include "scene/gltf_schema.h"

namespace brickfield {

namespace {

// Root of each node's tree, in one sweep that follows parents and remembers.
std::vector<int> treeRoots(const Scene& scene) {
  std::vector<int> roots(scene.nodes.size(), -1);
  std::vector<std::size_t> path;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    std::size_t node = i;
    path.clear();
    while (roots[node] < 0 && scene.nodes[node].parent >= 0) {
      path.push_back(node);
      node = static_cast<std::size_t>(scene.nodes[node].parent);
    }
    if (roots[node] < 0) roots[node] = static_cast<int>(node);
    for (const std::size_t visited : path) roots[visited] = roots[node];
  }
  return roots;
}

std::vector<glm::mat4> bindMatrices(GltfDocument& document, const tinygltf::Skin& source, const std::string& element) {
  const int accessor = source.inverseBindMatrices;
  document.spendVertices(source.joints.size(), element);
  if (accessor < 0) return std::vector<glm::mat4>(source.joints.size(), glm::mat4(1.0f));
  checkFormat(document, accessor, {"MAT4", "f32", false}, element + ": inverseBindMatrices");
  const std::uint64_t count = accessorCount(document, accessor);
  if (count < source.joints.size())
    document.refuse(element, fmt::format("has {} inverse bind matrices for {} joints", count, source.joints.size()));
  if (count > source.joints.size()) document.spendVertices(count - source.joints.size(), element);
  if (accessorIsEmpty(document, accessor)) {
    document.warnings.push_back(
        fmt::format("{}: its inverse bind matrices have no data and count as identity", element));
    return std::vector<glm::mat4>(source.joints.size(), glm::mat4(1.0f));
  }
  const std::vector<float> numbers = readFloats(document, accessor);
  std::vector<glm::mat4> matrices(source.joints.size());
  constexpr float kTolerance = 1e-3f;
  for (std::size_t joint = 0; joint < matrices.size(); ++joint) {
    glm::mat4& matrix = matrices[joint];
    for (std::size_t i = 0; i < 16; ++i)
      matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = numbers[16 * joint + i];
    for (int column = 0; column < 4; ++column) {
      const float expected = column == 3 ? 1.0f : 0.0f;
      if (glm::abs(matrix[column][3] - expected) > kTolerance)
        document.refuse(element,
                        fmt::format("inverse bind matrix {} is not affine: the last row is not 0 0 0 1", joint));
      matrix[column][3] = expected;
    }
  }
  return matrices;
}

} // namespace

void importSkins(GltfDocument& document, Scene& scene) {
  const std::vector<int> roots = treeRoots(scene);
  for (std::size_t i = 0; i < document.model->skins.size(); ++i) {
    const tinygltf::Skin& source = document.model->skins[i];
    const std::string element = elementLabel("skin", i, source.name);
    if (source.joints.empty()) document.refuse(element, "has no joints");
    for (const int joint : source.joints)
      if (roots[static_cast<std::size_t>(joint)] != roots[static_cast<std::size_t>(source.joints[0])])
        document.refuse(element, fmt::format("joints {} and {} have no common root", source.joints[0], joint));
    Skin& skin = scene.skins.emplace_back();
    skin.name = source.name;
    skin.joints = source.joints;
    skin.jointFromBind = bindMatrices(document, source, element);
  }
}

} // namespace brickfield
