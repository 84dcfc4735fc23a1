// One work group: the list keeps the scene's order (see the shader).
#include "passes/geometry/sdf_cull_pass.h"

namespace brickfield {

SdfCullPass::SdfCullPass(ShaderLibrary& shaders)
    : program_(shaders.load({"sdf_cull", {{GL_COMPUTE_SHADER, "passes/sdf_cull.comp.glsl"}}, {}, {}})) {}

PassDeclaration SdfCullPass::declare() {
  return {"sdf_cull",
          {{Resource::FrameParams, Access::Uniform}, {Resource::SdfScene, Access::StorageRead}},
          {{Resource::VisibleBoxes, Access::StorageWrite}}};
}

void SdfCullPass::record(const FrameContext& context) {
  if (context.scene.sdfInstanceCount() == 0) return;
  context.scene.bindSdfInstances();
  context.visible.commands().bindStorage(shared::kPassBufferABinding);
  context.visible.list().bindStorage(shared::kPassBufferBBinding);
  program_->set("reverseOrder", context.drawOrder == DrawOrder::BoxesFirstAllReversed);
  program_->dispatchOver({1, 1, 1});
}

} // namespace brickfield
