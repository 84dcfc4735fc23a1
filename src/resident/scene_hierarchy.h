// The triangle hierarchy of a scene, kept in step with its world triangles.
#pragma once

#include <optional>
#include <vector>

#include "resident/triangle_hierarchy.h"
#include "resident/world_triangles.h"

namespace brickfield {

class SceneHierarchy {
public:
  /// scene  must outlive this
  explicit SceneHierarchy(const Scene& scene) : scene_(&scene), treeOfMesh_(scene.meshes.size(), -1) {}

  /// Schedules what HierarchyRefitPass has to do for a pose, before the triangles are settled.
  ///
  /// isNew  what WorldTriangles::setPose said: the instances are laid out anew, all are refitted
  /// error  BadInput: more triangles or instances than the hierarchy can name
  /// cost   a tree for each mesh when it is first drawn, about a second a million triangles; then that of
  ///        TriangleHierarchy::update
  void update(const WorldTriangles& triangles, bool isNew);

  /// After the first update.
  const TriangleHierarchy& hierarchy() const { return *hierarchy_; }
  std::size_t bytes() const { return hierarchy_ ? hierarchy_->bytes() : 0; }

private:
  void layOut(const WorldTriangles& triangles);

  const Scene* scene_;
  std::vector<int> treeOfMesh_; ///< -1: not built
  std::vector<HierarchyTree> trees_;
  std::optional<TriangleHierarchy> hierarchy_;
};

} // namespace brickfield
