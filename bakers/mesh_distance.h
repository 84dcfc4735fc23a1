// Exact unsigned distance from a point to triangles, by a best-first walk of our own over a MeshHierarchy. Boxes and
// triangles are first tested in float, eight at a time (AVX2 where the processor has it), with a slack that covers
// rounding; what might be the closest is then measured in double. Ties go to the triangle of the lowest number, so the
// result does not depend on the tree.
#pragma once

#include <limits>
#include <span>

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

inline constexpr std::uint32_t kNoLeaf = ~0u;

/// What closest() finds, without where on the triangle.
struct NearestTriangle {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = kNoTriangle;
  std::uint32_t leaf = kNoLeaf; ///< of the hierarchy: where to start next
};

/// A cube and what lies within reach of it, in soup space.
struct CubeAround {
  glm::dvec3 center{0.0};
  double halfEdge = 0, reach = 0;
};

/// Where walks within a cube may start instead of at the root.
struct LocalRoots {
  static constexpr std::size_t kMostNodes = 6;
  static constexpr std::size_t kMostChildren = kMostNodes * kHierarchyWidth;
  std::array<HierarchyNode, kMostNodes> nodes;
  std::size_t count = 0; ///< of the nodes

  /// Of so many children; the lanes behind the last are put infinitely far.
  void close(std::size_t childCount);
};

class MeshDistance {
public:
  /// hierarchy must outlive this
  explicit MeshDistance(const MeshHierarchy& hierarchy) : hierarchy_(&hierarchy) {}

  /// point       soup space
  /// maxDistance only triangles nearer than this or as near are found
  /// hint        any triangle of this hierarchy that is likely close; changes the time, never the result
  /// returns     exact to the rounding of double
  /// cost        about 0.3 us near a dense mesh
  /// proved by   tests/oracle/bakers/mesh_distance_test.cpp
  ClosestTriangle closest(glm::dvec3 point, double maxDistance = std::numeric_limits<double>::infinity(),
                          std::uint32_t hint = kNoTriangle) const;

  /// The same distance and triangle; faster where the closest point itself is of no use.
  ///
  /// maxDistance  the closer above the distance, the faster
  /// startLeaf    what a query close by found; changes the time, never the result
  NearestTriangle nearest(glm::dvec3 point, double maxDistance = std::numeric_limits<double>::infinity(),
                          std::uint32_t startLeaf = kNoLeaf) const;
  /// The same, for points of a cube and distances up to its reach.
  NearestTriangle nearest(const LocalRoots& roots, glm::dvec3 point, double maxDistance,
                          std::uint32_t startLeaf = kNoLeaf) const;
  LocalRoots rootsAround(const CubeAround& cube) const;

  /// All triangles that come within reach of a cube, and some that almost do, in no order.
  ///
  /// found    gets them; at least one
  /// returns  how many; more than `found` holds where they do not fit, and it is of no use then
  std::size_t collect(const CubeAround& cube, std::span<std::uint32_t> found) const;

  const MeshHierarchy& hierarchy() const { return *hierarchy_; }

private:
  const MeshHierarchy* hierarchy_;
};

} // namespace brickfield
