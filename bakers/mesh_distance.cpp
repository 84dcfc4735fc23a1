// The walk stands in closest_walk.inl and is compiled for each set of instructions.
#include "bakers/mesh_distance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

constexpr double kFloatSlack = 2e-6;

/// Where the foot of a point on a triangle's plane is.
struct Foot {
  glm::dvec3 ab, ac;
  double weightB, weightC, weightSum; ///< of the corners, and of all three

  Foot(glm::dvec3 point, const std::array<glm::dvec3, 3>& corners)
      : ab(corners[1] - corners[0]), ac(corners[2] - corners[0]) {
    // Triple products, not the differences of products of dot products: those lose a sliver's inside to cancellation.
    const glm::dvec3 ap = point - corners[0], normal = glm::cross(ab, ac);
    weightB = glm::dot(glm::cross(ap, ac), normal), weightC = glm::dot(glm::cross(ab, ap), normal);
    weightSum = glm::dot(normal, normal);
  }
  bool isInside() const { return weightB >= 0 && weightC >= 0 && weightB + weightC <= weightSum; }
  /// Whether it is beyond the edge from corner k. From outside, one of those edges has the closest point.
  bool isBeyond(std::size_t k) const {
    return k == 0 ? !(weightC >= 0) : k == 1 ? !(weightB + weightC <= weightSum) : !(weightB >= 0);
  }
};

/// The distance to closestPointOnTriangle's point.
inline double distanceToTriangle(glm::dvec3 point, const std::array<glm::dvec3, 3>& corners) {
  const Foot of(point, corners);
  if (of.isInside()) {
    const double v = of.weightB / of.weightSum, w = of.weightC / of.weightSum;
    return glm::length(point - (corners[0] + v * of.ab + w * of.ac));
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    if (!of.isBeyond(k)) continue;
    const glm::dvec3 from = corners[k], edge = corners[(k + 1u) % 3u] - from;
    const double t = std::clamp(glm::dot(point - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
    const glm::dvec3 away = point - (from + t * edge);
    least = std::min(least, glm::dot(away, away));
  }
  return std::sqrt(least);
}

#define BRICKFIELD_SIMD_FILE "bakers/closest_walk.inl"
#include "bakers/each_simd.inl"

} // namespace

PointOnTriangle closestPointOnTriangle(glm::dvec3 point, const std::array<glm::dvec3, 3>& corners) {
  const Foot of(point, corners);
  if (of.isInside()) {
    const double v = of.weightB / of.weightSum, w = of.weightC / of.weightSum;
    return {corners[0] + v * of.ab + w * of.ac, {v, w}, TriangleFeature::Inside};
  }
  PointOnTriangle best;
  double bestSquared = std::numeric_limits<double>::infinity();
  for (std::uint8_t k = 0; k < 3; ++k) {
    if (!of.isBeyond(k)) continue;
    const glm::dvec3 from = corners[k], edge = corners[(k + 1u) % 3u] - from;
    const double t = std::clamp(glm::dot(point - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
    const glm::dvec3 foot = from + t * edge, away = point - foot;
    if (!(glm::dot(away, away) < bestSquared)) continue;
    bestSquared = glm::dot(away, away);
    const std::array<glm::dvec2, 3> barycentrics = {glm::dvec2(t, 0), glm::dvec2(1 - t, t), glm::dvec2(0, 1 - t)};
    const std::uint8_t feature = t <= 0 ? k : t >= 1 ? static_cast<std::uint8_t>((k + 1u) % 3u) : k + 3u;
    best = {foot, barycentrics[k], static_cast<TriangleFeature>(feature)};
  }
  return best;
}

void LocalRoots::close(std::size_t childCount) {
  count = (childCount + kHierarchyWidth - 1) / kHierarchyWidth;
  for (std::size_t i = childCount; i < count * kHierarchyWidth; ++i) {
    HierarchyNode& node = nodes[i / kHierarchyWidth];
    node.min.setLane(i % kHierarchyWidth, glm::vec3(std::numeric_limits<float>::infinity()));
    node.max.setLane(i % kHierarchyWidth, glm::vec3(-std::numeric_limits<float>::infinity()));
    node.children[i % kHierarchyWidth] = {};
  }
}

NearestTriangle MeshDistance::nearest(glm::dvec3 point, double maxDistance, std::uint32_t startLeaf) const {
  const std::span root(&hierarchy_->nodes()[hierarchy_->root().index()], 1);
  return BRICKFIELD_BEST_SIMD(walkToNearest(*hierarchy_, root, point, maxDistance, startLeaf));
}

NearestTriangle MeshDistance::nearest(const LocalRoots& roots, glm::dvec3 point, double maxDistance,
                                      std::uint32_t startLeaf) const {
  const std::span<const HierarchyNode> nodes = std::span(roots.nodes).first(roots.count);
  return BRICKFIELD_BEST_SIMD(walkToNearest(*hierarchy_, nodes, point, maxDistance, startLeaf));
}

LocalRoots MeshDistance::rootsAround(const CubeAround& cube) const {
  LocalRoots roots;
  BRICKFIELD_BEST_SIMD(walkToRoots(*hierarchy_, cube, roots));
  return roots;
}

std::size_t MeshDistance::collect(const CubeAround& cube, std::span<std::uint32_t> found) const {
  return BRICKFIELD_BEST_SIMD(walkAround(*hierarchy_, cube, found));
}

ClosestTriangle MeshDistance::closest(glm::dvec3 point, double maxDistance, std::uint32_t hint) const {
  double limit = maxDistance;
  if (hint != kNoTriangle) limit = std::min(limit, distanceToTriangle(point, hierarchy_->soup().corners(hint)));
  const NearestTriangle found = nearest(point, limit);
  if (found.triangle == kNoTriangle) return {};
  return {found.distance, found.triangle, closestPointOnTriangle(point, hierarchy_->soup().corners(found.triangle))};
}

} // namespace brickfield
