// One dispatch over the picture for all lights: they share the reads of the G-buffer.
#include "passes/light/map_shadow_pass.h"

#include "passes/light/shadow_maps.h"
#include "shared/bindings.h"

namespace brickfield {

MapShadowPass::MapShadowPass(ShaderLibrary& shaders)
    : program_(shaders.load({"map_shadow", {{GL_COMPUTE_SHADER, "passes/map_shadow.comp.glsl"}}, {}, {}})) {}

PassDeclaration MapShadowPass::declare() {
  return {"map_shadow",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::ShadowMap, Access::Sampled},
           {Resource::ShadowMoments, Access::Sampled}},
          {{Resource::Shadow, Access::ImageStore}}};
}

void MapShadowPass::record(const FrameContext& context) {
  context.shadowMaps->bind();
  context.targets.bindGBuffer();
  context.scene.bindLights();
  context.targets.shadow.bindImage(0, 0, GL_WRITE_ONLY);
  const bool isEvsm = context.shadowMaps->settings().filter == ShadowFilter::Evsm;
  program_->set("shadowFilter", isEvsm ? shared::SHADOW_FILTER_EVSM : shared::SHADOW_FILTER_PCF);
  program_->dispatchOver({context.targets.shadow.width(), context.targets.shadow.height(), 1});
}

} // namespace brickfield
