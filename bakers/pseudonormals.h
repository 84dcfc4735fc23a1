// Inside or outside by the normal at the closest point: that of the face, the mean of two faces at an edge, the mean
// weighted by angle at a corner (Baerentzen and Aanaes, Signed Distance Computation Using the Angle Weighted
// Pseudonormal, 2005). Right on closed manifolds only, and so only offered for them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bakers/mesh_distance.h"

namespace brickfield {

class Pseudonormals {
public:
  /// returns  nothing unless the soup is a closed manifold without slivers (closedManifoldNeighbours)
  static std::optional<Pseudonormals> of(const TriangleSoup& soup);

  /// closest  what MeshDistance found for the point, on all triangles of the soup
  /// returns  true behind the surface; meshes of negative volume are taken as turned inside out
  bool isInside(glm::dvec3 point, const ClosestTriangle& closest) const;

private:
  const TriangleSoup* soup_ = nullptr;
  std::vector<std::array<std::uint32_t, 3>> neighbours_; ///< a triangle each: beyond edge k
  std::vector<glm::dvec3> cornerNormals_;                ///< a welded vertex each
  double facing_ = 1;                                    ///< -1: the mesh is inside out
};

} // namespace brickfield
