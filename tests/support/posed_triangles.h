// World triangles gathered on the CPU, for tests of what reads them: corners alone, no pseudonormals.
#pragma once

#include <vector>

#include "resident/triangle_hierarchy.h"
#include "scene/pose.h"
#include "shared/world_field_params.h"

namespace brickfield::test {

struct PosedTriangles {
  std::vector<shared::WorldTriangle> rows;
  std::vector<HierarchyInstance> instances; ///< tree: the mesh
  std::vector<Box> boxes;                   ///< an instance each
  Box bounds;

  std::vector<std::uint32_t> allInstances() const;
};

/// Instances in the pose's order, each with its mesh's primitives in turn; anchored at the world's zero.
PosedTriangles gatherTriangles(const Scene& scene, const Pose& pose);
/// Triangles alone, as one instance of tree 0.
PosedTriangles gatherTriangles(const std::vector<TriangleCorners>& triangles);

/// A tree for each mesh, over its triangles at rest.
std::vector<HierarchyTree> buildMeshTrees(const Scene& scene);

/// A row that is no triangle's but these corners'.
shared::WorldTriangle makeRow(glm::vec3 a, glm::vec3 b, glm::vec3 c);

} // namespace brickfield::test
