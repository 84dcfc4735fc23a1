// Two histories take turns.
#include "passes/post/taa_pass.h"

#include "passes/post/temporal.h"
#include "shared/bindings.h"

namespace brickfield {

TaaPass::TaaPass(ShaderLibrary& shaders)
    : program_(shaders.load({"taa", {{GL_COMPUTE_SHADER, "passes/taa.comp.glsl"}}, {}, {}})) {}

PassDeclaration TaaPass::declare() {
  return {"taa",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::Motion, Access::Sampled},
           {Resource::Color, Access::Sampled}},
          {{Resource::History, Access::ImageStore}}};
}

void TaaPass::record(const FrameContext& context) {
  const Temporal& temporal = *context.temporal;
  context.targets.bindGBuffer();
  context.targets.color.bind(shared::kColorUnit);
  temporal.motion.bind(shared::kMotionUnit);
  temporal.before().bind(shared::kHistoryUnit);
  temporal.depthBefore().bind(shared::kHistoryDepthUnit);
  temporal.now().bindImage(0, 0, GL_WRITE_ONLY);
  temporal.depthNow().bindImage(1, 0, GL_WRITE_ONLY);
  program_->set("hasHistory", temporal.hasHistory);
  program_->dispatchOver({context.targets.color.width(), context.targets.color.height(), 1});
}

} // namespace brickfield
