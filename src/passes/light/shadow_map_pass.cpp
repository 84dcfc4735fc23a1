// A layer at a time, with the light's view in place of the camera's and what that may see. Nothing is culled by its
// facing: light is stopped by back faces as well.
#include "passes/light/shadow_map_pass.h"

#include "passes/light/shadow_maps.h"
#include "shared/bindings.h"

namespace brickfield {

namespace {

ProgramSource meshSource(const char* label, std::map<std::string, std::string> defines) {
  return {label,
          {{GL_VERTEX_SHADER, "passes/shadow_map.vert.glsl"}, {GL_FRAGMENT_SHADER, "passes/shadow_map.frag.glsl"}},
          std::move(defines),
          {}};
}

ProgramSource boxSource(const char* label, std::map<std::string, std::string> defines) {
  return {label,
          {{GL_VERTEX_SHADER, "passes/sdf_box.vert.glsl"}, {GL_FRAGMENT_SHADER, "passes/sdf_box.frag.glsl"}},
          std::move(defines),
          {}};
}

} // namespace

ShadowMapPass::ShadowMapPass(ShaderLibrary& shaders)
    : opaque_(shaders.load(meshSource("shadow_map", {}))),
      masked_(shaders.load(meshSource("shadow_map_masked", {{"ALPHA_MASK", "1"}}))),
      cull_(shaders.load({"sdf_cull", {{GL_COMPUTE_SHADER, "passes/sdf_cull.comp.glsl"}}, {}, {}})),
      boxes_(shaders.load(boxSource("shadow_map_box", {{"DEPTH_ONLY", "1"}}))),
      countingBoxes_(shaders.load(boxSource("shadow_map_box_counting", {{"COUNTERS_ON", "1"}, {"DEPTH_ONLY", "1"}}))) {}

PassDeclaration ShadowMapPass::declare() {
  return {"shadow_map",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::MeshVertices, Access::VertexFetch},
           {Resource::MeshDraws, Access::StorageRead},
           {Resource::SdfScene, Access::StorageRead}},
          {{Resource::ShadowMap, Access::Attachment}, {Resource::Counters, Access::StorageWrite}}};
}

void ShadowMapPass::drawMeshes(const FrameContext& context, int layer) {
  const ResidentScene& scene = context.scene;
  scene.meshes().vertexArray().bind();
  scene.bindMeshDraws();
  scene.materials().bindRows();
  int boundMaterial = -2;
  const Program* used = nullptr;
  for (const DrawRun& run : context.shadowMaps->casters(layer)) {
    const MeshBatch& batch = scene.batches()[run.batch];
    const int material = batch.primitive.material;
    const bool isMasked = scene.materials().isMasked(material);
    const Program* program = isMasked ? masked_.get() : opaque_.get();
    if (program != used) program->use(), used = program;
    if (isMasked && material != boundMaterial) scene.materials().bindTextures(boundMaterial = material);
    glDrawElementsInstancedBaseVertexBaseInstance(
        GL_TRIANGLES, static_cast<GLsizei>(batch.primitive.indexCount), GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(std::size_t{batch.primitive.firstIndex} * sizeof(std::uint32_t)),
        static_cast<GLsizei>(run.drawCount), static_cast<GLint>(batch.baseVertex), run.firstDraw);
  }
  for (GLuint unit = 0; unit < shared::MATERIAL_TEXTURES; ++unit) Sampler::unbind(shared::kMaterialTextureUnit + unit);
}

void ShadowMapPass::drawBoxes(const FrameContext& context, int layer) {
  const VisibleBoxes& visible = context.shadowMaps->visible();
  context.scene.bindSdfInstances();
  visible.commands().bindStorage(shared::kPassBufferABinding);
  visible.list().bindStorage(shared::kPassBufferBBinding);
  cull_->set("reverseOrder", false);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); // the list of the layer before is used up
  cull_->dispatchOver({1, 1, 1});
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
  if (context.countersOn) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    context.shadowMaps->keepCommands(layer);
  }
  context.scene.atlas().bind();
  if (context.countersOn) context.counters.bindStorage(shared::kPassBufferABinding);
  (context.countersOn ? countingBoxes_ : boxes_)->use();
  context.scene.bindSdfInstances();
  visible.draw();
}

void ShadowMapPass::record(const FrameContext& context) {
  const ShadowMaps& maps = *context.shadowMaps;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  constexpr float kFarthest = 0;
  for (int layer = 0; layer < maps.layerCount(); ++layer) {
    const Framebuffer& target = maps.framebuffer(layer);
    glClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, &kFarthest);
    maps.bindView(layer);
    if (context.scene.sdfInstanceCount() > 0) {
      target.bind();
      drawBoxes(context, layer);
    }
    target.bind();
    drawMeshes(context, layer);
  }
  context.frameParams->bindUniform(shared::kFrameUniformBinding);
}

} // namespace brickfield
