// The heavy two work on a list, so that no thread waits for its neighbours' rays and none is started for nothing.
#include "passes/light/field_reflection_pass.h"

#include <algorithm>

#include "gpu/gl.h"
#include "passes/world_field/field_frame.h"

namespace brickfield {

namespace {

int shadowedLights(const FrameContext& context) {
  const std::uint32_t lights = context.shadows ? context.scene.lightCount() : 0;
  return std::min(static_cast<int>(lights), shared::MOST_SHADOWED_LIGHTS);
}

} // namespace

ReflectionPlacesPass::ReflectionPlacesPass(ShaderLibrary& shaders)
    : program_(
          shaders.load({"reflection_places", {{GL_COMPUTE_SHADER, "passes/reflection_places.comp.glsl"}}, {}, {}})) {}

PassDeclaration ReflectionPlacesPass::declare() {
  return {"reflection_places",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled}},
          {{Resource::ReflectionList, Access::StorageWrite}, {Resource::ReflectionHit, Access::ImageStore}}};
}

void ReflectionPlacesPass::record(const FrameContext& context) {
  FrameTargets& targets = context.targets;
  targets.bindGBuffer();
  targets.reflectionList.begin(std::size_t{targets.size.x} * targets.size.y);
  targets.reflectionHit.bindImage(0, 0, GL_WRITE_ONLY);
  program_->set("scale", context.reflections.scale);
  program_->dispatchOver({targets.size.x, targets.size.y, 1});
}

FieldReflectionPass::FieldReflectionPass(ShaderLibrary& shaders) : shaders_(&shaders) {}

// Without bricks a thread needs far fewer registers: on an H200 a third of the time.
Program& FieldReflectionPass::choose(bool hasBricks, bool counts) {
  std::shared_ptr<Program>& program = programs_[(hasBricks ? 2u : 0u) + (counts ? 1u : 0u)];
  if (program) return *program;
  std::string label = "field_reflection";
  std::map<std::string, std::string> defines;
  if (hasBricks) label += "_bricks", defines["BRICKS_ON"] = "1";
  if (counts) label += "_counting", defines["COUNTERS_ON"] = "1";
  program = shaders_->load({label, {{GL_COMPUTE_SHADER, "passes/field_reflection.comp.glsl"}}, defines, {}});
  return *program;
}

PassDeclaration FieldReflectionPass::declare() {
  return {"field_reflection",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::WorldField, Access::Sampled},
           {Resource::WorldField, Access::StorageRead},
           {Resource::ReflectionList, Access::Indirect},
           {Resource::ReflectionList, Access::StorageRead}},
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
  Program& program = choose(context.scene.hasBricks(), context.countersOn);
  program.set("shadowedLights", shadowedLights(context));
  program.set("scale", context.reflections.scale);
  context.targets.reflectionList.dispatch(program);
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
           {Resource::ReflectionList, Access::Indirect},
           {Resource::ReflectionList, Access::StorageRead},
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
  targets.reflection.bindImage(0, 0, GL_WRITE_ONLY);
  program_->set("isOccluded", isOccluded);
  program_->set("shadowedLights", shadowedLights(context));
  program_->set("isBlinnPhong", context.brdf == BrdfModel::BlinnPhong);
  program_->set("scale", context.reflections.scale);
  targets.reflectionList.dispatch(*program_);
}

ReflectionSpreadPass::ReflectionSpreadPass(ShaderLibrary& shaders)
    : program_(
          shaders.load({"reflection_spread", {{GL_COMPUTE_SHADER, "passes/reflection_spread.comp.glsl"}}, {}, {}})) {}

PassDeclaration ReflectionSpreadPass::declare() {
  return {"reflection_spread",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::Environment, Access::Sampled},
           {Resource::ReflectionHit, Access::Sampled},
           {Resource::Reflection, Access::Sampled}},
          {{Resource::Reflection, Access::ImageStore}}};
}

void ReflectionSpreadPass::record(const FrameContext& context) {
  const FrameTargets& targets = context.targets;
  targets.bindGBuffer();
  context.environment.bind(shared::kEnvironmentUnit);
  targets.reflectionHit.bind(shared::kReflectionHitUnit);
  targets.reflection.bind(shared::kReflectionUnit);
  targets.reflection.bindImage(0, 0, GL_WRITE_ONLY);
  program_->set("scale", context.reflections.scale);
  program_->dispatchOver({targets.size.x, targets.size.y, 1});
}

} // namespace brickfield
