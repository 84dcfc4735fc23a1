// The hierarchy over all world triangles on the GPU: trees over the triangles of each instance, built once and shared
// in shape by instances of one mesh, and above them a tree over the instances, built anew whenever something moved.
// What it is not: bounds. They are fitted by HierarchyRefitPass, to the triangles as they stand in world_triangles.
//
//   nodes:  [ top, room for one less than instances | tree of instance 0 | tree of instance 1 | ... ]
//   order:  [ world triangles of instance 0, as its leaves name them     | of instance 1      | ... ]
#pragma once

#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "resident/hierarchy_tree.h"

namespace brickfield {

struct HierarchyInstance {
  std::uint32_t tree = 0;          ///< which of the trees; its items are the instance's triangles
  std::uint32_t firstTriangle = 0; ///< row of world_triangles
};

/// What is to be refitted, in the order of the dispatches; rows are those of the refit buffer.
struct RefitSchedule {
  struct Rows {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  std::vector<Rows> heights; ///< rows of at most REFIT_GROUP nodes each; all of one entry may be done at once
  Rows lists;                ///< then of each tree what is left: a list of rows for one work group
  Rows top;                  ///< then the tree over the instances: one list
  std::uint64_t nodeCount = 0;
};

class TriangleHierarchy {
public:
  /// trees      of meshes; those with the same tree share its topology, not its memory
  /// error      BadInput: more instances or triangles than words can name
  TriangleHierarchy(std::span<const HierarchyTree> trees, std::span<const HierarchyInstance> instances);

  /// Builds the tree over instances and schedules the refitting, which HierarchyRefitPass must do before the next ray.
  ///
  /// boxesAnchored  an instance each; only a hint, a poor one makes rays slow and never wrong; an empty one leaves its
  ///                instance out
  /// moved          instances whose triangles changed; at the first update all must be named
  /// error          Failure: an instance that does not exist
  /// cost           CPU O(n log n) in instances; uploads 64 bytes an instance and 16 a work group; where nothing moved
  ///                and the boxes are the same, none of that and nothing to refit
  void update(std::span<const Box> boxesAnchored, std::span<const std::uint32_t> moved);

  const RefitSchedule& schedule() const { return schedule_; }
  std::uint32_t instanceCount() const { return static_cast<std::uint32_t>(instances_.size()); }
  std::uint32_t triangleCount() const { return triangleCount_; } ///< of all instances
  std::size_t bytes() const { return nodes_.bytes() + order_.bytes() + refit_.bytes(); }

  /// Buffers and the root for a program that includes lib/triangle_hierarchy.glsl.
  /// triangles  rows of shared::WorldTriangle
  void bind(Program& program, const Buffer& triangles) const;
  void bindRefit(const Buffer& triangles) const;

private:
  struct Placed {
    std::uint32_t tree = 0;
    std::uint32_t firstNode = 0;
    std::uint32_t root = shared::HIERARCHY_NONE; ///< a word of the whole hierarchy
  };
  void buildTop(std::span<const Box> boxesAnchored, std::vector<shared::RefitRow>& topRows);
  void scheduleInstances(std::span<const std::uint32_t> moved, std::vector<shared::RefitRow>& rows);

  std::vector<HierarchyTree> trees_; ///< without order: only nodes' heights are needed later
  std::vector<Placed> instances_;
  std::vector<Box> boxes_; ///< of the last update
  std::uint32_t root_ = shared::HIERARCHY_NONE;
  std::uint32_t triangleCount_ = 0;
  RefitSchedule schedule_;
  Buffer nodes_, order_, refit_;
};

} // namespace brickfield
