// Deformed on the CPU, moved to the world.
#include "tests/support/posed_triangles.h"

#include <numeric>

namespace brickfield::test {

std::vector<std::uint32_t> PosedTriangles::allInstances() const {
  std::vector<std::uint32_t> all(instances.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

shared::WorldTriangle makeRow(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  return {glm::vec4(a, 0), glm::vec4(b, 0), glm::vec4(c, 0), {0, 0, 0, 0}};
}

PosedTriangles gatherTriangles(const Scene& scene, const Pose& pose) {
  PosedTriangles result;
  for (const PosedInstance& instance : pose.instances) {
    result.instances.push_back(
        {static_cast<std::uint32_t>(instance.mesh), static_cast<std::uint32_t>(result.rows.size())});
    Box box;
    for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
      const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
      const auto corner = [&](std::size_t i) {
        const glm::vec3 point = transformPoint(instance.worldFromObject, deformed.positions[primitive.indices[i]]);
        box.extend(point);
        return point;
      };
      for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
        const glm::vec3 a = corner(i);
        glm::vec3 b = corner(i + 1), c = corner(i + 2);
        if (mirrorSign(instance.worldFromObject) < 0) std::swap(b, c); // still counter-clockwise from the front
        result.rows.push_back(makeRow(a, b, c));
      }
    }
    result.boxes.push_back(box);
    result.bounds.extend(box);
  }
  return result;
}

PosedTriangles gatherTriangles(const std::vector<TriangleCorners>& triangles) {
  PosedTriangles result;
  result.instances = {{0, 0}};
  for (const auto& [a, b, c] : triangles) {
    result.rows.push_back(makeRow(a, b, c));
    for (const glm::vec3 corner : {a, b, c}) result.bounds.extend(corner);
  }
  result.boxes = {result.bounds};
  return result;
}

std::vector<HierarchyTree> buildMeshTrees(const Scene& scene) {
  std::vector<HierarchyTree> trees;
  for (const Mesh& mesh : scene.meshes) trees.push_back(buildHierarchyTree(mesh));
  return trees;
}

} // namespace brickfield::test
