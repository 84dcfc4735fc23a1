// Packs primitives into the rows of shaders/shared/mesh_params.h.
#include "resident/mesh_pool.h"

#include <cstddef>
#include <limits>

#include <glm/gtc/packing.hpp>

#include "core/error.h"
#include "core/math.h"

namespace brickfield {

namespace {

constexpr GLuint kVertexBinding = 0;

std::uint32_t packDirection(glm::vec3 direction) {
  const float length2 = glm::dot(direction, direction);
  return glm::packSnorm2x16(octahedralFromDirection(length2 > 0 ? direction : glm::vec3(0, 0, 1)));
}

shared::MeshVertex packVertex(const Primitive& primitive, std::size_t v) {
  shared::MeshVertex vertex{};
  vertex.position = glm::vec4(primitive.positions[v], glm::uintBitsToFloat(packDirection(primitive.normals[v])));
  for (int set = 0; set < 2; ++set) {
    const auto& uvs = primitive.uvs[static_cast<std::size_t>(set)];
    if (uvs.empty()) continue;
    vertex.uv[2 * set] = uvs[v].x;
    vertex.uv[2 * set + 1] = uvs[v].y;
  }
  const glm::vec4 color = primitive.colors.empty() ? glm::vec4(1) : primitive.colors[v];
  vertex.codes.y = glm::packHalf2x16(glm::vec2(color.x, color.y));
  vertex.codes.z = glm::packHalf2x16(glm::vec2(color.z, color.w));
  if (!primitive.tangents.empty()) {
    vertex.codes.x = packDirection(glm::vec3(primitive.tangents[v]));
    vertex.codes.w = primitive.tangents[v].w < 0 ? 2u : 1u;
  }
  return vertex;
}

void appendInfluences(const Primitive& primitive, std::vector<std::uint32_t>& words) {
  const std::size_t n = static_cast<std::size_t>(primitive.influencesPerVertex);
  if (n == 0) return;
  for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
    for (std::size_t i = 0; i < n; ++i) words.push_back(primitive.joints[v * n + i]);
    for (std::size_t i = 0; i < n; ++i) words.push_back(glm::floatBitsToUint(primitive.jointWeights[v * n + i]));
  }
}

void appendMorphs(const Primitive& primitive, std::vector<glm::vec4>& rows) {
  const auto at = [](const std::vector<glm::vec3>& offsets, std::size_t v) {
    return glm::vec4(offsets.empty() ? glm::vec3(0) : offsets[v], 0);
  };
  for (const MorphTarget& target : primitive.morphTargets)
    for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
      rows.push_back(at(target.positions, v));
      rows.push_back(at(target.normals, v));
      rows.push_back(at(target.tangents, v));
    }
}

} // namespace

MeshPool::MeshPool(const Scene& scene) : vertexArray_("mesh_pool") {
  std::vector<shared::MeshVertex> vertices;
  std::vector<std::uint32_t> indices, influences;
  std::vector<glm::vec4> morphs;
  firstPrimitive_.push_back(0);
  for (const Mesh& mesh : scene.meshes) {
    for (const Primitive& primitive : mesh.primitives) {
      PooledPrimitive pooled;
      pooled.firstIndex = static_cast<std::uint32_t>(indices.size());
      pooled.indexCount = static_cast<std::uint32_t>(primitive.indices.size());
      pooled.firstVertex = static_cast<std::uint32_t>(vertices.size());
      pooled.vertexCount = static_cast<std::uint32_t>(primitive.positions.size());
      pooled.influences = static_cast<std::uint32_t>(primitive.influencesPerVertex);
      pooled.firstInfluence = static_cast<std::uint32_t>(influences.size());
      pooled.morphTargets = static_cast<std::uint32_t>(primitive.morphTargets.size());
      pooled.firstMorphRow = static_cast<std::uint32_t>(morphs.size());
      pooled.material = primitive.material;
      pooled.flatNormals = primitive.flatNormals;
      primitives_.push_back(pooled);
      indices.insert(indices.end(), primitive.indices.begin(), primitive.indices.end());
      for (std::size_t v = 0; v < primitive.positions.size(); ++v) vertices.push_back(packVertex(primitive, v));
      appendInfluences(primitive, influences);
      appendMorphs(primitive, morphs);
    }
    firstPrimitive_.push_back(primitives_.size());
  }
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (vertices.size() > kMost || indices.size() > kMost || influences.size() > kMost || morphs.size() > kMost)
    throw Failure("mesh pool: the scene has more than 32 bits can number");
  sceneVertices_ = static_cast<std::uint32_t>(vertices.size());
  vertices_ = Buffer("mesh_vertices", vertices);
  indices_ = Buffer("mesh_indices", indices);
  influences_ = Buffer("mesh_influences", influences);
  morphs_ = Buffer("mesh_morphs", morphs);
  connectVertices();
}

void MeshPool::connectVertices() {
  constexpr std::size_t kPacked = offsetof(shared::MeshVertex, codes);
  vertexArray_.setVertexBuffer(kVertexBinding, vertices_, sizeof(shared::MeshVertex));
  vertexArray_.setIndexBuffer(indices_);
  vertexArray_.setAttribute(0, kVertexBinding, 3, GL_FLOAT, 0);
  vertexArray_.setAttribute(1, kVertexBinding, 2, GL_SHORT, 12, true);
  vertexArray_.setAttribute(2, kVertexBinding, 4, GL_FLOAT, offsetof(shared::MeshVertex, uv));
  vertexArray_.setAttribute(3, kVertexBinding, 2, GL_SHORT, kPacked, true);
  vertexArray_.setAttribute(4, kVertexBinding, 4, GL_HALF_FLOAT, kPacked + 4);
  vertexArray_.setIntegerAttribute(5, kVertexBinding, 1, GL_UNSIGNED_INT, kPacked + 12);
}

std::uint32_t MeshPool::reserveDeformed(std::uint32_t vertexCount) {
  if (vertices_.growTo((std::size_t{sceneVertices_} + vertexCount) * sizeof(shared::MeshVertex))) connectVertices();
  return sceneVertices_;
}

} // namespace brickfield
