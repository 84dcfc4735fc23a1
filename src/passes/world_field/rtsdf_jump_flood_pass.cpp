// A dispatch each round.
#include "passes/world_field/rtsdf_jump_flood_pass.h"

#include "shared/rtsdf_params.h"

namespace brickfield {

RtsdfJumpFloodPass::RtsdfJumpFloodPass(ShaderLibrary& shaders)
    : program_(shaders.load({"rtsdf_jump_flood", {{GL_COMPUTE_SHADER, "passes/rtsdf_jump_flood.comp.glsl"}}, {}, {}})) {
}

PassDeclaration RtsdfJumpFloodPass::declare() {
  return {"rtsdf_jump_flood",
          {{Resource::WorldFieldSeeds, Access::StorageRead}},
          {{Resource::WorldFieldSeeds, Access::StorageWrite}, {Resource::WorldFieldCoarse, Access::ImageStore}}};
}

void RtsdfJumpFloodPass::record(RtsdfField& field) {
  if (field.settings().bruteForce) return;
  const int size = field.settings().coarseSize;
  field.coarse().bindImage(shared::kRtsdfCoarseUnit, 0, GL_WRITE_ONLY);
  program_->set("coarseSize", size);
  program_->set("texelsPerCoarse", static_cast<float>(field.cascade().window.w) / static_cast<float>(size));
  program_->set("betaTexels", field.texelsOf(rtsdfBeta(field.settings())));
  program_->set("farthestTexels", field.cascade().texel.z);
  int half = 0;
  for (int offset = size / 2; offset > 0; offset /= 2) {
    field.seeds(half).bindStorage(shared::kRtsdfSeedBinding);
    field.seeds(1 - half).bindStorage(shared::kRtsdfSeedResultBinding);
    program_->set("offset", offset);
    program_->dispatchOver(glm::ivec3(size));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    half = 1 - half;
  }
}

} // namespace brickfield
