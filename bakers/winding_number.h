// Generalized winding number of triangles (Jacobson et al. 2013): how often they wrap a point, 1 inside a closed mesh
// that faces outwards. Far clusters count as dipoles, as in Barill et al., Fast Winding Numbers for Soups and Clouds,
// 2018, by their expansion up to the third term; near triangles by their exact solid angles.
#pragma once

#include "bakers/mesh_hierarchy.h"

namespace brickfield {

class WindingNumber {
public:
  /// hierarchy must outlive this
  explicit WindingNumber(const MeshHierarchy& hierarchy);

  /// point    soup space
  /// returns  within 0.01 of the exact number
  /// proved by tests/bake/bakers/winding_number_test.cpp
  float at(glm::dvec3 point) const;

private:
  /// What stands for a child from afar: moments of its area vectors n about a centre, d the offset from it. Absent
  /// children have none and are infinitely far.
  struct Dipoles {
    Vector8 center;                ///< mean of the centroids, weighted by area
    Vector8 areaNormal;            ///< sum of n
    Vector8 spread, shear;         ///< sum of n d': diagonal; xy + yx, yz + zy, zx + xz
    std::array<Float8, 10> cubics; ///< sum of n d d', folded onto the monomials of winding_number.cpp
    Vector8 cubicTrace;            ///< and its contractions
    Float8 radiusSquared;          ///< of the ball around `center` that holds the child's box
  };
  struct Cluster;
  Cluster gather(HierarchyChild child);
  static void setLane(Dipoles& dipoles, std::size_t lane, const Cluster& cluster);
  static Float4 farSolidAngles(const Dipoles& dipoles, std::size_t half, const Vector4& r, Float4 rSquared);

  const MeshHierarchy* hierarchy_;
  std::vector<Dipoles> dipoles_; ///< a node each
};

} // namespace brickfield
