// The walk: nodes are opened nearest first from a stack whose entries remember their distance.
//
// Slack. Coordinates are at most R + |p| in magnitude; a float coordinate or difference of theirs is off by less than
// 2^-23 (R + |p|), and the longest chain of such roundings in a box or triangle test stays below 16 of them. So a float
// distance never exceeds the true one by more than 2e-6 (R + |p|), and what lies further behind the best is no rival.
#include "bakers/mesh_distance.h"

#include <algorithm>
#include <cmath>

namespace brickfield {

namespace {

constexpr double kFloatSlack = 2e-6;

struct Candidate {
  float distanceSquared;
  HierarchyChild child;
};

/// Squared distances from a point to the eight boxes of a node; 0 inside.
Float8 boxDistancesSquared(const HierarchyNode& node, const Vector4& point) {
  Float8 result;
  const Float4 zero = broadcast(0.0f);
  for (std::size_t h = 0; h < 2; ++h) {
    const Vector4 below = node.min.half(h) - point, above = point - node.max.half(h);
    const Vector4 outside{maximum(maximum(below.x, above.x), zero), maximum(maximum(below.y, above.y), zero),
                          maximum(maximum(below.z, above.z), zero)};
    result.halves[h] = dot(outside, outside);
  }
  return result;
}

/// Squared distance from origin + ap to the segment [0, edge].
Float4 segmentDistanceSquared(const Vector4& ap, const Vector4& edge) {
  const Vector4 rest = ap - clampUnit(dot(ap, edge) / dot(edge, edge)) * edge;
  return dot(rest, rest);
}

/// Squared distances from a point to the eight triangles of a leaf: to the plane where the foot lies inside, else to
/// the nearest edge.
Float8 triangleDistancesSquared(const HierarchyLeaf& leaf, const Vector4& point) {
  Float8 result;
  const Float4 zero = broadcast(0.0f);
  for (std::size_t h = 0; h < 2; ++h) {
    const Vector4 ab = leaf.ab.half(h), ac = leaf.ac.half(h), normal = leaf.normal.half(h);
    const Vector4 ap = point - leaf.a.half(h), bp = ap - ab, bc = ac - ab;
    const Float4 edges = minimum(minimum(segmentDistanceSquared(ap, ab), segmentDistanceSquared(ap, ac)),
                                 segmentDistanceSquared(bp, bc));
    const Float4 height = dot(ap, normal);
    const Float4 inside =
        minimum(minimum(dot(cross(ab, ap), normal), dot(cross(ap, ac), normal)), dot(cross(bc, bp), normal));
    result.halves[h] = inside >= zero ? height * height : edges;
  }
  return result;
}

/// Walk state: the best so far and the float bound that a rival must not exceed.
class ClosestSearch {
public:
  ClosestSearch(const MeshHierarchy& hierarchy, glm::dvec3 point, double maxDistance)
      : hierarchy_(hierarchy), point_(point), slack_(kFloatSlack * (hierarchy.soup().reach + glm::length(point))) {
    best_.distance = maxDistance;
    tighten();
  }

  void measure(std::uint32_t triangle) {
    if (triangle == best_.triangle) return;
    const PointOnTriangle on = closestPointOnTriangle(point_, hierarchy_.soup().corners(triangle));
    const double distance = glm::length(point_ - on.point);
    if (distance > best_.distance || (distance == best_.distance && triangle > best_.triangle)) return;
    best_ = {distance, triangle, on};
    tighten();
  }

  ClosestTriangle run() {
    const Vector4 point = broadcast(glm::vec3(point_));
    std::array<Candidate, 64 * kHierarchyWidth> stack; // depth of the builder times what a level leaves behind
    std::size_t size = 0;
    stack[size++] = {0.0f, hierarchy_.root()};
    while (size > 0) {
      const Candidate top = stack[--size];
      if (top.distanceSquared > bound_) continue;
      if (top.child.isLeaf())
        visitLeaf(hierarchy_.leaves()[top.child.index()], point);
      else
        size = openNode(hierarchy_.nodes()[top.child.index()], point, stack.data(), size);
    }
    if (best_.triangle == kNoTriangle) best_.distance = std::numeric_limits<double>::infinity();
    return best_;
  }

private:
  void tighten() {
    const double reachable = best_.distance + slack_;
    bound_ = static_cast<float>(reachable * reachable * (1.0 + 1e-6)); // 1e-6: rounding of the squares
  }

  void visitLeaf(const HierarchyLeaf& leaf, const Vector4& point) {
    const Float8 distances = triangleDistancesSquared(leaf, point);
    for (std::size_t i = 0; i < leaf.count; ++i)
      if (distances.lane(i) <= bound_) measure(leaf.triangles[i]);
  }

  /// Pushes the children within reach, the nearest last.
  std::size_t openNode(const HierarchyNode& node, const Vector4& point, Candidate* stack, std::size_t size) const {
    const Float8 distances = boxDistancesSquared(node, point);
    const std::size_t bottom = size;
    for (std::size_t i = 0; i < kHierarchyWidth; ++i) {
      const float distance = distances.lane(i);
      if (!(distance <= bound_) || node.children[i].isNone()) continue;
      std::size_t slot = size++;
      for (; slot > bottom && stack[slot - 1].distanceSquared < distance; --slot) stack[slot] = stack[slot - 1];
      stack[slot] = {distance, node.children[i]};
    }
    return size;
  }

  const MeshHierarchy& hierarchy_;
  glm::dvec3 point_;
  double slack_;
  float bound_ = 0;
  ClosestTriangle best_;
};

} // namespace

PointOnTriangle closestPointOnTriangle(glm::dvec3 point, const std::array<glm::dvec3, 3>& corners) {
  const auto [a, b, c] = corners;
  const glm::dvec3 ab = b - a, ac = c - a, ap = point - a;
  const glm::dvec3 normal = glm::cross(ab, ac);
  // Triple products, not the differences of products of dot products: those lose a sliver's inside to cancellation.
  const double weightB = glm::dot(glm::cross(ap, ac), normal), weightC = glm::dot(glm::cross(ab, ap), normal);
  const double normalSquared = glm::dot(normal, normal);
  if (weightB >= 0 && weightC >= 0 && weightB + weightC <= normalSquared) {
    const double v = weightB / normalSquared, w = weightC / normalSquared;
    return {a + v * ab + w * ac, {v, w}, TriangleFeature::Inside};
  }
  PointOnTriangle best;
  double bestSquared = std::numeric_limits<double>::infinity();
  for (std::uint8_t k = 0; k < 3; ++k) {
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

ClosestTriangle MeshDistance::closest(glm::dvec3 point, double maxDistance, std::uint32_t hint) const {
  ClosestSearch search(*hierarchy_, point, maxDistance);
  if (hint != kNoTriangle) search.measure(hint);
  return search.run();
}

} // namespace brickfield
