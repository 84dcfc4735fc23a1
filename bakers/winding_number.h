// Generalized winding number of triangles (Jacobson et al. 2013): how often they wrap a point, 1 inside a closed mesh
// that faces outwards. Far clusters count as dipoles, as in Barill et al., Fast Winding Numbers for Soups and Clouds,
// 2018, by their expansion up to the third term; near triangles by their exact solid angles.
#pragma once

#include "bakers/mesh_hierarchy.h"

namespace brickfield {

/// What stands for the children of a node from afar: moments of their area vectors n about centres, d the offset from
/// them. Absent children have none and are infinitely far.
struct WindingMoments {
  Vector8 center;                ///< mean of the centroids, weighted by area
  Vector8 areaNormal;            ///< sum of n
  Vector8 spread, shear;         ///< sum of n d': diagonal; xy + yx, yz + zy, zx + xz
  std::array<Float8, 10> cubics; ///< sum of n d d', folded onto the monomials of winding_number.cpp
  Vector8 cubicTrace;            ///< and its contractions
  Float8 radiusSquared;          ///< of the ball around `center` that holds the child's box
};

class WindingNumber {
public:
  /// Beyond so many radii of the ball around its box a cluster counts as far.
  static constexpr float kFarRadii = 2.0f; ///< what Barill et al. advise for three terms

  /// hierarchy must outlive this
  explicit WindingNumber(const MeshHierarchy& hierarchy);

  /// point    soup space
  /// returns  within 0.01 of the exact number
  /// proved by tests/bake/bakers/winding_number_test.cpp
  float at(glm::dvec3 point) const;
  /// By all triangles, to 1e-5. cost 2 ns a triangle
  float exactlyAt(glm::dvec3 point) const;

  std::size_t bytes() const { return moments_.size() * sizeof(WindingMoments); } ///< of the moments

private:
  float turns(glm::dvec3 point, float farRadii) const;
  struct Cluster;
  Cluster gather(HierarchyChild child, int depth);
  static void setLane(WindingMoments& moments, std::size_t lane, const Cluster& cluster);

  const MeshHierarchy* hierarchy_;
  LargeVector<WindingMoments> moments_; ///< a node each
};

} // namespace brickfield
