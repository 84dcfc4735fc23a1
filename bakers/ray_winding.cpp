// Each end of an edge is sheared by itself, so that all users of an edge see the same bits: those that pass the ray's
// row beyond it count up or down by their direction.
#include "bakers/ray_winding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

constexpr float kColumnShear = RayWinding::kColumnShear, kRowShear = RayWinding::kRowShear;
constexpr float kRaySlack = 4e-6f; // soup space: above the rounding of sheared coordinates below 4 to float

/// A point as the ray sees it.
struct ShearedPoint {
  double height, column, row;
};
inline ShearedPoint sheared(glm::dvec3 point, const RayWinding::Ray& ray) {
  const glm::dvec3 offset = point - ray.origin;
  const double height = ray.isBackwards ? -offset[ray.along] : offset[ray.along];
  return {height, offset[(ray.along + 1) % 3] - double{kColumnShear} * height,
          offset[(ray.along + 2) % 3] - double{kRowShear} * height};
}

/// Whether a ray crosses a triangle: 1 where its corners turn left around the ray as columns and rows do, -1 where they
/// turn right; 0 where it does not.
int crossing(const TriangleSoup& soup, std::uint32_t triangle, const RayWinding::Ray& ray) {
  const TriangleVertices& v = soup.triangles[triangle];
  std::array<ShearedPoint, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = sheared(soup.positions[v[k]], ray);
  int turns = 0;
  std::array<double, 3> cross; // of corner k and the next
  for (std::size_t k = 0; k < 3; ++k) {
    const ShearedPoint &from = p[k], &to = p[(k + 1) % 3];
    cross[k] = from.column * to.row - to.column * from.row;
    if ((from.row > 0) != (to.row > 0) && cross[k] != 0 && (cross[k] > 0) == (to.row > 0)) turns += to.row > 0 ? 1 : -1;
  }
  if (turns == 0) return 0;
  const double height = p[2].height * cross[0] + p[0].height * cross[1] + p[1].height * cross[2];
  if ((height > 0) != (turns > 0)) return 0; // behind the origin
  return turns;
}

#define BRICKFIELD_SIMD_FILE "bakers/ray_walk.inl"
#include "bakers/each_simd.inl"

} // namespace

RayWinding::RayWinding(const MeshHierarchy& hierarchy) : hierarchy_(&hierarchy) {
  const HierarchyNode& root = hierarchy.nodes()[hierarchy.root().index()];
  for (std::size_t i = 0; i < kHierarchyWidth && !root.children[i].isNone(); ++i) {
    low_ = glm::min(low_, glm::dvec3(root.min.lane(i)));
    high_ = glm::max(high_, glm::dvec3(root.max.lane(i)));
  }
}

int RayWinding::at(glm::dvec3 point) const {
  const double slack = static_cast<double>(kRaySlack);
  if (glm::any(glm::lessThan(point, low_ - slack)) || glm::any(glm::greaterThan(point, high_ + slack))) return 0;
  return crossings(rayFrom(point));
}

RayWinding::Ray RayWinding::rayFrom(glm::dvec3 point) const {
  Ray ray{point, 0, false};
  double least = HUGE_VAL;
  for (glm::length_t axis = 0; axis < 3; ++axis)
    for (const bool isBackwards : {false, true}) {
      const double way = isBackwards ? point[axis] - low_[axis] : high_[axis] - point[axis];
      if (way < least) least = way, ray.along = axis, ray.isBackwards = isBackwards;
    }
  return ray;
}

int RayWinding::crossings(const Ray& ray) const { return BRICKFIELD_BEST_SIMD(crossings(*hierarchy_, ray)); }

} // namespace brickfield
