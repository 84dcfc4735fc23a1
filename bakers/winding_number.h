// Generalized winding number of triangles (Jacobson et al. 2013): how often they wrap a point, 1 inside a closed mesh
// that faces outwards. Far clusters count as dipoles, as in Barill et al., Fast Winding Numbers for Soups and Clouds,
// 2018, first-order term only; near triangles by their exact solid angles.
#pragma once

#include "bakers/mesh_hierarchy.h"

namespace brickfield {

class WindingNumber {
public:
  /// hierarchy must outlive this
  explicit WindingNumber(const MeshHierarchy& hierarchy);

  /// point    soup space
  /// returns  within about 0.01 of the exact number, and far closer for closed meshes
  /// proved by tests/bake/bakers/winding_number_test.cpp
  float at(glm::dvec3 point) const;

private:
  /// What stands for a child from afar. Absent children have no dipole and are infinitely far.
  struct Dipoles {
    Vector8 center;       ///< mean of the centroids, weighted by area
    Vector8 areaNormal;   ///< sum of the area vectors
    Float8 radiusSquared; ///< of the ball around `center` that holds the triangles
  };
  struct Cluster;
  Cluster gather(HierarchyChild child);

  const MeshHierarchy* hierarchy_;
  std::vector<Dipoles> dipoles_; ///< a node each
};

} // namespace brickfield
