// The topology of meshes on the GPU, once for all instances of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "resident/mesh_pool.h"
#include "scene/surface_topology.h"
#include "shared/world_triangles_params.h"

namespace brickfield {

class TopologyTable {
public:
  struct MeshRows {
    std::uint32_t firstTriangle = 0; ///< row in triangles()
    std::uint32_t triangleCount = 0; ///< with caps, which come last
    std::uint32_t firstFan = 0;      ///< row in fanStarts(): as many as vertices and one more
    std::uint32_t vertexCount = 0;
    std::vector<std::uint32_t> capsOfPrimitive;
  };

  /// isUsed  for each mesh whether it gets rows
  /// error   Failure: more than 2^28 rows
  /// cost    half a microsecond a triangle
  TopologyTable(const Scene& scene, const MeshPool& pool, const std::vector<bool>& isUsed, SmallHoles holes);

  const MeshRows& mesh(int index) const { return meshes_[static_cast<std::size_t>(index)]; }
  const Buffer& triangles() const { return triangles_; }
  const Buffer& fanStarts() const { return fanStarts_; }
  const Buffer& fanCorners() const { return fanCorners_; } ///< 4 * triangle of the mesh + corner
  std::size_t bytes() const { return triangles_.bytes() + fanStarts_.bytes() + fanCorners_.bytes(); }

private:
  std::vector<MeshRows> meshes_;
  Buffer triangles_, fanStarts_, fanCorners_;
};

} // namespace brickfield
