// One dispatch over the picture for all lights: they share the reads of the G-buffer. At half resolution three: every
// fourth pixel, what their neighbours take of them, and what is left open, as a list.
#include "passes/light/field_shadow_pass.h"

#include "gpu/gl.h"
#include "passes/light/shadow_maps.h"
#include "passes/world_field/field_frame.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kAll = 0, kHalf = 1, kListed = 2; // as in shaders/lib/shadow_frame.glsl

std::shared_ptr<Program> loadFill(ShaderLibrary& shaders, bool counts) {
  std::map<std::string, std::string> defines;
  if (counts) defines = {{"COUNTERS_ON", "1"}};
  return shaders.load({counts ? "shadow_fill_counting" : "shadow_fill",
                       {{GL_COMPUTE_SHADER, "passes/shadow_fill.comp.glsl"}},
                       std::move(defines),
                       {}});
}

} // namespace

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
  if (!settings.halfResolution) return run(context.targets.shadow, kAll);
  run(context.targets.shadowHalf, kHalf);
  fill(context, program, counts);
}

// marching  the program that marches what is listed, all else of it set
void FieldShadowPass::fill(const FrameContext& context, Program& marching, bool counts) {
  FrameTargets& targets = context.targets;
  std::shared_ptr<Program>& program = fillPrograms_[counts ? 1 : 0];
  if (!program) program = loadFill(*shaders_, counts);
  const glm::ivec2 squares(targets.shadowHalf.width(), targets.shadowHalf.height());
  constexpr std::uint32_t kPixelsOfSquare = 4;
  const glm::ivec3 group = marching.groupSize();
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  targets.shadowHalf.bind(shared::kShadowHalfUnit);
  targets.shadow.bindImage(0, 0, GL_WRITE_ONLY);
  targets.shadowList.begin(static_cast<std::size_t>(squares.x) * static_cast<std::size_t>(squares.y));
  program->set("squaresOfGroup", static_cast<std::uint32_t>(group.x * group.y) / kPixelsOfSquare);
  program->dispatchOver({squares.x, squares.y, 1});
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  marching.set("resolutionStep", kListed);
  targets.shadowList.dispatch(marching);
}

} // namespace brickfield
