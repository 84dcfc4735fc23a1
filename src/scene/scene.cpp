// The two look-ups that everybody needs of a scene: how messages name a node, and a primitive's material.
#include "scene/scene.h"

namespace brickfield {

std::string nodeLabel(const Scene& scene, int node) {
  std::string label = "node " + std::to_string(node);
  if (node < 0 || static_cast<std::size_t>(node) >= scene.nodes.size()) return label;
  const std::string& name = scene.nodes[static_cast<std::size_t>(node)].name;
  if (!name.empty()) label += " \"" + name + "\"";
  return label;
}

const Material& materialOf(const Scene& scene, const Primitive& primitive) {
  static const Material kDefaultMaterial;
  return primitive.material < 0 ? kDefaultMaterial : scene.materials[static_cast<std::size_t>(primitive.material)];
}

} // namespace brickfield
