// How thick the closed solid behind a point of its surface is, along the triangle's normal: to the first place found
// where the solid has ended.
//
//   surface  ----p----------------   first look: the ball half the limit behind p; where it touches nothing,
//                |                   the solid is thicker than the limit
//                v  then signs, halving between a place inside and one outside
//   opposite ---------------------
#pragma once

#include "bakers/inside_test.h"
#include "bakers/mesh_distance.h"

namespace brickfield {

/// Whether the sides of a triangle are inside, where that is known, and a ball that no triangle comes into.
struct KnownSides {
  std::optional<bool> before, behind;
  glm::dvec3 emptyCenter{0.0};
  double emptyRadius = 0;
};

class SolidThickness {
public:
  /// solid   of all solid triangles
  /// All must outlive this.
  SolidThickness(const TriangleSoup& soup, const MeshTopology& topology, const MeshDistance& solid,
                 const InsideTest& inside)
      : soup_(&soup), topology_(&topology), solid_(&solid), inside_(&inside) {}

  /// True for triangles that bound a closed solid, of which alone behind() speaks.
  bool isClosed(std::uint32_t triangle) const {
    return topology_->inClosedComponent[triangle] && !topology_->isFlatPair[triangle];
  }

  /// point     on the triangle, which is closed
  /// limit     soup space; infinite is returned for more, and where a gap less than half the limit wide hides the end
  /// known     signs close to the triangle that need not be asked for
  /// returns   never over, and less than a sixth under, down to limit / 128; nothing where both sides are inside
  /// cost      two signs and a distance, and up to seven signs where something is near
  /// proved by tests/bake/bakers/thin_parts_test.cpp
  std::optional<double> behind(std::uint32_t triangle, glm::dvec3 point, double limit,
                               const KnownSides& known = {}) const;

  const TriangleSoup& soup() const { return *soup_; }

private:
  double endBetween(glm::dvec3 point, glm::dvec3 inwards, glm::dvec2 insideAndOutside) const;

  const TriangleSoup* soup_;
  const MeshTopology* topology_;
  const MeshDistance* solid_;
  const InsideTest* inside_;
};

} // namespace brickfield
