// What the camera sees, nearest first; a run of a batch is one instanced draw. Materials that cut no holes have a
// program of their own, so that depth is tested before shading.
#include "passes/geometry/mesh_pass.h"

#include "passes/post/temporal.h"

namespace brickfield {

namespace {

constexpr GLuint kTrace = 5, kMotion = 6; // layers of the G-buffer

ProgramSource meshSource(const char* label, std::map<std::string, std::string> defines) {
  return {label,
          {{GL_VERTEX_SHADER, "passes/mesh.vert.glsl"}, {GL_FRAGMENT_SHADER, "passes/mesh.frag.glsl"}},
          std::move(defines),
          {}};
}

} // namespace

MeshPass::Programs::Programs(ShaderLibrary& shaders, const char* label, const char* maskedLabel,
                             std::map<std::string, std::string> defines)
    : opaque(shaders.load(meshSource(label, defines))) {
  defines.emplace("ALPHA_MASK", "1");
  masked = shaders.load(meshSource(maskedLabel, std::move(defines)));
}

MeshPass::MeshPass(ShaderLibrary& shaders)
    : still_(shaders, "mesh", "mesh_masked", {}),
      moving_(shaders, "mesh_motion", "mesh_motion_masked", {{"MOTION_ON", "1"}}) {}

PassDeclaration MeshPass::declare() {
  return {"mesh",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::MeshVertices, Access::VertexFetch},
           {Resource::MeshDraws, Access::StorageRead}},
          {{Resource::GBuffer, Access::Attachment},
           {Resource::Depth, Access::Attachment},
           {Resource::Motion, Access::Attachment}}};
}

void MeshPass::draw(const FrameContext& context, const DrawRun& run) {
  const MeshBatch& batch = context.scene.batches()[run.batch];
  const MaterialTable& materials = context.scene.materials();
  const int material = batch.primitive.material;
  const bool drawsMotion = context.temporal && context.temporal->table.isDrawn(run.firstDraw, run.drawCount);
  const Programs& programs = drawsMotion ? moving_ : still_;
  const Program* program = (materials.isMasked(material) ? programs.masked : programs.opaque).get();
  if (program != used_) {
    program->use(), used_ = program;
    const GLboolean isWritten = drawsMotion ? GL_TRUE : GL_FALSE;
    if (hasMotion_) glColorMaski(kMotion, isWritten, isWritten, isWritten, isWritten);
  }
  if (material != boundMaterial_) {
    materials.bindTextures(boundMaterial_ = material);
    if (materials.isDoubleSided(material))
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
  }
  // A mirror turns every triangle around.
  glFrontFace(batch.mirrored ? GL_CW : GL_CCW);
  glDrawElementsInstancedBaseVertexBaseInstance(
      GL_TRIANGLES, static_cast<GLsizei>(batch.primitive.indexCount), GL_UNSIGNED_INT,
      reinterpret_cast<const void*>(std::size_t{batch.primitive.firstIndex} * sizeof(std::uint32_t)),
      static_cast<GLsizei>(run.drawCount), static_cast<GLint>(batch.baseVertex), run.firstDraw);
}

void MeshPass::record(const FrameContext& context) {
  const std::span<const DrawRun> runs = context.meshRuns;
  if (runs.empty()) return;
  const bool reversed = context.drawOrder == DrawOrder::BoxesFirstAllReversed;
  hasMotion_ = context.temporal && context.temporal->table.isAnyDrawn();
  (hasMotion_ ? context.temporal->gbuffer : context.targets.gbuffer).bind();
  if (hasMotion_) context.temporal->table.bindMeshes(context.scene);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(reversed ? GL_GEQUAL : GL_GREATER);
  glCullFace(GL_BACK);
  context.scene.meshes().vertexArray().bind();
  context.scene.bindMeshDraws();
  context.scene.materials().bindRows();
  // Steps of rays are SDF objects' alone: what is not written costs no bandwidth.
  glColorMaski(kTrace, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  boundMaterial_ = kNoMaterial;
  used_ = nullptr;
  for (std::size_t i = 0; i < runs.size(); ++i) draw(context, runs[reversed ? runs.size() - 1 - i : i]);
  for (const GLuint layer : {kTrace, kMotion}) glColorMaski(layer, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
  for (GLuint unit = 0; unit < shared::MATERIAL_TEXTURES; ++unit) Sampler::unbind(shared::kMaterialTextureUnit + unit);
}

ClearPass::ClearPass(ShaderLibrary& shaders)
    : program_(shaders.load({"clear", {{GL_COMPUTE_SHADER, "passes/clear.comp.glsl"}}, {}, {}})) {}

PassDeclaration ClearPass::declare() {
  return {"clear",
          {},
          {{Resource::GBuffer, Access::ImageStore},
           {Resource::Depth, Access::Attachment},
           {Resource::DepthMesh, Access::Attachment}}};
}

// Layers hold whatever they did where the id says that nothing is there. Ids are cleared in compute: where few units
// rasterize, as on an H200, clearing a target takes as long as filling it (0.15 ms of a picture of 1920x1080).
void ClearPass::record(const FrameContext& context) {
  FrameTargets& targets = context.targets;
  targets.gbuffer.clearDepth(0.0f);
  targets.id.bindImage(0, 0, GL_WRITE_ONLY);
  program_->dispatchOver({targets.size.x, targets.size.y, 1});
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
