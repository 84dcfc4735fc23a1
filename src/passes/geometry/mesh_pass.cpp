// Batches are sorted by material, so that state changes are few; a batch is one instanced draw.
#include "passes/geometry/mesh_pass.h"

#include "passes/post/temporal.h"

namespace brickfield {

namespace {
ProgramSource meshSource(const char* label, std::map<std::string, std::string> defines) {
  return {label,
          {{GL_VERTEX_SHADER, "passes/mesh.vert.glsl"}, {GL_FRAGMENT_SHADER, "passes/mesh.frag.glsl"}},
          std::move(defines),
          {}};
}
} // namespace

MeshPass::MeshPass(ShaderLibrary& shaders)
    : program_(shaders.load(meshSource("mesh", {}))),
      motionProgram_(shaders.load(meshSource("mesh_motion", {{"MOTION_ON", "1"}}))) {}

PassDeclaration MeshPass::declare() {
  return {"mesh",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::MeshVertices, Access::VertexFetch},
           {Resource::MeshDraws, Access::StorageRead}},
          {{Resource::GBuffer, Access::Attachment}, {Resource::Depth, Access::Attachment}}};
}

void MeshPass::record(const FrameContext& context) {
  const std::vector<MeshBatch>& batches = context.scene.batches();
  if (batches.empty()) return;
  const bool reversed = context.drawOrder == DrawOrder::BoxesFirstAllReversed;
  (context.temporal ? context.temporal->gbuffer : context.targets.gbuffer).bind();
  if (context.temporal) context.temporal->table.bindMeshes(context.scene);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(reversed ? GL_GEQUAL : GL_GREATER);
  glCullFace(GL_BACK);
  (context.temporal ? motionProgram_ : program_)->use();
  context.scene.meshes().vertexArray().bind();
  context.scene.bindMeshDraws();
  context.scene.materials().bindRows();
  int boundMaterial = -2;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    const MeshBatch& batch = batches[reversed ? batches.size() - 1 - i : i];
    if (batch.primitive.material != boundMaterial) {
      boundMaterial = batch.primitive.material;
      context.scene.materials().bindTextures(boundMaterial);
      if (context.scene.materials().isDoubleSided(boundMaterial))
        glDisable(GL_CULL_FACE);
      else
        glEnable(GL_CULL_FACE);
    }
    // A mirror turns every triangle around.
    glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
    glDrawElementsInstancedBaseVertexBaseInstance(
        GL_TRIANGLES, static_cast<GLsizei>(batch.primitive.indexCount), GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(std::size_t{batch.primitive.firstIndex} * sizeof(std::uint32_t)),
        static_cast<GLsizei>(batch.drawCount), static_cast<GLint>(batch.baseVertex), batch.firstDraw);
  }
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
  for (GLuint unit = 0; unit < shared::MATERIAL_TEXTURES; ++unit) Sampler::unbind(shared::kMaterialTextureUnit + unit);
}

PassDeclaration ClearPass::declare() {
  return {"clear",
          {},
          {{Resource::GBuffer, Access::Attachment},
           {Resource::Depth, Access::Attachment},
           {Resource::DepthMesh, Access::Attachment}}};
}

// Layers hold whatever they did where the id says that nothing is there.
void ClearPass::record(const FrameContext& context) {
  constexpr int kId = 4;
  FrameTargets& targets = context.targets;
  targets.gbuffer.clearDepth(0.0f);
  targets.gbuffer.clearColor(kId, glm::uvec4(0));
  if (context.drawOrder == DrawOrder::BoxesFirstAllReversed) targets.depthMesh.clear(glm::vec4(0)); // else it is copied
}

PassDeclaration DepthCopyPass::declare() {
  return {"depth_copy", {{Resource::Depth, Access::Attachment}}, {{Resource::DepthMesh, Access::Attachment}}};
}

void DepthCopyPass::record(const FrameContext& context) {
  if (context.scene.sdfInstanceCount() == 0) return;
  const FrameTargets& targets = context.targets;
  glCopyImageSubData(targets.depth.id(), GL_TEXTURE_2D, 0, 0, 0, 0, targets.depthMesh.id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                     targets.depth.width(), targets.depth.height(), 1);
}

} // namespace brickfield
