// The RTSDF passes over triangles that a test hands them, frame by frame.
#pragma once

#include "passes/world_field/hierarchy_refit_pass.h"
#include "passes/world_field/rtsdf_jump_flood_pass.h"
#include "passes/world_field/rtsdf_rays_pass.h"
#include "passes/world_field/rtsdf_voxelize_pass.h"
#include "tests/support/posed_triangles.h"

namespace brickfield::test {

class RtsdfStage {
public:
  /// box  where the field is laid; empty: the triangles' own
  RtsdfStage(const RtsdfSettings& settings, const PosedTriangles& posed, std::span<const HierarchyTree> trees,
             const Box& box = {})
      : shaders_(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders"),
        refit_(shaders_),
        voxelize_(shaders_),
        flood_(shaders_),
        rays_(shaders_),
        field_(settings),
        hierarchy_(trees, posed.instances) {
    field_.place(box.isEmpty() ? posed.bounds : box);
    field_.reserveTriangles(static_cast<std::uint32_t>(posed.rows.size()));
    move(posed);
  }

  /// The same triangles elsewhere.
  void move(const PosedTriangles& posed) {
    triangles_ = Buffer("triangles", posed.rows);
    count_ = static_cast<std::uint32_t>(posed.rows.size());
    hierarchy_.update(posed.boxes, posed.allInstances());
    refit_.record(hierarchy_, triangles_);
  }

  void recordVoxels() {
    voxelize_.record(field_, triangles_, count_);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }

  void recordCoarse() {
    recordVoxels();
    flood_.record(field_);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }

  void recordFrame() {
    recordCoarse();
    rays_.record(field_, hierarchy_, triangles_);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }

  RtsdfCounts recordCounting() {
    recordCoarse();
    const RtsdfCounts counts = rays_.recordCounting(field_, hierarchy_, triangles_);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    return counts;
  }

  RtsdfField& field() { return field_; }
  const TriangleHierarchy& hierarchy() const { return hierarchy_; }

  /// Calls visit(index in the window's order, place) for every texel.
  template <typename Visit>
  void forEachTexel(const Visit& visit) const {
    const glm::ivec3 extent = field_.extent();
    std::size_t index = 0;
    for (int z = 0; z < extent.z; ++z)
      for (int y = 0; y < extent.y; ++y)
        for (int x = 0; x < extent.x; ++x) visit(index++, glm::ivec3(x, y, z));
  }
  glm::vec3 centerAnchored(glm::ivec3 place) const {
    return field_.originAnchored() + (glm::vec3(place) + 0.5f) * field_.cascade().texel.x;
  }

private:
  ShaderLibrary shaders_;
  HierarchyRefitPass refit_;
  RtsdfVoxelizePass voxelize_;
  RtsdfJumpFloodPass flood_;
  RtsdfRaysPass rays_;
  RtsdfField field_;
  TriangleHierarchy hierarchy_;
  Buffer triangles_;
  std::uint32_t count_ = 0;
};

/// A scene of one mesh, posed and with its tree.
struct MeshAlone {
  PosedTriangles posed;
  std::vector<HierarchyTree> trees;

  explicit MeshAlone(const Mesh& mesh) : trees{buildHierarchyTree(mesh)} {
    Scene scene;
    scene.meshes = {mesh};
    scene.nodes.resize(1);
    scene.nodes[0].mesh = 0;
    scene.scenes.push_back({"scene", {0}});
    posed = gatherTriangles(scene, poseScene(scene, {}));
  }
};

} // namespace brickfield::test
