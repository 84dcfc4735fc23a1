// Positions first; then, in a pass of its own, everything that needs more than one triangle.
#include "passes/world_field/world_triangles_pass.h"

#include <algorithm>

#include "shared/world_triangles_params.h"

namespace brickfield {

namespace {

// OpenGL promises 65535 groups along an axis.
constexpr std::uint32_t kGroupsAlongX = 32768;

void dispatchChunks(Program& program, std::uint32_t triangleChunks, std::uint32_t chunks) {
  program.set("triangleChunks", triangleChunks);
  program.set("chunkCount", chunks);
  const std::uint32_t groups = std::min(chunks, kGroupsAlongX);
  program.dispatchOver(
      {static_cast<int>(groups * shared::GATHER_TRIANGLES), static_cast<int>(ceilDivide(chunks, kGroupsAlongX)), 1});
}

} // namespace

WorldTrianglesPass::WorldTrianglesPass(ShaderLibrary& shaders)
    : positions_(shaders.load({"world_triangles", {{GL_COMPUTE_SHADER, "passes/world_triangles.comp.glsl"}}, {}, {}})) {
}

PassDeclaration WorldTrianglesPass::declare() {
  return {"world_triangles",
          {{Resource::MeshVertices, Access::StorageRead}},
          {{Resource::WorldTriangles, Access::StorageWrite}}};
}

void WorldTrianglesPass::record(const FrameContext& context) {
  if (!context.worldTriangles || context.worldTriangles->triangleChunks() == 0) return;
  const WorldTriangles& world = *context.worldTriangles;
  world.bindTables();
  context.scene.meshes().vertices().bindStorage(shared::kGatherVertexBinding);
  dispatchChunks(*positions_, world.triangleChunks(), world.triangleChunks());
}

PseudonormalsPass::PseudonormalsPass(ShaderLibrary& shaders)
    : pseudonormals_(shaders.load(
          {"world_pseudonormals", {{GL_COMPUTE_SHADER, "passes/world_pseudonormals.comp.glsl"}}, {}, {}})) {}

PassDeclaration PseudonormalsPass::declare() {
  return {"world_pseudonormals",
          {{Resource::WorldTriangles, Access::StorageRead}},
          {{Resource::Pseudonormals, Access::StorageWrite}}};
}

void PseudonormalsPass::record(const FrameContext& context) {
  if (!context.worldTriangles || context.worldTriangles->triangleChunks() == 0) return;
  const WorldTriangles& world = *context.worldTriangles;
  world.bindTables();
  world.bindFans();
  dispatchChunks(*pseudonormals_, world.triangleChunks(), world.triangleChunks() + world.vertexChunks());
}

} // namespace brickfield
