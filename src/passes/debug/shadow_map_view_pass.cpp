// Both views in one program: the number in the frame's parameters tells which.
#include "passes/debug/shadow_map_view_pass.h"

#include "passes/light/shadow_maps.h"
#include "shared/bindings.h"

namespace brickfield {

ShadowMapViewPass::ShadowMapViewPass(ShaderLibrary& shaders)
    : program_(shaders.load({"shadow_map_view", {{GL_COMPUTE_SHADER, "debug/shadow_map_view.comp.glsl"}}, {}, {}})) {}

PassDeclaration ShadowMapViewPass::declare() {
  return {"shadow_map_view",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::ShadowMap, Access::Sampled}},
          {{Resource::Picture, Access::ImageStore}}};
}

void ShadowMapViewPass::record(const FrameContext& context) {
  context.shadowMaps->bind();
  context.targets.bindGBuffer();
  context.targets.picture.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.picture.width(), context.targets.picture.height(), 1});
}

} // namespace brickfield
