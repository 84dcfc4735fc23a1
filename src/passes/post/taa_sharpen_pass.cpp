// A copy where nothing is to be sharpened.
#include "passes/post/taa_sharpen_pass.h"

#include "passes/post/temporal.h"
#include "shared/bindings.h"

namespace brickfield {

TaaSharpenPass::TaaSharpenPass(ShaderLibrary& shaders)
    : program_(shaders.load({"taa_sharpen", {{GL_COMPUTE_SHADER, "passes/taa_sharpen.comp.glsl"}}, {}, {}})) {}

PassDeclaration TaaSharpenPass::declare() {
  return {"taa_sharpen",
          {{Resource::FrameParams, Access::Uniform}, {Resource::History, Access::Sampled}},
          {{Resource::Color, Access::ImageStore}}};
}

void TaaSharpenPass::record(const FrameContext& context) {
  context.temporal->now().bind(shared::kHistoryUnit);
  context.targets.color.bindImage(0, 0, GL_WRITE_ONLY);
  program_->set("sharpness", context.temporal->sharpness);
  program_->dispatchOver({context.targets.color.width(), context.targets.color.height(), 1});
}

} // namespace brickfield
