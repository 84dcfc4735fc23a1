// One thread a pixel; see the shader.
#include "passes/post/motion_pass.h"

#include "passes/post/temporal.h"

namespace brickfield {

MotionPass::MotionPass(ShaderLibrary& shaders)
    : program_(shaders.load({"motion", {{GL_COMPUTE_SHADER, "passes/motion.comp.glsl"}}, {}, {}})) {}

PassDeclaration MotionPass::declare() {
  return {"motion",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled}},
          {{Resource::Motion, Access::ImageStore}}};
}

void MotionPass::record(const FrameContext& context) {
  context.targets.bindGBuffer();
  context.scene.bindSdfInstances();
  context.temporal->table.bindRows();
  context.temporal->motion.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.size.x, context.targets.size.y, 1});
}

} // namespace brickfield
