// A scene on the GPU: what is uploaded once (triangles, materials, fields) and what every pose renews (draws,
// instances, joints, lights).
#pragma once

#include <vector>

#include "resident/brick_atlas.h"
#include "resident/material_table.h"
#include "resident/mesh_pool.h"
#include "scene/lighting.h"
#include "shared/bindings.h"
#include "shared/frame_params.h"

namespace brickfield {

/// Which nodes are SDF objects: fieldOfNode[node] is an index into fields, or -1 for a mesh.
struct SceneFields {
  std::vector<BrickField> fields;
  std::vector<int> fieldOfNode;
  std::vector<int> lightFieldOfNode{}; ///< of meshes: bricks that shadows alone read; empty: none has any
  /// Of nodes whose fields have no attributes: metres of object space that the textures of their mesh's first material
  /// span, projected along the three axes; 0, or nothing at all: white and rough.
  std::vector<float> triplanarOfNode{};
};

/// Consecutive draws of one primitive with one state.
struct MeshBatch {
  PooledPrimitive primitive;
  std::uint32_t baseVertex = 0;
  std::uint32_t firstDraw = 0;
  std::uint32_t drawCount = 0;
  bool mirrored = false;
};

/// One run of the deform pass.
struct DeformJob {
  std::uint32_t instance = 0;  ///< number in Pose::instances; jobs are in its order, then in that of the primitives
  std::uint32_t primitive = 0; ///< of its mesh
  shared::DeformParams params;
};

/// Where a draw stands, in the order of the draws' rows.
struct MeshPlace {
  std::uint32_t instance = 0; ///< number in Pose::instances
  std::uint32_t node = 0;
  std::uint32_t primitive = 0;
  std::uint32_t baseVertex = 0;  ///< of what is drawn: deformed or not
  std::uint32_t firstVertex = 0; ///< undeformed
  std::uint32_t vertexCount = 0;
  glm::mat4 worldFromObject{1};
};

class ResidentScene {
public:
  ResidentScene(const Scene& scene, const SceneFields& fields);

  /// Fills draws, deform jobs and SDF instances for a moment. Instances of SDF nodes whose transform flattens space
  /// (determinant 0) are left out: they have no inside.
  void setPose(const Scene& scene, const Pose& pose);
  void setLighting(const Lighting& lighting);

  const MeshPool& meshes() const { return meshes_; }
  const MaterialTable& materials() const { return materials_; }
  const BrickAtlas& atlas() const { return atlas_; }
  const std::vector<MeshBatch>& batches() const { return batches_; }
  const std::vector<DeformJob>& deformJobs() const { return deformJobs_; }
  std::uint32_t sdfInstanceCount() const { return sdfInstanceCount_; }
  bool hasBricks() const { return sdfInstanceCount_ > 0 || !lightRows_.empty(); } ///< any instance, for light too
  const std::vector<shared::SdfInstance>& sdfInstances() const { return sdfRows_; }
  std::uint32_t meshDrawCount() const { return meshDrawCount_; }
  std::uint32_t lightCount() const { return lightCount_; }
  const std::vector<MeshPlace>& meshPlaces() const { return meshPlaces_; }
  /// Numbers in Pose::instances, in the order of sdfInstances().
  const std::vector<std::uint32_t>& sdfPlaces() const { return sdfPlaces_; }
  /// Materials that SDF objects take their textures from, each once.
  const std::vector<int>& triplanarMaterials() const { return triplanarMaterials_; }
  const Buffer& drawIndices() const { return drawIndices_; }

  void bindMeshDraws() const { meshDraws_.bindStorage(shared::kMeshDrawBinding); }
  void bindSdfInstances() const { sdfInstances_.bindStorage(shared::kSdfInstanceBinding); }
  /// shared::NodeLook of each node; made when it is first asked for.
  void bindNodeLooks() const;
  void bindSdfLooks() const { sdfLooks_.bindStorage(shared::kSdfLookBinding); }
  /// Of each node, which rows of the instances are its own; behind the SDF objects' follow those of bricks for light.
  void bindNodeRows() const { nodeRows_.bindStorage(shared::kNodeRowBinding); }
  void bindLights() const { lights_.bindStorage(shared::kLightBinding); }
  void bindDeform() const;
  /// Of what a pose renews: draws, instances, joints, weights, lights.
  std::size_t tableBytes() const;

private:
  struct PendingDraw;
  void addMeshDraws(const Pose& pose, std::uint32_t number, std::vector<PendingDraw>& pending);
  std::uint32_t addDeformJob(const PosedInstance& instance, const PooledPrimitive& primitive, DeformJob job);
  shared::SdfLook lookOf(const Scene& scene, const PosedInstance& instance, const ResidentField& field);
  void uploadInstances(std::size_t nodes);
  void finishDraws(std::vector<PendingDraw>& pending);

  MeshPool meshes_;
  MaterialTable materials_;
  BrickAtlas atlas_;
  std::vector<BrickAtlas::FieldId> fieldIds_;
  std::vector<int> fieldOfNode_, lightFieldOfNode_;
  std::vector<float> triplanarOfNode_;

  std::vector<MeshBatch> batches_;
  std::vector<DeformJob> deformJobs_;
  std::vector<shared::SdfInstance> sdfRows_, lightRows_;
  std::vector<shared::SdfLook> lookRows_;
  std::vector<int> triplanarMaterials_;
  std::vector<MeshPlace> meshPlaces_;
  std::vector<std::uint32_t> sdfPlaces_;
  std::vector<glm::mat4> joints_;
  std::vector<float> weights_;
  std::uint32_t deformedVertices_ = 0;
  Buffer meshDraws_, drawIndices_, sdfInstances_, sdfLooks_, nodeRows_, lights_, jointMatrices_, morphWeights_;
  const Scene* scene_;
  mutable Buffer nodeLooks_;
  std::uint32_t sdfInstanceCount_ = 0, meshDrawCount_ = 0, lightCount_ = 0;
};

} // namespace brickfield
