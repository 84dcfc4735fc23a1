// One dispatch over the picture for all lights: they share the reads of the G-buffer. At half resolution two: every
// fourth pixel, then what lies between.
#include "passes/light/field_shadow_pass.h"

#include "gpu/gl.h"
#include "passes/light/shadow_maps.h"
#include "passes/world_field/field_frame.h"

namespace brickfield {

FieldShadowPass::FieldShadowPass(ShaderLibrary& shaders) : shaders_(&shaders) {}

PassDeclaration FieldShadowPass::declare() {
  return {"field_shadow",
          {{Resource::FrameParams, Access::Uniform},
           {Resource::Depth, Access::Sampled},
           {Resource::GBuffer, Access::Sampled},
           {Resource::SdfScene, Access::StorageRead},
           {Resource::WorldField, Access::Sampled},
           {Resource::WorldField, Access::StorageRead}},
          {{Resource::Shadow, Access::ImageStore},
           {Resource::ShadowReads, Access::ImageStore},
           {Resource::Counters, Access::StorageWrite}},
          {{Resource::ShadowMap, Access::Sampled}, {Resource::ShadowRange, Access::Sampled}}};
}

std::shared_ptr<Program> FieldShadowPass::load(Source source, bool mapsDecide, bool counts) const {
  constexpr std::array<const char*, kSources> kNames{"field_shadow", "brick_shadow", "published_shadow"};
  constexpr std::array<const char*, kSources> kStages{"passes/field_shadow.comp.glsl", "passes/brick_shadow.comp.glsl",
                                                      "passes/published_shadow.comp.glsl"};
  std::string label = kNames[source];
  std::map<std::string, std::string> defines;
  if (mapsDecide) label += "_maps", defines["MAPS_DECIDE"] = "1";
  if (counts) label += "_counting", defines["COUNTERS_ON"] = "1";
  return shaders_->load({label, {{GL_COMPUTE_SHADER, kStages[source]}}, defines, {}});
}

Program& FieldShadowPass::choose(const FrameContext& context, bool counts) {
  const ShadowSettings& settings = *context.shadows;
  const bool isOurs = settings.estimator == ShadowEstimator::Rays;
  const bool hasBricks = settings.nearBricks && context.field->exact && context.scene.hasBricks();
  const Source source = !isOurs ? kPublished : hasBricks ? kBricks : kField;
  const bool mapsDecide = settings.method == ShadowMethod::MapsAndField;
  std::shared_ptr<Program>& program = programs_[source][(mapsDecide ? 2u : 0u) + (counts ? 1u : 0u)];
  if (!program) program = load(source, mapsDecide, counts);
  return *program;
}

void FieldShadowPass::record(const FrameContext& context) {
  const ShadowSettings& settings = *context.shadows;
  const bool counts = context.countersOn || context.countsShadowReads;
  Program& program = choose(context, counts);
  context.scene.atlas().bind();
  context.scene.bindSdfInstances();
  context.scene.bindNodeRows();
  bindWorldField(*context.field);
  if (context.shadowMaps) context.shadowMaps->bind();
  context.targets.bindGBuffer();
  context.scene.bindLights();
  context.counters.bindStorage(shared::kPassBufferABinding);
  if (counts) context.targets.shadowReads.bindImage(1, 0, GL_READ_WRITE);
  program.set("raysOfPenumbra", settings.penumbraRays);
  program.set("softness", settings.softness);
  program.set("estimator", static_cast<std::uint32_t>(settings.estimator));
  program.set("mostStep", settings.mostStep);
  program.set("seed", settings.seed);
  const auto run = [&](const Texture& target, std::uint32_t step) {
    target.bindImage(0, 0, GL_WRITE_ONLY);
    program.set("resolutionStep", step);
    program.dispatchOver({target.width(), target.height(), 1});
  };
  constexpr std::uint32_t kAll = 0, kHalf = 1, kFill = 2; // as in shaders/lib/shadow_frame.glsl
  if (!settings.halfResolution) return run(context.targets.shadow, kAll);
  run(context.targets.shadowHalf, kHalf);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  context.targets.shadowHalf.bind(shared::kShadowHalfUnit);
  run(context.targets.shadow, kFill);
}

} // namespace brickfield
