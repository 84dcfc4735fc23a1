// A binary tree over boxes, built once on the CPU by the surface area heuristic with bins (Wald 2007). It is topology
// alone: bounds are fitted on the GPU, where the triangles stand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "scene/scene.h"
#include "shared/triangle_hierarchy_params.h"

namespace brickfield {

/// Words are those of shared/triangle_hierarchy_params.h, counted from the tree's own first node and order entry.
struct HierarchyTree {
  struct Node {
    std::uint32_t left = 0;
    std::uint32_t right = 0;
  };
  std::uint32_t root = shared::HIERARCHY_NONE; ///< a leaf where few items need no node
  std::vector<Node> nodes;                     ///< by falling height: parents before children, the root first
  std::vector<std::uint32_t> order;            ///< item numbers as leaves name them: a permutation
  /// heightEnds[h]: one past the last node of height h; nodes over leaves alone have height 0, and
  /// heightEnds[h + 1] is the first of height h (0 above the root's).
  std::vector<std::uint32_t> heightEnds;

  std::uint32_t heights() const { return static_cast<std::uint32_t>(heightEnds.size()); }
  std::uint32_t heightBegin(std::uint32_t height) const { return height + 1 < heights() ? heightEnds[height + 1] : 0; }
};

struct HierarchyLimits {
  std::uint32_t leafItems = shared::HIERARCHY_LEAF_TRIANGLES;
  std::uint32_t levels = shared::HIERARCHY_LEVELS; ///< most nodes on a way down
};

/// boxes     of the items; empty ones and those that are not finite are kept too, anywhere: they may be finite later
/// returns   the same tree on every machine; no way down has more nodes than limits.levels, because where the heuristic
///           would run out of levels it halves instead
/// error     BadInput: more items than leafItems << levels
/// cost      O(n log n); about a second a million
/// proved by tests/unit/resident/hierarchy_tree_test.cpp
HierarchyTree buildHierarchyTree(std::span<const Box> boxes, const HierarchyLimits& limits = {});

struct TriangleCorners {
  glm::vec3 a{0.0f}, b{0.0f}, c{0.0f};
};
HierarchyTree buildHierarchyTree(std::span<const TriangleCorners> triangles);
/// Over the triangles of a mesh at rest, numbered through its primitives: as its instances' world triangles are.
HierarchyTree buildHierarchyTree(const Mesh& mesh);

} // namespace brickfield
