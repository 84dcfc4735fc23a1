// Both views in one program: the number in the frame's parameters tells which.
#include "passes/debug/taa_view_pass.h"

#include "passes/post/temporal.h"
#include "shared/bindings.h"

namespace brickfield {

TaaViewPass::TaaViewPass(ShaderLibrary& shaders)
    : program_(shaders.load({"taa_view", {{GL_COMPUTE_SHADER, "debug/taa_view.comp.glsl"}}, {}, {}})) {}

PassDeclaration TaaViewPass::declare() {
  return {"taa_view",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::GBuffer, Access::Sampled},
           {Resource::Motion, Access::Sampled},
           {Resource::History, Access::Sampled}},
          {{Resource::Picture, Access::ImageStore}}};
}

void TaaViewPass::record(const FrameContext& context) {
  context.targets.bindGBuffer();
  context.temporal->motion.bind(shared::kMotionUnit);
  context.temporal->now().bind(shared::kHistoryUnit);
  context.targets.picture.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.picture.width(), context.targets.picture.height(), 1});
}

} // namespace brickfield
