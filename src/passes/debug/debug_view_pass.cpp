// The view is a number in the frame's parameters, so that one program serves all.
#include "passes/debug/debug_view_pass.h"

namespace brickfield {

DebugViewPass::DebugViewPass(ShaderLibrary& shaders)
    : program_(shaders.load({"debug_view", {{GL_COMPUTE_SHADER, "debug/debug_view.comp.glsl"}}, {}, {}})) {}

PassDeclaration DebugViewPass::declare() {
  return {"debug_view",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::BoxOverdraw, Access::Sampled},
           {Resource::Shadow, Access::Sampled},
           {Resource::ShadowReads, Access::Sampled}},
          {{Resource::Picture, Access::ImageStore}},
          {{Resource::Occlusion, Access::Sampled},
           {Resource::Translucency, Access::Sampled},
           {Resource::Reflection, Access::Sampled}}};
}

void DebugViewPass::record(const FrameContext& context) {
  context.targets.bindGBuffer();
  context.targets.boxOverdraw.bind(shared::kOverdrawUnit);
  context.targets.shadow.bind(shared::kShadowUnit);
  context.targets.shadowReads.bind(shared::kShadowReadsUnit);
  if (context.targets.occlusion) context.targets.occlusion.bind(shared::kOcclusionUnit);
  if (context.targets.thickness) context.targets.thickness.bind(shared::kThicknessUnit);
  if (context.targets.reflection) context.targets.reflection.bind(shared::kReflectionUnit);
  context.scene.bindSdfInstances();
  context.targets.picture.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({context.targets.picture.width(), context.targets.picture.height(), 1});
}

BoxOverdrawPass::BoxOverdrawPass(ShaderLibrary& shaders)
    : program_(shaders.load(
          {"box_overdraw",
           {{GL_VERTEX_SHADER, "passes/sdf_box.vert.glsl"}, {GL_FRAGMENT_SHADER, "debug/box_overdraw.frag.glsl"}},
           {},
           {}})) {}

PassDeclaration BoxOverdrawPass::declare() {
  return {"box_overdraw",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::VisibleBoxes, Access::VertexFetch},
           {Resource::VisibleBoxes, Access::Indirect}},
          {{Resource::BoxOverdraw, Access::Attachment}}};
}

void BoxOverdrawPass::record(const FrameContext& context) {
  context.targets.overdraw.clearColor(0, glm::vec4(0));
  if (context.scene.sdfInstanceCount() == 0) return;
  context.targets.overdraw.bind();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  program_->use();
  context.scene.bindSdfInstances();
  context.visible.draw();
  glDisable(GL_BLEND);
}

} // namespace brickfield
