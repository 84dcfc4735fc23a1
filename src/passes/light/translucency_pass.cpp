// Over the picture: each pixel marches its own object alone.
#include "passes/light/translucency_pass.h"

#include "shared/bindings.h"

namespace brickfield {

namespace {
ProgramSource sourceOf(bool counts) {
  std::map<std::string, std::string> defines;
  if (counts) defines = {{"COUNTERS_ON", "1"}};
  return {counts ? "translucency_counting" : "translucency",
          {{GL_COMPUTE_SHADER, "passes/translucency.comp.glsl"}},
          std::move(defines),
          {}};
}
} // namespace

TranslucencyPass::TranslucencyPass(ShaderLibrary& shaders)
    : program_(shaders.load(sourceOf(false))), countingProgram_(shaders.load(sourceOf(true))) {}

PassDeclaration TranslucencyPass::declare() {
  return {"translucency",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled}},
          {{Resource::Translucency, Access::ImageStore}, {Resource::Counters, Access::StorageWrite}}};
}

void TranslucencyPass::record(const FrameContext& context) {
  const TranslucencySettings& settings = context.translucency;
  context.targets.bindGBuffer();
  context.scene.atlas().bind();
  context.scene.bindSdfInstances();
  context.scene.bindSdfLooks();
  context.scene.bindLights();
  context.counters.bindStorage(shared::kPassBufferABinding);
  context.targets.translucent.bindImage(0, 0, GL_WRITE_ONLY);
  context.targets.thickness.bindImage(1, 0, GL_WRITE_ONLY);
  Program& program = context.countersOn ? *countingProgram_ : *program_;
  program.set("wrap", settings.wrap);
  program.set("isGiven", settings.source == TranslucencySource::Given);
  program.set("givenTransmission", glm::vec4(settings.absorption, settings.share));
  program.dispatchOver({context.targets.thickness.width(), context.targets.thickness.height(), 1});
}

} // namespace brickfield
