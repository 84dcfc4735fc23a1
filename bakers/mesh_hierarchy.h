// Bounding volume hierarchy over triangles: eight children a node, leaves of exactly eight triangles as blocks for
// SIMD. It answers nothing itself: mesh_distance, winding_number and ray_parity walk it.
//
// Built top down by the surface area heuristic over bins, as Embree does (Wald, On fast Construction of SAH-based
// Bounding Volume Hierarchies, 2007), but split at multiples of eight alone: Embree's own builder leaves a third of the
// lanes of leaves in use, which costs three times the memory, and sorts equal triangles in varying order on several
// threads.
#pragma once

#include <cstdint>
#include <vector>

#include "bakers/float4.h"
#include "bakers/triangle_soup.h"

namespace brickfield {

inline constexpr std::size_t kHierarchyWidth = 8;

/// Names a node, a leaf or nothing.
struct HierarchyChild {
  std::uint32_t bits = kNone;
  static constexpr std::uint32_t kNone = ~0u;
  static constexpr std::uint32_t kLeafBit = 1u << 31;
  bool isNone() const { return bits == kNone; }
  bool isLeaf() const { return bits & kLeafBit; }
  std::uint32_t index() const { return bits & ~kLeafBit; }
};

/// Boxes of the children. Absent ones come last, have an inverted infinite box, and so are infinitely far.
struct HierarchyNode {
  Vector8 min, max;
  std::array<HierarchyChild, kHierarchyWidth> children;
};

/// Eight triangles side by side, ascending, each in a frame of its own: the first corner, x along the first edge, z
/// along the normal. Lanes that are left repeat the last triangle; only the last leaf has some.
///
///          C        ac, bc: unit directions in the plane
///      ac / \ bc
///        A---B      A = (0, 0), B = (lengthAb, 0), C = lengthAc * ac = B + lengthBc * bc, with C above AB
struct HierarchyLeaf {
  Vector8 a;       ///< first corner, soup space
  Vector8 alongAb; ///< unit
  Vector8 normal;  ///< unit, counter-clockwise; rounded from double, so that slivers have a good one too
  Float8 acX, acY, bcX, bcY;
  Float8 lengthAb, lengthAc, lengthBc;
  std::array<std::uint32_t, kHierarchyWidth> triangles; ///< of the soup

  std::uint32_t count() const {
    std::uint32_t lanes = 1;
    while (lanes < kHierarchyWidth && triangles[lanes] != triangles[lanes - 1]) ++lanes;
    return lanes;
  }
};

class MeshHierarchy {
public:
  /// triangles of the soup, at least one, ascending; boxes and corners in soup space
  /// cost      O(n log n), all threads; the same tree on any number of them
  /// proved by tests/bake/bakers/band_bake_test.cpp
  MeshHierarchy(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles);

  const TriangleSoup& soup() const { return *soup_; }
  HierarchyChild root() const { return {0}; }
  const LargeVector<HierarchyNode>& nodes() const { return nodes_; } ///< parents before children
  const LargeVector<HierarchyLeaf>& leaves() const { return leaves_; }
  std::size_t triangleCount() const { return triangleCount_; }
  std::size_t bytes() const { return nodes_.size() * sizeof(HierarchyNode) + leaves_.size() * sizeof(HierarchyLeaf); }

private:
  const TriangleSoup* soup_;
  std::size_t triangleCount_;
  LargeVector<HierarchyNode> nodes_;
  LargeVector<HierarchyLeaf> leaves_;
};

} // namespace brickfield
