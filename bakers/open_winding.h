// The winding number of open triangles. A ray from the point crosses them a whole number of times; had their rims been
// drawn out along it, backwards and without end, that would be the winding number of a closed surface. What the drawn
// out rims would add is their own solid angle, an edge at a time (rims.h). Where rim edges are very many, sums over all
// triangles are cheaper.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bakers/near_rims.h"
#include "bakers/winding_number.h"

namespace brickfield {

class OpenWinding {
public:
  /// triangles of the soup, at least one
  /// whole     a hierarchy of them that outlives this; nothing: made here
  OpenWinding(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles,
              const MeshHierarchy* whole = nullptr);

  const Rims& rims() const { return rims_; }

  /// point     soup space; of no use on a triangle itself
  /// returns   as exactly as its slack says: by few edges what far rims may add, by many 0.015
  /// cost      0.2 to 0.5 us with few edges
  /// proved by tests/bake/bakers/open_winding_test.cpp
  NearlyTurns nearlyAt(glm::dvec3 point) const;
  /// Within 0.02.
  double roughlyAt(glm::dvec3 point) const;
  /// To 1e-9; with many edges as near as nearlyAt, but for points that are almost half wrapped.
  ///
  /// cost      a ray and 3 ns a rim edge
  /// proved by tests/bake/bakers/open_winding_test.cpp
  double exactlyAt(glm::dvec3 point) const;
  /// For points in a ball; nothing where edges are many.
  std::optional<NearRims> nearRims(glm::dvec3 center, double radius) const;
  NearlyTurns nearlyAt(glm::dvec3 point, const NearRims& near) const;
  std::size_t bytes() const; ///< of all but the whole hierarchy

private:
  Rims rims_;
  std::unique_ptr<MeshHierarchy> own_;
  std::optional<RayWinding> rays_;
  std::optional<WindingNumber> sums_; ///< instead of rays where rim edges are many
};

} // namespace brickfield
