// Images of eight layers are what OpenGL 4.5 promises to a compute shader; the G-buffer and its depth take seven.
#include "passes/geometry/sdf_tile_pass.h"

namespace brickfield {

namespace {
ProgramSource tileSource(const char* label, std::map<std::string, std::string> defines) {
  return {label, {{GL_COMPUTE_SHADER, "passes/sdf_tiles.comp.glsl"}}, std::move(defines), {}};
}
} // namespace

ScreenBoxPass::ScreenBoxPass(ShaderLibrary& shaders)
    : program_(shaders.load({"sdf_screen_boxes", {{GL_COMPUTE_SHADER, "passes/sdf_screen_boxes.comp.glsl"}}, {}, {}})) {
}

PassDeclaration ScreenBoxPass::declare() {
  return {"sdf_screen_boxes",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::VisibleBoxes, Access::StorageRead}},
          {{Resource::ScreenBoxes, Access::StorageWrite}}};
}

void ScreenBoxPass::record(const FrameContext& context) {
  const std::uint32_t instances = context.scene.sdfInstanceCount();
  if (instances == 0) return;
  context.scene.bindSdfInstances();
  context.visible.commands().bindStorage(shared::kPassBufferABinding);
  context.visible.list().bindStorage(shared::kPassBufferBBinding);
  context.visible.screenBoxes().bindStorage(shared::kScreenBoxBinding);
  program_->dispatchOver({instances, 1, 1});
}

SdfTilePass::SdfTilePass(ShaderLibrary& shaders)
    : program_(shaders.load(tileSource("sdf_tiles", {}))),
      countingProgram_(shaders.load(tileSource("sdf_tiles_counting", {{"COUNTERS_ON", "1"}}))) {}

PassDeclaration SdfTilePass::declare() {
  return {"sdf_tiles",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::ScreenBoxes, Access::StorageRead},
           {Resource::Depth, Access::Sampled}},
          {{Resource::GBuffer, Access::ImageStore},
           {Resource::Depth, Access::ImageStore},
           {Resource::Counters, Access::StorageWrite}}};
}

void SdfTilePass::record(const FrameContext& context) {
  if (context.scene.sdfInstanceCount() == 0) return;
  const FrameTargets& targets = context.targets;
  GLuint unit = 0;
  for (const Texture* layer : {&targets.normalWorldOct, &targets.albedoEncoded, &targets.material, &targets.emission,
                               &targets.id, &targets.trace, &targets.depthTraced})
    layer->bindImage(unit++, 0, GL_WRITE_ONLY);
  context.scene.atlas().bind();
  targets.depth.bind(shared::kDepthMeshUnit);
  context.visible.screenBoxes().bindStorage(shared::kScreenBoxBinding);
  if (context.countersOn) context.counters.bindStorage(shared::kPassBufferABinding);
  context.scene.bindSdfInstances();
  const auto& program = context.countersOn ? countingProgram_ : program_;
  program->set("isAlone", context.meshRuns.empty());
  program->dispatchOver({targets.size.x, targets.size.y, 1});
}

} // namespace brickfield
