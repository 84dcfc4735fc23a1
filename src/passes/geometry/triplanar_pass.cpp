// One draw over the picture for each material: boxes of all objects are one draw, which could not bind their textures.
#include "passes/geometry/triplanar_pass.h"

#include "shared/bindings.h"

namespace brickfield {

TriplanarPass::TriplanarPass(ShaderLibrary& shaders)
    : program_(shaders.load(
          {"triplanar",
           {{GL_VERTEX_SHADER, "passes/triplanar.vert.glsl"}, {GL_FRAGMENT_SHADER, "passes/triplanar.frag.glsl"}},
           {},
           {}})),
      vertexArray_("triplanar") {}

PassDeclaration TriplanarPass::declare() {
  return {"triplanar",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled}},
          {{Resource::GBuffer, Access::Attachment}}};
}

void TriplanarPass::record(const FrameContext& context) {
  const FrameTargets& targets = context.targets;
  targets.surface.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glColorMaski(0, GL_TRUE, GL_TRUE, GL_FALSE, GL_FALSE);
  targets.visibleDepth().bind(shared::kDepthUnit);
  targets.normalWorldOct.bind(shared::kNormalUnit);
  targets.id.bind(shared::kIdUnit);
  context.scene.bindSdfInstances();
  context.scene.bindSdfLooks();
  context.scene.materials().bindRows();
  vertexArray_.bind();
  for (const int material : context.scene.triplanarMaterials()) {
    glTextureBarrier();
    context.scene.materials().bindTextures(material);
    program_->use();
    program_->set("materialRow", MaterialTable::rowOf(material));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glColorMaski(0, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  for (GLuint unit = 0; unit < shared::MATERIAL_TEXTURES; ++unit) Sampler::unbind(shared::kMaterialTextureUnit + unit);
}

} // namespace brickfield
