// See the shader; nothing is decided here.
#include "passes/post/tone_pass.h"

namespace brickfield {

TonePass::TonePass(ShaderLibrary& shaders)
    : program_(shaders.load({"tone", {{GL_COMPUTE_SHADER, "passes/tone.comp.glsl"}}, {}, {}})) {}

PassDeclaration TonePass::declare() {
  return {"tone",
          {{Resource::FrameParams, Access::Uniform}, {Resource::Color, Access::Sampled}},
          {{Resource::Picture, Access::ImageStore}}};
}

void TonePass::record(const FrameContext& context) {
  context.targets.color.bind(shared::kColorUnit);
  context.targets.picture.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.picture.width(), context.targets.picture.height(), 1});
}

} // namespace brickfield
