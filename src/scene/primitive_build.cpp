// Every reordering goes through gatherVertices, so that no attribute can be forgotten.
#include "scene/primitive_build.h"

#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "scene/tangents.h"

namespace brickfield {

namespace {

template <typename Value>
void gather(std::vector<Value>& values, const std::vector<std::uint32_t>& sources, std::size_t perVertex = 1) {
  if (values.empty()) return;
  std::vector<Value> gathered;
  gathered.reserve(sources.size() * perVertex);
  for (const std::uint32_t source : sources)
    for (std::size_t k = 0; k < perVertex; ++k) gathered.push_back(values[source * perVertex + k]);
  values = std::move(gathered);
}

// Twice the area along the normal; in double, since squares of small scenes leave the range of float.
glm::dvec3 areaNormal(const Primitive& primitive, std::size_t triangle) {
  const glm::dvec3 a(primitive.positions[primitive.indices[3 * triangle]]);
  const glm::dvec3 b(primitive.positions[primitive.indices[3 * triangle + 1]]);
  const glm::dvec3 c(primitive.positions[primitive.indices[3 * triangle + 2]]);
  return glm::cross(b - a, c - a);
}

glm::vec3 unitOr(glm::dvec3 v, glm::vec3 fallback) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

constexpr glm::vec3 kFallbackNormal(0.0f, 0.0f, 1.0f);

} // namespace

std::vector<std::uint32_t> triangleList(TriangleTopology topology, std::span<const std::uint32_t> vertices) {
  std::vector<std::uint32_t> list;
  if (topology == TriangleTopology::List) {
    list.assign(vertices.begin(), vertices.end() - static_cast<std::ptrdiff_t>(vertices.size() % 3));
    return list;
  }
  if (vertices.size() < 3) return list;
  list.reserve(3 * (vertices.size() - 2));
  for (std::size_t i = 0; i + 2 < vertices.size(); ++i) {
    // Every other triangle of a strip is wound the other way round: swapping its last two restores it.
    if (topology == TriangleTopology::Strip)
      list.insert(list.end(), {vertices[i], vertices[i + 1 + i % 2], vertices[i + 2 - i % 2]});
    else
      list.insert(list.end(), {vertices[i + 1], vertices[i + 2], vertices[0]});
  }
  return list;
}

void gatherVertices(Primitive& primitive, const std::vector<std::uint32_t>& sources) {
  gather(primitive.positions, sources);
  gather(primitive.normals, sources);
  gather(primitive.tangents, sources);
  for (auto& uvs : primitive.uvs) gather(uvs, sources);
  gather(primitive.colors, sources);
  gather(primitive.joints, sources, static_cast<std::size_t>(primitive.influencesPerVertex));
  gather(primitive.jointWeights, sources, static_cast<std::size_t>(primitive.influencesPerVertex));
  for (MorphTarget& target : primitive.morphTargets) {
    gather(target.positions, sources);
    gather(target.normals, sources);
    gather(target.tangents, sources);
  }
}

void makeFlat(Primitive& primitive) {
  primitive.normals.clear();
  primitive.tangents.clear();
  for (MorphTarget& target : primitive.morphTargets) target.normals.clear(), target.tangents.clear();
  const std::vector<std::uint32_t> sources = std::move(primitive.indices);
  gatherVertices(primitive, sources);
  primitive.indices.resize(sources.size());
  std::iota(primitive.indices.begin(), primitive.indices.end(), 0u);
  primitive.normals.resize(sources.size());
  for (std::size_t triangle = 0; triangle < sources.size() / 3; ++triangle) {
    const glm::vec3 normal = unitOr(areaNormal(primitive, triangle), kFallbackNormal);
    for (std::size_t k = 0; k < 3; ++k) primitive.normals[3 * triangle + k] = normal;
  }
  primitive.flatNormals = true;
}

NormalRepair repairNormals(Primitive& primitive) {
  NormalRepair repair;
  constexpr double kTolerance = 0.02;
  std::vector<glm::dvec3> sums;
  for (std::size_t v = 0; v < primitive.normals.size(); ++v) {
    glm::vec3& normal = primitive.normals[v];
    const glm::dvec3 exact(normal);
    const double length = glm::length(exact);
    if (length > 0.0 && std::isfinite(length)) {
      if (std::abs(length - 1.0) > kTolerance) ++repair.rescaled;
      normal = glm::vec3(exact / length);
      continue;
    }
    if (sums.empty()) {
      sums.assign(primitive.positions.size(), glm::dvec3(0.0));
      for (std::size_t triangle = 0; triangle < primitive.indices.size() / 3; ++triangle) {
        const glm::dvec3 area = areaNormal(primitive, triangle);
        for (std::size_t k = 0; k < 3; ++k) sums[primitive.indices[3 * triangle + k]] += area;
      }
    }
    ++repair.replaced;
    normal = unitOr(sums[v], kFallbackNormal);
  }
  return repair;
}

void makeTangents(Primitive& primitive, int uvSet) {
  primitive.tangents.clear();
  const std::vector<glm::vec2>& uvs = primitive.uvs[static_cast<std::size_t>(uvSet)];
  if (uvs.empty()) {
    for (const glm::vec3& normal : primitive.normals) primitive.tangents.emplace_back(anyPerpendicular(normal), 1.0f);
    return;
  }
  const std::vector<glm::vec4> corners = cornerTangents(primitive.indices, primitive.positions, primitive.normals, uvs);

  // A vertex keeps its number for the first tangent space seen; each further one gets a copy.
  const std::size_t vertexCount = primitive.positions.size();
  std::vector<std::uint32_t> sources(vertexCount);
  std::iota(sources.begin(), sources.end(), 0u);
  std::vector<glm::vec4> tangents(vertexCount, glm::vec4(0.0f)); // w = 0: no corner yet
  using CopyKey = std::array<float, 4>;
  std::map<std::pair<std::uint32_t, CopyKey>, std::uint32_t> copies;
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    std::uint32_t& vertex = primitive.indices[corner];
    const glm::vec4 tangent = corners[corner];
    if (tangents[vertex].w == 0.0f) tangents[vertex] = tangent;
    if (tangents[vertex] == tangent) continue;
    const auto [copy, isNew] = copies.try_emplace({vertex, CopyKey{tangent.x, tangent.y, tangent.z, tangent.w}},
                                                  static_cast<std::uint32_t>(sources.size()));
    if (isNew) {
      sources.push_back(vertex);
      tangents.push_back(tangent);
    }
    vertex = copy->second;
  }
  if (sources.size() > vertexCount) gatherVertices(primitive, sources);
  for (std::size_t v = 0; v < tangents.size(); ++v)
    if (tangents[v].w == 0.0f) tangents[v] = glm::vec4(anyPerpendicular(primitive.normals[v]), 1.0f);
  primitive.tangents = std::move(tangents);
}

} // namespace brickfield
