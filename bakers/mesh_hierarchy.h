// Bounding volume hierarchy over triangles: built by Embree's generic builder (eight children a node, up to eight
// triangles a leaf), then laid flat. It answers nothing itself: mesh_distance, winding_number and ray_parity walk it.
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

/// Eight triangles side by side. Lanes at and above `count` repeat the last triangle.
struct HierarchyLeaf {
  Vector8 a, ab, ac; ///< first corner, edges from it
  Vector8 normal;    ///< unit, counter-clockwise; rounded from double, so that slivers have a good one too
  std::array<std::uint32_t, kHierarchyWidth> triangles; ///< of the soup
  std::uint32_t count = 0;
};

class MeshHierarchy {
public:
  /// triangles of the soup, at least one; boxes and corners in soup space
  /// cost      O(n log n), one thread: the same tree everywhere
  MeshHierarchy(const TriangleSoup& soup, std::vector<std::uint32_t> triangles);

  const TriangleSoup& soup() const { return *soup_; }
  HierarchyChild root() const { return {0}; }
  const std::vector<HierarchyNode>& nodes() const { return nodes_; } ///< parents before children
  const std::vector<HierarchyLeaf>& leaves() const { return leaves_; }

private:
  const TriangleSoup* soup_;
  std::vector<HierarchyNode> nodes_;
  std::vector<HierarchyLeaf> leaves_;
};

} // namespace brickfield
