// Three dispatches: clear, triangles by threads, large ones by work groups.
#include "passes/world_field/rtsdf_voxelize_pass.h"

#include "shared/rtsdf_params.h"

namespace brickfield {

namespace {

void dispatchRows(const Program& program, std::uint32_t threads) {
  const std::uint32_t rows = ceilDivide(threads, shared::RTSDF_ROW_THREADS);
  program.dispatchOver({static_cast<int>(std::min(threads, shared::RTSDF_ROW_THREADS)), static_cast<int>(rows), 1});
}

} // namespace

RtsdfVoxelizePass::RtsdfVoxelizePass(ShaderLibrary& shaders)
    : program_(shaders.load({"rtsdf_voxelize", {{GL_COMPUTE_SHADER, "passes/rtsdf_voxelize.comp.glsl"}}, {}, {}})) {}

PassDeclaration RtsdfVoxelizePass::declare() {
  return {"rtsdf_voxelize",
          {{Resource::WorldTriangles, Access::StorageRead}},
          {{Resource::WorldFieldSeeds, Access::StorageWrite}}};
}

void RtsdfVoxelizePass::record(RtsdfField& field, const Buffer& triangles, std::uint32_t triangleCount) {
  if (field.settings().bruteForce) return;
  const int size = field.settings().coarseSize;
  triangles.bindStorage(shared::kRtsdfTriangleBinding);
  field.seeds(0).bindStorage(shared::kRtsdfSeedBinding);
  field.largeTriangles().bindStorage(shared::kRtsdfLargeBinding);
  program_->set("triangleCount", triangleCount);
  program_->set("coarseSize", size);
  program_->set("originAnchored", field.originAnchored());
  program_->set("voxelsPerMetre",
                static_cast<float>(size) / static_cast<float>(field.cascade().window.w) * field.cascade().texel.y);
  program_->set("stage", shared::RTSDF_CLEAR);
  dispatchRows(*program_, static_cast<std::uint32_t>(size * size * size));
  if (triangleCount == 0) return;
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  program_->set("stage", shared::RTSDF_VOXELIZE_SMALL);
  dispatchRows(*program_, triangleCount);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  program_->set("stage", shared::RTSDF_VOXELIZE_LARGE);
  glDispatchCompute(std::min(triangleCount, shared::RTSDF_LARGE_GROUPS), 1, 1);
}

} // namespace brickfield
