// The two commands differ in vertex count and place in the list; the list's entry tells the vertex shader which faces.
#include "passes/geometry/sdf_box_pass.h"

namespace brickfield {

namespace {
ProgramSource boxSource(const char* label, std::map<std::string, std::string> defines) {
  return {label,
          {{GL_VERTEX_SHADER, "passes/sdf_box.vert.glsl"}, {GL_FRAGMENT_SHADER, "passes/sdf_box.frag.glsl"}},
          std::move(defines),
          {}};
}
} // namespace

SdfBoxPass::SdfBoxPass(ShaderLibrary& shaders)
    : program_(shaders.load(boxSource("sdf_box", {}))),
      countingProgram_(shaders.load(boxSource("sdf_box_counting", {{"COUNTERS_ON", "1"}}))) {}

PassDeclaration SdfBoxPass::declare() {
  return {"sdf_box",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::VisibleBoxes, Access::VertexFetch},
           {Resource::VisibleBoxes, Access::Indirect},
           {Resource::DepthMesh, Access::Sampled}},
          {{Resource::GBuffer, Access::Attachment},
           {Resource::Depth, Access::Attachment},
           {Resource::Counters, Access::StorageWrite}}};
}

void SdfBoxPass::record(const FrameContext& context) {
  if (context.scene.sdfInstanceCount() == 0) return;
  context.targets.gbuffer.bind();
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(context.drawOrder == DrawOrder::BoxesFirstAllReversed ? GL_GEQUAL : GL_GREATER);
  glDisable(GL_CULL_FACE);
  context.scene.atlas().bind();
  context.targets.depthMesh.bind(shared::kDepthMeshUnit);
  if (context.countersOn) context.counters.bindStorage(shared::kPassBufferABinding);
  (context.countersOn ? countingProgram_ : program_)->use();
  context.scene.bindSdfInstances();
  context.visible.draw();
}

} // namespace brickfield
