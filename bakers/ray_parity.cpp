// A triangle is crossed where the point lies in its projection along the ray and its plane lies ahead. The projection
// is tested by crossings again: an edge counts if it spans the point's row (one end on or below it, the other above)
// and passes beyond the point. Both users of an edge compute that from the same end, hence bit for bit alike.
#include "bakers/ray_parity.h"

#include <algorithm>
#include <array>

namespace brickfield {

namespace {

constexpr float kBoxSlack = 1e-6f; // soup space: above the rounding of coordinates below 4 to float

struct RayAxes {
  glm::length_t along, column, row;
};

bool edgePassesBeyond(const TriangleSoup& soup, std::uint32_t i, std::uint32_t j, glm::dvec3 point, RayAxes axes) {
  const glm::dvec3 &from = soup.positions[std::min(i, j)], &to = soup.positions[std::max(i, j)];
  if ((from[axes.row] > point[axes.row]) == (to[axes.row] > point[axes.row])) return false;
  const double share = (point[axes.row] - from[axes.row]) / (to[axes.row] - from[axes.row]);
  return from[axes.column] + share * (to[axes.column] - from[axes.column]) > point[axes.column];
}

bool isCrossed(const TriangleSoup& soup, std::uint32_t triangle, glm::dvec3 point, RayAxes axes) {
  const TriangleVertices& v = soup.triangles[triangle];
  bool odd = false;
  for (std::size_t k = 0; k < 3; ++k) odd ^= edgePassesBeyond(soup, v[k], v[(k + 1) % 3], point, axes);
  if (!odd) return false;
  const auto [a, b, c] = soup.corners(triangle);
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  // Height of the point over the plane and the plane's slope along the ray: the plane is ahead if they differ in sign.
  return (glm::dot(normal, point - a) < 0) == (normal[axes.along] > 0);
}

bool isOddAlong(const MeshHierarchy& hierarchy, glm::dvec3 point, RayAxes axes) {
  const glm::vec3 p(point);
  std::array<HierarchyChild, 64 * kHierarchyWidth> stack;
  std::size_t size = 0;
  stack[size++] = hierarchy.root();
  bool odd = false;
  while (size > 0) {
    const HierarchyChild top = stack[--size];
    if (top.isLeaf()) {
      const HierarchyLeaf& leaf = hierarchy.leaves()[top.index()];
      for (std::size_t i = 0; i < leaf.count(); ++i) odd ^= isCrossed(hierarchy.soup(), leaf.triangles[i], point, axes);
      continue;
    }
    const HierarchyNode& node = hierarchy.nodes()[top.index()];
    for (std::size_t i = 0; i < kHierarchyWidth && !node.children[i].isNone(); ++i) {
      const glm::vec3 min = node.min.lane(i) - kBoxSlack, max = node.max.lane(i) + kBoxSlack;
      const auto spans = [&](glm::length_t axis) { return min[axis] <= p[axis] && p[axis] <= max[axis]; };
      if (spans(axes.column) && spans(axes.row) && p[axes.along] <= max[axes.along]) stack[size++] = node.children[i];
    }
  }
  return odd;
}

} // namespace

bool isInsideByParity(const MeshHierarchy& hierarchy, glm::dvec3 point) {
  int votes = 0;
  for (const RayAxes axes : {RayAxes{0, 1, 2}, RayAxes{1, 2, 0}, RayAxes{2, 0, 1}})
    votes += isOddAlong(hierarchy, point, axes);
  return votes >= 2;
}

} // namespace brickfield
