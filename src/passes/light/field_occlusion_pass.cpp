// Both passes know how to trace: the second one does where no pixel of the first is like its own.
#include "passes/light/field_occlusion_pass.h"

#include <algorithm>

#include "passes/world_field/field_frame.h"
#include "shared/field_occlusion_params.h"

namespace brickfield {

namespace {

ProgramSource programOf(std::string name, const char* path, bool counts, bool isSideBySide = false) {
  std::map<std::string, std::string> defines;
  if (isSideBySide) defines.emplace("SIDE_BY_SIDE", "1"), name += "_side_by_side";
  if (counts) defines.emplace("COUNTERS_ON", "1"), name += "_counting";
  return {std::move(name), {{GL_COMPUTE_SHADER, path}}, std::move(defines), {}};
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

FieldOcclusionPass::FieldOcclusionPass(ShaderLibrary& shaders) {
  for (const bool isSideBySide : {false, true})
    for (const bool counts : {false, true})
      programs_[isSideBySide][counts] =
          shaders.load(programOf("field_occlusion", "passes/field_occlusion.comp.glsl", counts, isSideBySide));
}

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
  // At every fourth pixel there are too few places for a thread each, and one cone after the other takes its time.
  const bool isSideBySide = context.occlusion.scale == 4 && context.occlusion.form == OcclusionForm::Cones;
  Program& program = *programs_[isSideBySide][context.countersOn];
  setSearch(program, context.occlusion);
  const glm::ivec2 places = isSideBySide ? glm::ivec2(4, 2) : glm::ivec2(8, 8); // of a group of 8 by 8 threads
  const glm::ivec2 groups = (glm::ivec2(traced.width(), traced.height()) + places - 1) / places;
  program.dispatchOver({8 * groups, 1});
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
