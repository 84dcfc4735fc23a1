// Trees are built over meshes at rest; the order of a mesh's triangles is that of its instances' world triangles.
#include "resident/scene_hierarchy.h"

#include <numeric>

namespace brickfield {

void SceneHierarchy::layOut(const WorldTriangles& triangles) {
  std::vector<HierarchyInstance> instances;
  for (const InstanceRange& range : triangles.instances()) {
    const auto mesh = static_cast<std::size_t>(scene_->nodes[static_cast<std::size_t>(range.node)].mesh);
    if (treeOfMesh_[mesh] < 0) {
      treeOfMesh_[mesh] = static_cast<int>(trees_.size());
      trees_.push_back(buildHierarchyTree(scene_->meshes[mesh]));
    }
    instances.push_back({static_cast<std::uint32_t>(treeOfMesh_[mesh]), range.firstTriangle});
  }
  hierarchy_.emplace(trees_, instances);
}

void SceneHierarchy::update(const WorldTriangles& triangles, bool isNew) {
  const bool isLaidOut = isNew || !hierarchy_;
  if (isLaidOut) layOut(triangles);
  std::vector<Box> boxes;
  for (const InstanceRange& range : triangles.instances()) boxes.push_back(range.boundsAnchored);
  std::vector<std::uint32_t> moved;
  if (isLaidOut) {
    moved.resize(boxes.size());
    std::iota(moved.begin(), moved.end(), 0u);
  } else {
    for (const MovedInstance& instance : triangles.moved()) moved.push_back(instance.instance);
  }
  hierarchy_->update(boxes, moved);
}

} // namespace brickfield
