// Owns the passes, fills the frame's parameters, runs the plan.
#include "renderer/renderer.h"

#include <algorithm>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
#include "gpu/shader_library.h"
#include "passes/debug/debug_view_pass.h"
#include "passes/debug/field_view_pass.h"
#include "passes/debug/shadow_map_view_pass.h"
#include "passes/debug/taa_view_pass.h"
#include "passes/geometry/deform_pass.h"
#include "passes/geometry/mesh_pass.h"
#include "passes/geometry/sdf_box_pass.h"
#include "passes/geometry/sdf_cull_pass.h"
#include "passes/geometry/sdf_tile_pass.h"
#include "passes/geometry/triplanar_pass.h"
#include "passes/light/environment_pass.h"
#include "passes/light/field_occlusion_pass.h"
#include "passes/light/field_reflection_pass.h"
#include "passes/light/field_shadow_pass.h"
#include "passes/light/lighting_pass.h"
#include "passes/light/map_shadow_pass.h"
#include "passes/light/shadow_map_pass.h"
#include "passes/light/shadow_maps.h"
#include "passes/light/shadow_moments_pass.h"
#include "passes/light/shadow_range_pass.h"
#include "passes/light/translucency_pass.h"
#include "passes/post/motion_blur_pass.h"
#include "passes/post/taa_pass.h"
#include "passes/post/taa_sharpen_pass.h"
#include "passes/post/temporal.h"
#include "passes/post/tone_pass.h"
#include "passes/view_params.h"
#include "passes/world_field/world_triangles_pass.h"
#include "renderer/frame_plan.h"
#include "renderer/frame_readback.h"
#include "renderer/late_pass.h"
#include "resident/mesh_boxes.h"
#include "shared/bindings.h"
#include "shared/sdf_params.h"

namespace brickfield {

namespace {

/// What decides which passes a frame has.
struct FrameShape {
  bool hasClear = false, boxesFirst = false, hasBoxes = false, hasTiles = false, hasTriplanar = false;
  bool hasExactField = false, hasRtsdfField = false, hasFieldShadows = false, hasOcclusion = false;
  bool hasTranslucency = false, hasReflections = false, hasShadowMaps = false, hasShadowMoments = false,
       hasShadowRanges = false;
  bool mapsAnswer = false, hasTaa = false, hasMotionBlur = false;
  bool showsPicture = false, showsDebugView = false, showsFieldView = false, showsShadowMaps = false, showsTaa = false;
};

} // namespace

struct Renderer::Parts {
  explicit Parts(const ContextInfo& info);

  ShaderLibrary shaders;
  FrameTimers timers;
  DeformPass deform;
  ClearPass clear;
  MeshPass mesh;
  DepthCopyPass depthCopy;
  SdfCullPass sdfCull;
  SdfBoxPass sdfBox;
  BoxOverdrawPass boxOverdraw;
  EnvironmentPass environment;
  LightingPass lighting;
  TonePass tone;
  DebugViewPass debugView;
  LatePass<WorldTrianglesPass> worldTriangles;
  LatePass<PseudonormalsPass> pseudonormals;
  LatePass<FieldClearPass> fieldClear;
  LatePass<FieldSplatPass> fieldSplat;
  LatePass<FieldCandidatesPass> fieldCandidates;
  LatePass<FieldResolvePass> fieldResolve;
  LatePass<HierarchyRefitPass> hierarchyRefit;
  LatePass<RtsdfVoxelizePass> rtsdfVoxelize;
  LatePass<RtsdfJumpFloodPass> rtsdfJumpFlood;
  LatePass<RtsdfRaysPass> rtsdfRays;
  LatePass<ScreenBoxPass> screenBoxes;
  LatePass<SdfTilePass> sdfTiles;
  LatePass<TriplanarPass> triplanar;
  LatePass<FieldShadowPass> fieldShadow;
  LatePass<FieldOcclusionPass> fieldOcclusion;
  LatePass<OcclusionSpreadPass> occlusionSpread;
  LatePass<TranslucencyPass> translucency;
  LatePass<FieldReflectionPass> fieldReflection;
  LatePass<ReflectionShadePass> reflectionShade;
  LatePass<FieldViewPass> fieldView;
  LatePass<ShadowMapPass> shadowMap;
  LatePass<ShadowMomentsPass> shadowMoments;
  LatePass<ShadowRangePass> shadowRange;
  LatePass<MapShadowPass> mapShadow;
  LatePass<ShadowMapViewPass> shadowMapView;
  LatePass<TaaPass> taa;
  LatePass<TaaSharpenPass> taaSharpen;
  LatePass<MotionBlurPass> motionBlur;
  LatePass<TaaViewPass> taaView;

  RendererSettings settings;
  const Scene* source = nullptr;
  std::unique_ptr<ResidentScene> scene;
  std::unique_ptr<FrameTargets> targets;
  VisibleBoxes visible;
  Buffer frameParams, counters;
  std::array<glm::vec3, 9> irradiance{};
  SceneFields fieldOfNode;                ///< without the fields: which nodes are SDF objects
  std::unique_ptr<FieldKeeper> field;     ///< null until a frame reads the world field
  std::unique_ptr<ShadowMaps> shadowMaps; ///< null until a frame asks for them
  std::unique_ptr<MeshBoxes> meshBoxes;
  std::vector<Box> drawBoxes;    ///< of the pose's mesh draws, metres from the anchor
  glm::dvec3 drawAnchorWorld{0}; ///< in the middle of the pose
  std::vector<DrawRun> meshRuns; ///< of the last frame
  std::vector<PosedLight> lights;
  std::unique_ptr<Temporal> temporal; ///< null: no temporal antialiasing
  View previousView;                  ///< of the last frame, where temporal has a history
  bool isFieldInFrame = false;
  std::vector<std::int32_t> nodeOfInstance; ///< of the SDF objects of the last frame
  Pose pose;
  View view;
  bool isPosed = false, isLit = false;

  std::vector<PlannedPass> plan(const FrameContext& context);
  shared::FrameParams fillParams() const;
  bool readsField() const;
  bool tracesTiles() const;
  const FieldFrame& prepareField();
  void placeDraws();
  MeshDraws meshDraws() const { return {scene->batches(), drawBoxes, drawAnchorWorld}; }
  void prepareShadowMaps(const shared::FrameParams& params);
  void prepareTemporal();
  void keepForNextFrame();

  template <typename Take>
  static void listPasses(const FrameShape& shape, const Take& take);
};

namespace {

std::vector<ResourceUse> providedByHost() {
  // The last three are read by nobody where there are no shadows, or no filter wants them.
  return {{Resource::FrameParams, Access::Upload},     {Resource::MeshVertices, Access::Upload},
          {Resource::MeshDraws, Access::Upload},       {Resource::SdfScene, Access::Upload},
          {Resource::Environment, Access::ImageStore}, {Resource::Counters, Access::Upload},
          {Resource::Shadow, Access::Upload},          {Resource::ShadowReads, Access::Upload},
          {Resource::ShadowMoments, Access::Upload}};
}

} // namespace

Renderer::Parts::Parts(const ContextInfo& info)
    : shaders(findShaderRoot()),
      timers(info),
      deform(shaders),
      mesh(shaders),
      sdfCull(shaders),
      sdfBox(shaders),
      boxOverdraw(shaders),
      environment(shaders),
      lighting(shaders),
      tone(shaders),
      debugView(shaders),
      frameParams("frame_params", sizeof(shared::FrameParams)),
      counters("counters", shared::COUNTERS * sizeof(std::uint32_t)) {}

bool Renderer::Parts::readsField() const {
  if (settings.worldField.method == FieldMethod::Off) return false;
  const DebugView* shown = findView(settings.view);
  return settings.worldField.always || marchesField(settings.shadows.method) ||
         settings.occlusion.form != OcclusionForm::Off || settings.reflections.method != ReflectionMethod::Off ||
         (shown && shown->readsField);
}

bool Renderer::Parts::tracesTiles() const {
  const bool boxesFirst = settings.drawOrder == DrawOrder::BoxesFirstAllReversed;
  return settings.sdfTracing == SdfTracing::Tiles && !boxesFirst && scene->sdfInstanceCount() > 0;
}

const FieldFrame& Renderer::Parts::prepareField() {
  if (!field) field = std::make_unique<FieldKeeper>(*source, fieldOfNode, *scene, settings.worldField);
  return field->prepare(pose, view, settings.fieldSlice);
}

void Renderer::Parts::placeDraws() {
  if (!meshBoxes) meshBoxes = std::make_unique<MeshBoxes>(*source);
  drawAnchorWorld = pose.boundsWorld.isEmpty() ? glm::dvec3(0) : glm::dvec3(pose.boundsWorld.center());
  drawBoxes = meshBoxes->anchored(scene->meshPlaces(), pose, drawAnchorWorld);
}

void Renderer::Parts::prepareShadowMaps(const shared::FrameParams& params) {
  const bool hasRanges = settings.shadows.method == ShadowMethod::MapsAndField;
  if (!shadowMaps || !(shadowMaps->settings() == settings.shadowMaps) || shadowMaps->hasRanges() != hasRanges)
    shadowMaps = std::make_unique<ShadowMaps>(settings.shadowMaps, hasRanges);
  shadowMaps->prepare(lights, view, pose.boundsWorld, params, scene->sdfInstanceCount(), meshDraws());
}

// A jitter of its own for each frame; what the frame before left, as long as pictures are of one size.
void Renderer::Parts::prepareTemporal() {
  if (!settings.taa.on) {
    temporal.reset();
    return;
  }
  if (!temporal) temporal = std::make_unique<Temporal>(*targets);
  temporal->sharpness = settings.taa.sharpness;
  temporal->shutter = settings.taa.shutter;
  temporal->table.prepare(*scene);
  view.jitterNdc = 2.0f * taaJitter(temporal->frame) / glm::vec2(view.sizePixels);
}

void Renderer::Parts::keepForNextFrame() {
  if (!temporal) return;
  temporal->table.keep(*scene);
  temporal->hasHistory = true;
  ++temporal->frame;
  previousView = view;
}

// The frame on one screen; take is handed pointers to the members, so that names need no renderer.
template <typename Take>
void Renderer::Parts::listPasses(const FrameShape& shape, const Take& take) {
  take(&Parts::deform);                              // moved vertices, before anything draws them
  if (shape.hasExactField) take(&Parts::fieldClear); // side by side with the next
  if (shape.hasExactField || shape.hasRtsdfField) take(&Parts::worldTriangles); // of the deformed vertices
  if (shape.hasExactField) {
    take(&Parts::pseudonormals); // side by side with the next
    take(&Parts::fieldSplat);
    take(&Parts::fieldCandidates);
    take(&Parts::fieldResolve); // the field is whole before anything reads it
  }
  if (shape.hasRtsdfField) {
    take(&Parts::hierarchyRefit);
    take(&Parts::rtsdfVoxelize);
    take(&Parts::rtsdfJumpFlood);
    take(&Parts::rtsdfRays);
  }
  if (shape.hasClear) take(&Parts::clear);
  take(&Parts::sdfCull); // which boxes, and how
  if (shape.boxesFirst) take(&Parts::sdfBox);
  take(&Parts::mesh);
  if (shape.hasBoxes) {
    take(&Parts::depthCopy); // ends the rays of SDF objects behind meshes
    take(&Parts::sdfBox);
  }
  if (shape.hasTiles) { // in their place
    take(&Parts::screenBoxes);
    take(&Parts::sdfTiles);
  }
  if (shape.hasTriplanar) take(&Parts::triplanar); // the last word about surfaces
  if (shape.hasShadowMaps) take(&Parts::shadowMap);
  if (shape.hasShadowMoments) take(&Parts::shadowMoments);
  if (shape.hasShadowRanges) take(&Parts::shadowRange);
  if (shape.mapsAnswer) take(&Parts::mapShadow);
  if (shape.hasFieldShadows) take(&Parts::fieldShadow); // with ranges where they leave it open
  if (shape.hasOcclusion) {
    take(&Parts::fieldOcclusion);
    take(&Parts::occlusionSpread); // over all pixels
  }
  if (shape.hasTranslucency) take(&Parts::translucency);
  if (shape.hasReflections) {
    take(&Parts::fieldReflection);
    take(&Parts::reflectionShade); // by the shadows and the occlusion of what the picture shows
  }
  take(&Parts::lighting); // also under a debug view: layers are whole whatever the picture shows
  if (shape.hasTaa) {
    take(&Parts::taa);
    take(&Parts::taaSharpen);
  }
  if (shape.hasMotionBlur) take(&Parts::motionBlur);
  if (shape.showsPicture) take(&Parts::tone);
  if (shape.showsDebugView) {
    take(&Parts::boxOverdraw);
    take(&Parts::debugView);
  }
  if (shape.showsFieldView) take(&Parts::fieldView);
  if (shape.showsShadowMaps) take(&Parts::shadowMapView);
  if (shape.showsTaa) take(&Parts::taaView);
}

std::vector<PlannedPass> Renderer::Parts::plan(const FrameContext& context) {
  const DebugView* shown = findView(settings.view);
  const bool readsField = shown && shown->readsField, readsMaps = shown && shown->readsShadowMaps;
  const bool readsTemporal = shown && shown->readsTemporal;
  const bool hasMaps = context.shadowMaps != nullptr, hasRanges = hasMaps && context.shadowMaps->hasRanges();
  const bool boxesFirst = settings.drawOrder == DrawOrder::BoxesFirstAllReversed, hasTiles = tracesTiles();
  const FrameShape shape{.hasClear = !hasTiles || !meshRuns.empty(), // else tiles write every pixel
                         .boxesFirst = boxesFirst,
                         .hasBoxes = !boxesFirst && !hasTiles,
                         .hasTiles = hasTiles,
                         .hasTriplanar = !scene->triplanarMaterials().empty(),
                         .hasExactField = context.field && context.field->exact,
                         .hasRtsdfField = context.field && context.field->rtsdf,
                         .hasFieldShadows = marchesField(settings.shadows.method),
                         .hasOcclusion = context.occlusion.form != OcclusionForm::Off,
                         .hasTranslucency = context.translucency.source != TranslucencySource::Off,
                         .hasReflections = context.reflections.method != ReflectionMethod::Off,
                         .hasShadowMaps = hasMaps,
                         .hasShadowMoments = hasMaps && !hasRanges && settings.shadowMaps.filter == ShadowFilter::Evsm,
                         .hasShadowRanges = hasRanges,
                         .mapsAnswer = hasMaps && !hasRanges,
                         .hasTaa = context.temporal != nullptr,
                         .hasMotionBlur = context.temporal && context.temporal->shutter > 0,
                         .showsPicture = !shown,
                         .showsDebugView = shown && !readsField && !readsMaps && !readsTemporal,
                         .showsFieldView = readsField,
                         .showsShadowMaps = readsMaps,
                         .showsTaa = readsTemporal};
  std::vector<PlannedPass> passes;
  listPasses(shape, [&](auto member) {
    auto& pass = this->*member;
    if constexpr (isLate<std::remove_reference_t<decltype(pass)>>) pass.make(shaders);
    passes.push_back({pass.declare(), [&pass, &context] { pass.record(context); }, 0});
  });
  planFrame(passes, providedByHost());
  return passes;
}

shared::FrameParams Renderer::Parts::fillParams() const {
  shared::FrameParams params{};
  setViewParams(params, view);
  params.projection.w = std::exp2(settings.exposureEv);
  const DebugView* shown = findView(settings.view);
  params.size.z = scene->lightCount();
  params.size.w = shown ? shown->number : shared::DEBUG_VIEW_NONE;
  params.counts = {scene->sdfInstanceCount(), static_cast<std::uint32_t>(settings.forcedLevel + 1),
                   settings.maxTraceSteps, static_cast<std::uint32_t>(environment.radiance().levels())};
  if (shown) params.debugRange = {0, shown->redAt, 0, 0};
  if (shown && shown->number == shared::DEBUG_VIEW_DEPTH && !pose.boundsWorld.isEmpty()) {
    const float radius = 0.5f * glm::length(pose.boundsWorld.extent());
    const float toCenter = glm::distance(view.eyeWorld, pose.boundsWorld.center());
    params.debugRange = {std::max(0.0f, toCenter - radius), toCenter + radius, 0, 0};
  }
  if (shown && shown->number == shared::DEBUG_VIEW_THICKNESS && !pose.boundsWorld.isEmpty())
    params.debugRange = {0, 0.25f * glm::length(pose.boundsWorld.extent()), 0, 0};
  if (temporal) {
    const View& before = temporal->hasHistory ? previousView : view;
    View still = before;
    still.jitterNdc = glm::vec2(0);
    const glm::dvec3 moved = glm::dvec3(view.eyeWorld) - glm::dvec3(before.eyeWorld);
    params.previousClipFromEye = glm::mat4(glm::translate(clipFromEye(still), moved));
  }
  if (isFieldInFrame) params.eyeAnchored = glm::vec4(glm::dvec3(view.eyeWorld) - field->anchorWorld(), 0);
  for (std::size_t i = 0; i < irradiance.size(); ++i) params.irradiance[i] = glm::vec4(irradiance[i], 0);
  return params;
}

Renderer::Renderer(const ContextInfo& info) : parts_(std::make_unique<Parts>(info)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

void Renderer::setScene(const Scene& scene, const SceneFields& fields) {
  parts_->field.reset();
  parts_->isFieldInFrame = false;
  parts_->temporal.reset();
  parts_->meshBoxes.reset();
  parts_->scene.reset();
  parts_->scene = std::make_unique<ResidentScene>(scene, fields);
  parts_->source = &scene;
  parts_->fieldOfNode.fieldOfNode = fields.fieldOfNode;
  parts_->isPosed = parts_->isLit = false;
}

void Renderer::setPose(Pose pose) {
  if (!parts_->scene) throw Failure("renderer: a pose was set before a scene");
  parts_->scene->setPose(*parts_->source, pose);
  parts_->visible.fit(std::max(1u, parts_->scene->sdfInstanceCount()));
  parts_->pose = std::move(pose);
  parts_->placeDraws();
  parts_->isPosed = true;
}

void Renderer::setLighting(const Lighting& lighting) {
  if (!parts_->scene) throw Failure("renderer: lighting was set before a scene");
  parts_->scene->setLighting(lighting);
  parts_->environment.prepare(lighting.environment);
  parts_->irradiance = irradianceHarmonics(lighting.environment);
  parts_->lights = lighting.lights;
  parts_->isLit = true;
}

void Renderer::setSettings(const RendererSettings& settings) {
  checkSettings(settings);
  if (!(settings.worldField == parts_->settings.worldField)) {
    parts_->field.reset();
    parts_->isFieldInFrame = false;
  }
  parts_->settings = settings;
}

void Renderer::render(const View& view) {
  Parts& parts = *parts_;
  if (!parts.scene || !parts.isPosed || !parts.isLit) throw Failure("renderer: scene, pose and lighting must be set");
  if (!parts.targets || parts.targets->size != view.sizePixels) {
    parts.temporal.reset();
    parts.targets.reset();
    parts.targets = std::make_unique<FrameTargets>(view.sizePixels);
  }
  const OcclusionSettings& occlusion = parts.settings.occlusion;
  parts.targets->fitOcclusion(occlusion.form == OcclusionForm::Off ? 0 : occlusion.scale);
  parts.targets->fitTiles(parts.tracesTiles());
  parts.targets->fitTranslucency(parts.settings.translucency.source != TranslucencySource::Off);
  parts.targets->fitReflections(parts.settings.reflections.method != ReflectionMethod::Off);
  parts.view = view;
  parts.nodeOfInstance.clear();
  for (const shared::SdfInstance& row : parts.scene->sdfInstances()) parts.nodeOfInstance.push_back(row.ids.x);
  parts.prepareTemporal();
  parts.meshRuns = frontToBack(visibleDraws(parts.meshDraws(), parts.view), parts.meshDraws(), parts.view);
  parts.isFieldInFrame = parts.readsField();
  const FieldFrame* field = parts.isFieldInFrame ? &parts.prepareField() : nullptr;
  const shared::FrameParams params = parts.fillParams();
  parts.frameParams.uploadValue(params);
  if (drawsMaps(parts.settings.shadows.method)) parts.prepareShadowMaps(params);
  parts.frameParams.bindUniform(shared::kFrameUniformBinding);
  parts.counters.clear(0);

  const FrameContext context{*parts.scene,
                             *parts.targets,
                             parts.visible,
                             parts.counters,
                             parts.environment.radiance(),
                             parts.environment.brdf(),
                             parts.settings.drawOrder,
                             parts.settings.countersOn,
                             field ? &parts.field->triangles() : nullptr,
                             field,
                             parts.settings.shadows.method != ShadowMethod::None ? &parts.settings.shadows : nullptr,
                             parts.settings.view == "shadow-reads",
                             &parts.frameParams,
                             drawsMaps(parts.settings.shadows.method) ? parts.shadowMaps.get() : nullptr,
                             parts.temporal.get(),
                             parts.settings.occlusion,
                             parts.settings.brdf,
                             parts.settings.translucency,
                             parts.settings.reflections,
                             parts.meshRuns};
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_BLEND);
  glEnable(GL_FRAMEBUFFER_SRGB); // albedo is stored as sRGB; the other targets are linear and unaffected
  parts.timers.beginFrame();
  for (const PlannedPass& pass : parts.plan(context)) {
    const DebugGroup group(pass.declaration.name);
    const auto timer = parts.timers.scope(pass.declaration.name);
    if (pass.barriersBefore) glMemoryBarrier(pass.barriersBefore);
    pass.record();
  }
  if (field) parts.field->settle();
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  parts.keepForNextFrame();
}

FrameStats Renderer::stats() {
  Parts& parts = *parts_;
  FrameStats stats;
  stats.passes = parts.timers.results();
  if (!parts.scene || !parts.targets) return stats;
  const std::vector<std::uint32_t> counts = parts.counters.read<std::uint32_t>();
  stats.counters = {counts[shared::COUNTER_FRAGMENTS],      counts[shared::COUNTER_HITS],
                    counts[shared::COUNTER_STEPS],          counts[shared::COUNTER_BRICK_READS],
                    counts[shared::COUNTER_PROMISE_BROKEN], counts[shared::COUNTER_OUT_OF_STEPS],
                    counts[shared::COUNTER_SHADOW_READS],   counts[shared::COUNTER_OCCLUSION_READS],
                    counts[shared::COUNTER_MAP_FRAGMENTS],  counts[shared::COUNTER_MAP_STEPS],
                    counts[shared::COUNTER_INSIDE_STEPS],   counts[shared::COUNTER_REFLECTION_READS]};
  if (drawsMaps(parts.settings.shadows.method) && parts.shadowMaps) {
    stats.shadowMapLayers = static_cast<std::uint32_t>(parts.shadowMaps->layerCount());
    stats.shadowMapDraws = parts.shadowMaps->drawCount();
    const bool hasBoxes = parts.settings.countersOn && parts.scene->sdfInstanceCount() > 0;
    if (hasBoxes) stats.shadowMapBoxes = parts.shadowMaps->boxCount();
  }
  stats.sdfInstances = parts.scene->sdfInstanceCount();
  if (stats.sdfInstances > 0) {
    const std::vector<shared::BoxCommand> commands = parts.visible.commands().read<shared::BoxCommand>();
    stats.sdfInside = commands[shared::BOX_COMMAND_NEAR_PLANE].instances;
    stats.sdfVisible = commands[shared::BOX_COMMAND_FACING].instances + stats.sdfInside;
  }
  stats.meshDraws = parts.scene->meshDrawCount();
  for (const DrawRun& run : parts.meshRuns) stats.meshVisible += run.drawCount;
  stats.bricks = parts.scene->atlas().brickCount();
  stats.bytes = {parts.scene->atlas().bytes(),
                 parts.scene->meshes().bytes(),
                 parts.scene->materials().bytes() + parts.environment.radiance().bytes() +
                     parts.environment.brdf().bytes(),
                 parts.scene->tableBytes(),
                 parts.targets->bytes(),
                 parts.shadowMaps ? parts.shadowMaps->bytes() : 0,
                 parts.temporal ? parts.temporal->bytes() : 0};
  stats.field = fieldStats();
  return stats;
}

std::vector<PassTime> Renderer::passTimes() { return parts_->timers.results(); }

FieldStats Renderer::fieldStats() const { return parts_->isFieldInFrame ? parts_->field->stats() : FieldStats{}; }

FieldVolumes Renderer::readWorldField() const {
  if (!parts_->field) throw Failure("renderer: no frame has made a world field");
  return parts_->field->read();
}

FieldPicture Renderer::fieldPicture() const {
  if (!parts_->field) throw Failure("renderer: no frame has made a world field");
  return parts_->field->picture();
}

std::vector<std::string> framePassNames() {
  std::vector<std::string> names;
  Renderer::Parts::listPasses({.hasClear = true,
                               .boxesFirst = false,
                               .hasBoxes = true,
                               .hasTiles = true,
                               .hasTriplanar = true,
                               .hasExactField = true,
                               .hasRtsdfField = true,
                               .hasFieldShadows = true,
                               .hasOcclusion = true,
                               .hasTranslucency = true,
                               .hasReflections = true,
                               .hasShadowMaps = true,
                               .hasShadowMoments = true,
                               .hasShadowRanges = true,
                               .mapsAnswer = true,
                               .hasTaa = true,
                               .hasMotionBlur = true,
                               .showsPicture = true,
                               .showsDebugView = true,
                               .showsFieldView = true,
                               .showsShadowMaps = true,
                               .showsTaa = true},
                              [&]<typename Pass>(Pass Renderer::Parts::*) { names.push_back(Pass::declare().name); });
  return names;
}

FrameLayers Renderer::readLayers() const {
  if (!parts_->targets) throw Failure("renderer: no frame was rendered");
  const bool isShadowed = parts_->settings.shadows.method != ShadowMethod::None;
  const std::uint32_t lights = isShadowed ? parts_->scene->lightCount() : 0;
  return readFrameLayers(*parts_->targets, parts_->view,
                         std::min(lights, static_cast<std::uint32_t>(shared::MOST_SHADOWED_LIGHTS)),
                         parts_->nodeOfInstance);
}

std::vector<std::uint32_t> Renderer::readShadowReads() const {
  if (!parts_->targets) throw Failure("renderer: no frame was rendered");
  return readFrameShadowReads(*parts_->targets);
}

std::vector<std::uint8_t> Renderer::readPicture() const {
  if (!parts_->targets) throw Failure("renderer: no frame was rendered");
  return readFramePicture(*parts_->targets);
}

std::vector<glm::vec2> Renderer::readMotion() const {
  if (!parts_->temporal) throw Failure("renderer: the frame had no motion vectors");
  const Texture& motion = parts_->temporal->motion;
  const std::vector<float> stored = motion.readFloats();
  const auto width = static_cast<std::size_t>(motion.width()), height = static_cast<std::size_t>(motion.height());
  std::vector<glm::vec2> moved(width * height);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const float* texel = &stored[4 * ((height - 1 - y) * width + x)];
      moved[y * width + x] = {texel[0], -texel[1]};
    }
  return moved;
}

std::vector<float> Renderer::readShadowMap(int layer) const {
  if (layer < 0 || !parts_->shadowMaps || layer >= parts_->shadowMaps->layerCount())
    throw Failure("renderer: no frame has made this shadow map");
  const Texture& depths = parts_->shadowMaps->depths();
  return depths.read<float>(0, {0, 0, layer}, {depths.width(), depths.height(), 1});
}

std::vector<glm::vec2> Renderer::readShadowRange(int layer, int level) const {
  const ShadowMaps* maps = parts_->shadowMaps.get();
  if (layer < 0 || level < 0 || !maps || !maps->hasRanges() || layer >= maps->layerCount() ||
      level >= maps->rangeLevels())
    throw Failure("renderer: no frame has made this shadow range");
  const glm::ivec2 box = maps->rangeBox(level);
  return maps->ranges().read<glm::vec2>(0, {0, box.x, layer}, {box.y, box.y, 1});
}

const std::vector<ShadowView>& Renderer::shadowViews() const {
  static const std::vector<ShadowView> kNone;
  return parts_->shadowMaps ? parts_->shadowMaps->views() : kNone;
}

std::vector<std::string> Renderer::reloadShaders() { return parts_->shaders.reloadChanged(); }

} // namespace brickfield
