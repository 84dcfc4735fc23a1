// Both passes know how to trace: the second one does where no pixel of the first is like its own.
#include "passes/light/field_occlusion_pass.h"

#include <algorithm>

#include "passes/world_field/field_frame.h"
#include "shared/field_occlusion_params.h"

namespace brickfield {

namespace {

ProgramSource programOf(const std::string& name, const char* path, bool counts) {
  std::map<std::string, std::string> defines;
  if (counts) defines = {{"COUNTERS_ON", "1"}};
  return {counts ? name + "_counting" : name, {{GL_COMPUTE_SHADER, path}}, std::move(defines), {}};
}

int formNumber(OcclusionForm form) {
  switch (form) {
  case OcclusionForm::Taps:
    return shared::OCCLUSION_TAPS;
  case OcclusionForm::Rays:
    return shared::OCCLUSION_RAYS;
  default:
    return shared::OCCLUSION_CONES;
  }
}

void setSearch(Program& program, const OcclusionSettings& settings) {
  program.set("occlusionForm", formNumber(settings.form));
  program.set("occlusionCones", settings.cones);
  program.set("occlusionScale", settings.scale);
  program.set("occlusionRadius", std::min(settings.radiusMetres, std::numeric_limits<float>::max()));
}

void bindInputs(const FrameContext& context) {
  bindWorldField(*context.field);
  context.targets.bindGBuffer();
  context.counters.bindStorage(shared::kPassBufferABinding);
}

} // namespace

FieldOcclusionPass::FieldOcclusionPass(ShaderLibrary& shaders)
    : program_(shaders.load(programOf("field_occlusion", "passes/field_occlusion.comp.glsl", false))),
      countingProgram_(shaders.load(programOf("field_occlusion", "passes/field_occlusion.comp.glsl", true))) {}

PassDeclaration FieldOcclusionPass::declare() {
  return {"field_occlusion",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::WorldField, Access::Sampled}},
          {{Resource::OcclusionTraced, Access::ImageStore}, {Resource::Counters, Access::StorageWrite}}};
}

void FieldOcclusionPass::record(const FrameContext& context) {
  bindInputs(context);
  const Texture& traced = context.targets.occlusionTraced;
  traced.bindImage(0, 0, GL_WRITE_ONLY);
  Program& program = context.countersOn ? *countingProgram_ : *program_;
  setSearch(program, context.occlusion);
  // A thread a cone or a ray; where taps along the normal are all, a thread a place.
  const glm::ivec2 places = context.occlusion.form == OcclusionForm::Taps ? glm::ivec2(8, 8) : glm::ivec2(4, 2);
  program.set("occlusionPlaces", places);
  program.use();
  glDispatchCompute(ceilDivide(static_cast<std::uint32_t>(traced.width()), static_cast<std::uint32_t>(places.x)),
                    ceilDivide(static_cast<std::uint32_t>(traced.height()), static_cast<std::uint32_t>(places.y)), 1);
}

OcclusionSpreadPass::OcclusionSpreadPass(ShaderLibrary& shaders)
    : program_(shaders.load(programOf("occlusion_spread", "passes/occlusion_spread.comp.glsl", false))),
      countingProgram_(shaders.load(programOf("occlusion_spread", "passes/occlusion_spread.comp.glsl", true))) {}

PassDeclaration OcclusionSpreadPass::declare() {
  return {"occlusion_spread",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::WorldField, Access::Sampled},
           {Resource::OcclusionTraced, Access::Sampled}},
          {{Resource::Occlusion, Access::ImageStore}, {Resource::Counters, Access::StorageWrite}}};
}

void OcclusionSpreadPass::record(const FrameContext& context) {
  bindInputs(context);
  context.targets.occlusionTraced.bind(shared::kOcclusionTracedUnit);
  const Texture& occlusion = context.targets.occlusion;
  occlusion.bindImage(0, 0, GL_WRITE_ONLY);
  Program& program = context.countersOn ? *countingProgram_ : *program_;
  setSearch(program, context.occlusion);
  program.dispatchOver({occlusion.width(), occlusion.height(), 1});
}

} // namespace brickfield
