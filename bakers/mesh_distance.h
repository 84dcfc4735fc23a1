// Exact unsigned distance from a point to triangles, by a best-first walk of our own over a MeshHierarchy. Boxes and
// triangles are first tested in float, eight at a time, with a slack that covers rounding; what might be the closest is
// then measured in double. Ties go to the triangle of the lowest number, so the result does not depend on the tree.
#pragma once

#include <limits>

#include "bakers/mesh_hierarchy.h"
#include "bakers/mesh_topology.h"

namespace brickfield {

/// Which part of a triangle a closest point lies on: a corner, the edge from corner k to k+1, or the inside.
enum class TriangleFeature : std::uint8_t { Corner0, Corner1, Corner2, Edge0, Edge1, Edge2, Inside };

struct PointOnTriangle {
  glm::dvec3 point{0.0};
  glm::dvec2 barycentric{0.0}; ///< weights of the second and third corner
  TriangleFeature feature = TriangleFeature::Inside;
};

/// Closest point of a triangle: the foot on its plane where that lies inside, else the nearest foot on an edge.
PointOnTriangle closestPointOnTriangle(glm::dvec3 point, const std::array<glm::dvec3, 3>& corners);

struct ClosestTriangle {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = kNoTriangle; ///< of the soup; none where nothing lies within the limit
  PointOnTriangle on;
};

class MeshDistance {
public:
  /// hierarchy must outlive this
  explicit MeshDistance(const MeshHierarchy& hierarchy) : hierarchy_(&hierarchy) {}

  /// point       soup space
  /// maxDistance only triangles nearer than this or as near are found
  /// hint        any triangle of this hierarchy that is likely close; changes the time, never the result
  /// returns     exact to the rounding of double
  /// cost        about 1 us near a dense mesh with a good hint
  /// proved by   tests/oracle/bakers/mesh_distance_test.cpp
  ClosestTriangle closest(glm::dvec3 point, double maxDistance = std::numeric_limits<double>::infinity(),
                          std::uint32_t hint = kNoTriangle) const;

private:
  const MeshHierarchy* hierarchy_;
};

} // namespace brickfield
