// Meshes once each; nodes that share one look alike.
#include "resident/node_looks.h"

#include <algorithm>

#include "scene/texture_sampling.h"

namespace brickfield {

namespace {

constexpr std::size_t kMostTriangles = 2048; // of a primitive that are looked at

const shared::NodeLook kUnknown{glm::vec4(0.5f, 0.5f, 0.5f, 0), glm::vec4(0, 0, 0, 1)};

struct Sum {
  double area = 0;
  glm::dvec4 baseColor{0}, emission{0};

  void add(const Material& material, const MaterialSample& sample, double share) {
    const glm::vec3 color(sample.baseColor), none(0);
    baseColor += share * glm::dvec4(glm::vec4(material.unlit ? none : color, material.unlit ? 0 : sample.metallic));
    emission += share * glm::dvec4(glm::vec4(material.unlit ? color : sample.emission, sample.roughness));
    area += share;
  }
};

void addPrimitive(const Scene& scene, const TextureSampler& sampler, const Primitive& primitive, Sum& sum) {
  const Material& material = materialOf(scene, primitive);
  const std::size_t triangles = primitive.indices.size() / 3;
  const std::size_t stride = std::max(triangles / kMostTriangles, std::size_t{1});
  for (std::size_t t = 0; t < triangles; t += stride) {
    const std::uint32_t* v = &primitive.indices[3 * t];
    const glm::vec3 a = primitive.positions[v[0]], b = primitive.positions[v[1]], c = primitive.positions[v[2]];
    const double area = double{glm::length(glm::cross(b - a, c - a))} * static_cast<double>(stride);
    if (!(area > 0)) continue;
    sum.add(material, sampler.sampleMaterial(material, materialPointOf(primitive, t, glm::vec2(1.0f / 3))), area);
  }
}

} // namespace

std::vector<shared::NodeLook> nodeLooksOf(const Scene& scene) {
  const TextureSampler sampler(scene);
  std::vector<shared::NodeLook> ofMeshes;
  for (const Mesh& mesh : scene.meshes) {
    Sum sum;
    for (const Primitive& primitive : mesh.primitives) addPrimitive(scene, sampler, primitive, sum);
    if (sum.area > 0)
      ofMeshes.push_back({glm::vec4(sum.baseColor / sum.area), glm::vec4(sum.emission / sum.area)});
    else
      ofMeshes.push_back(kUnknown);
  }
  std::vector<shared::NodeLook> looks;
  for (const Node& node : scene.nodes)
    looks.push_back(node.mesh < 0 ? kUnknown : ofMeshes[static_cast<std::size_t>(node.mesh)]);
  return looks;
}

} // namespace brickfield
