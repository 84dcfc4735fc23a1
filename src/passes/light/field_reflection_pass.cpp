// Both go twice over the picture where not every pixel is traced: over those that are, then over what lies between.
#include "passes/light/field_reflection_pass.h"

#include <algorithm>

#include "gpu/gl.h"
#include "passes/world_field/field_frame.h"

namespace brickfield {

namespace {

ProgramSource sourceOf(bool counts) {
  std::map<std::string, std::string> defines;
  if (counts) defines = {{"COUNTERS_ON", "1"}};
  return {counts ? "field_reflection_counting" : "field_reflection",
          {{GL_COMPUTE_SHADER, "passes/field_reflection.comp.glsl"}},
          std::move(defines),
          {}};
}

int shadowedLights(const FrameContext& context) {
  const std::uint32_t lights = context.shadows ? context.scene.lightCount() : 0;
  return std::min(static_cast<int>(lights), shared::MOST_SHADOWED_LIGHTS);
}

void runSteps(Program& program, const FrameTargets& targets, int scale) {
  const glm::ivec2 size(targets.size), traced = (size + scale - 1) / scale;
  program.set("scale", scale);
  program.set("fillsGaps", false);
  program.dispatchOver({traced.x, traced.y, 1});
  if (scale == 1) return;
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  program.set("fillsGaps", true);
  program.dispatchOver({size.x, size.y, 1});
}

} // namespace

FieldReflectionPass::FieldReflectionPass(ShaderLibrary& shaders)
    : program_(shaders.load(sourceOf(false))), countingProgram_(shaders.load(sourceOf(true))) {}

PassDeclaration FieldReflectionPass::declare() {
  return {"field_reflection",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::WorldField, Access::Sampled},
           {Resource::WorldField, Access::StorageRead}},
          {{Resource::ReflectionHit, Access::ImageStore}, {Resource::Counters, Access::StorageWrite}}};
}

void FieldReflectionPass::record(const FrameContext& context) {
  context.scene.atlas().bind();
  context.scene.bindSdfInstances();
  context.scene.bindNodeRows();
  bindWorldField(*context.field);
  context.targets.bindGBuffer();
  context.scene.bindLights();
  context.counters.bindStorage(shared::kPassBufferABinding);
  context.targets.reflectionHit.bindImage(0, 0, GL_WRITE_ONLY);
  Program& program = context.countersOn ? *countingProgram_ : *program_;
  program.set("shadowedLights", shadowedLights(context));
  runSteps(program, context.targets, context.reflections.scale);
}

ReflectionShadePass::ReflectionShadePass(ShaderLibrary& shaders)
    : program_(shaders.load({"reflection_shade", {{GL_COMPUTE_SHADER, "passes/reflection_shade.comp.glsl"}}, {}, {}})) {
}

PassDeclaration ReflectionShadePass::declare() {
  return {"reflection_shade",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::Environment, Access::Sampled},
           {Resource::ReflectionHit, Access::Sampled}},
          {{Resource::Reflection, Access::ImageStore}},
          {{Resource::Shadow, Access::Sampled}, {Resource::Occlusion, Access::Sampled}}};
}

void ReflectionShadePass::record(const FrameContext& context) {
  const FrameTargets& targets = context.targets;
  targets.bindGBuffer();
  context.scene.atlas().bind();
  context.scene.bindSdfInstances();
  context.scene.bindNodeRows();
  context.scene.bindNodeLooks();
  context.scene.bindLights();
  context.environment.bind(shared::kEnvironmentUnit);
  context.environmentBrdf.bind(shared::kEnvironmentBrdfUnit);
  targets.shadow.bind(shared::kShadowUnit);
  const bool isOccluded = context.occlusion.form != OcclusionForm::Off;
  if (isOccluded) targets.occlusion.bind(shared::kOcclusionUnit);
  targets.reflectionHit.bind(shared::kReflectionHitUnit);
  targets.reflection.bindImage(0, 0, GL_READ_WRITE);
  program_->set("isOccluded", isOccluded);
  program_->set("shadowedLights", shadowedLights(context));
  program_->set("isBlinnPhong", context.brdf == BrdfModel::BlinnPhong);
  runSteps(*program_, targets, context.reflections.scale);
}

} // namespace brickfield
