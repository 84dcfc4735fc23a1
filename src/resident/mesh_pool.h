// All triangles of a scene in one vertex and one index buffer, and behind the scene's own vertices the deformed copies
// of what is skinned or morphed.
#pragma once

#include <vector>

#include "gpu/buffer.h"
#include "gpu/vertex_array.h"
#include "scene/pose.h"
#include "shared/mesh_params.h"

namespace brickfield {

/// Where one primitive lies in the pool.
struct PooledPrimitive {
  std::uint32_t firstIndex = 0;
  std::uint32_t indexCount = 0;
  std::uint32_t firstVertex = 0;
  std::uint32_t vertexCount = 0;
  std::uint32_t influences = 0;     ///< a vertex; 0: not skinned
  std::uint32_t firstInfluence = 0; ///< word in influences()
  std::uint32_t morphTargets = 0;
  std::uint32_t firstMorphRow = 0; ///< row in morphs()
  int material = -1;
  bool flatNormals = false;
};

class MeshPool {
public:
  /// error Failure: more than 2^32 vertices, indices or words
  explicit MeshPool(const Scene& scene);

  const PooledPrimitive& primitive(int mesh, std::size_t index) const {
    return primitives_[firstPrimitive_[static_cast<std::size_t>(mesh)] + index];
  }
  std::size_t primitiveCount(int mesh) const {
    return firstPrimitive_[static_cast<std::size_t>(mesh) + 1] - firstPrimitive_[static_cast<std::size_t>(mesh)];
  }

  /// Room for this many deformed vertices behind the scene's own; returns the first one's number.
  std::uint32_t reserveDeformed(std::uint32_t vertexCount);

  std::uint32_t sceneVertexCount() const { return sceneVertices_; }

  const Buffer& vertices() const { return vertices_; }
  const Buffer& influences() const { return influences_; }
  const Buffer& morphs() const { return morphs_; }
  /// With the attributes of mesh.vert.glsl but the draw index.
  const VertexArray& vertexArray() const { return vertexArray_; }
  VertexArray& vertexArray() { return vertexArray_; }
  std::size_t bytes() const { return vertices_.bytes() + indices_.bytes() + influences_.bytes() + morphs_.bytes(); }

private:
  void connectVertices();

  std::vector<PooledPrimitive> primitives_;
  std::vector<std::size_t> firstPrimitive_; // a mesh each, and one past the last
  std::uint32_t sceneVertices_ = 0;
  Buffer vertices_, indices_, influences_, morphs_;
  VertexArray vertexArray_;
};

} // namespace brickfield
