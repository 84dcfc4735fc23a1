// One intermediate layer serves all: rows of a map, then its columns.
#include "passes/light/shadow_moments_pass.h"

#include "passes/light/shadow_maps.h"
#include "shared/bindings.h"

namespace brickfield {

ShadowMomentsPass::ShadowMomentsPass(ShaderLibrary& shaders)
    : program_(shaders.load({"shadow_moments", {{GL_COMPUTE_SHADER, "passes/shadow_moments.comp.glsl"}}, {}, {}})) {}

PassDeclaration ShadowMomentsPass::declare() {
  return {"shadow_moments", {{Resource::ShadowMap, Access::Sampled}}, {{Resource::ShadowMoments, Access::ImageStore}}};
}

void ShadowMomentsPass::record(const FrameContext& context) {
  const ShadowMaps& maps = *context.shadowMaps;
  maps.bind();
  maps.blurredAlongX().bind(shared::kShadowMomentsUnit);
  for (int layer = 0; layer < maps.layerCount(); ++layer)
    for (const bool alongY : {false, true}) {
      program_->set("layerIndex", layer);
      program_->set("alongY", alongY);
      (alongY ? maps.moments() : maps.blurredAlongX()).bindImage(0, 0, GL_WRITE_ONLY);
      program_->dispatchOver({maps.settings().size, maps.settings().size, 1});
      // The rows are read by the columns, and then written by the next layer.
      glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    }
}

} // namespace brickfield
