// The slabs that stand for sheets: what a triangle without inside is shown as.
//
//   centred   all points up to half a thickness away, on both sides
//   behind    the points up to a depth behind the triangle: the front stays where it is, to the accuracy of a solid's
//
//        front |           t  . . .  centred: distance - t
//   ==========================  triangle: the front of a slab behind
//         back |  . . . depth = 3.12 t
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "bakers/mesh_distance.h"

namespace brickfield {

/// Where the slab of each triangle of a soup may lie; what SheetSlabs decides from.
struct SlabRequest {
  std::vector<bool> mayLieBehind;  ///< a triangle of the soup; of use for sheets
  std::vector<bool> isDoubleSided; ///< a triangle: at rims as wide as a centred slab, else half as much
  std::vector<bool> isTurned;      ///< a triangle: what faces away from its normal counts as its front
  double halfThickness = 0;        ///< soup space, of the finest level: layers less than a slab apart stay centred
  double pieceShare = 1;           ///< of the thickness, for what masks were cut into
};

class SheetSlabs {
public:
  /// sheets  hierarchy of the sheets; the soup must outlive this, the hierarchy need not
  SheetSlabs(const TriangleSoup& soup, const MeshHierarchy& sheets, const SlabRequest& request);

  /// Of slabs behind. In a cell that the front crosses no corner is deeper than the cell's diagonal; a slab with its
  /// middle at half of that would bend the front. 1.56 times the thickness of 1.125 voxels is sqrt(3) and a little.
  static double depthOf(double halfThickness) { return 1.56 * 2 * halfThickness; }

  bool areAllCentred() const { return neighbours_.empty(); }
  /// How far from its triangle a slab reaches at most.
  double mostReach(double halfThickness) const {
    return areAllCentred() ? halfThickness : std::hypot(halfThickness, depthOf(halfThickness)); // beside a rim, behind
  }
  bool isBehind(std::uint32_t triangle) const { return isBehind_[triangle]; }
  /// Whether slabs that masks were cut into are thinner than others.
  bool hasPieces() const { return soup_->firstPiece() < soup_->triangles.size() && pieceShare_ != 1; }

  /// Signed distance to the slab of the closest triangle, negative inside. Exact for centred slabs and before the
  /// fronts of others; no slab is nearer than closest.distance - mostReach(halfThickness).
  ///
  /// closest        what MeshDistance found for the point among the sheets
  /// halfThickness  soup space
  /// proved by tests/bake/bakers/bake_sheets_test.cpp
  double distance(glm::dvec3 point, const ClosestTriangle& closest, double halfThickness) const;
  /// The same, of a slab that is centred, by the distance to its triangle in any unit.
  double centredDistance(std::uint32_t triangle, double distance, double halfThickness) const;
  /// centredDistance of several points, in floats.
  ///
  /// triangles  of each point; kNoTriangle: its distance is infinite and stays so; nothing: no piece of a mask is among
  ///            them (hasPieces)
  void centreDistances(std::span<float> distances, const std::uint32_t* triangles, double halfThickness) const;
  /// The same, of a slab behind, where the point's foot lies inside the triangle.
  ///
  /// height  over the triangle, counter-clockwise positive, in any unit
  double distanceOver(std::uint32_t triangle, double height, double halfThickness) const;

  /// Box of all slabs, in soup space.
  void growBounds(const std::vector<std::uint32_t>& sheets, double halfThickness, glm::dvec3& low,
                  glm::dvec3& high) const;

private:
  /// The side that a point lies on, at a feature of a triangle.
  struct Side {
    glm::dvec3 normal{0.0}; ///< unit
    bool isRim = false;     ///< nothing goes on beyond it
  };
  static double smoothDistance(bool isBefore, double distance, double halfThickness);
  Side sideAt(const ClosestTriangle& closest) const;
  glm::dvec3 normalOf(std::uint32_t triangle) const;
  void connect(const std::vector<std::uint32_t>& behind);
  bool isThin(std::uint32_t triangle, const MeshDistance& sheets, double thickness) const;

  const TriangleSoup* soup_;
  double pieceShare_;
  std::vector<bool> isBehind_, hasWideRim_, isTurned_;   ///< a triangle
  std::vector<std::array<std::uint32_t, 3>> neighbours_; ///< a triangle: beyond edge k; kNoTriangle: none
  std::vector<Side> sideOfVertex_;                       ///< a welded vertex
};

} // namespace brickfield
