// The frame as a list of passes, and what it hands them.
#include "renderer/parts.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "passes/view_params.h"
#include "shared/sdf_params.h"

namespace brickfield {

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
      clear(shaders),
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
  temporal->table.prepare(*scene, view.eyeWorld);
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
    take(&Parts::reflectionPlaces); // which pixels trace
    take(&Parts::fieldReflection);
    take(&Parts::reflectionShade);  // by the shadows and the occlusion of what the picture shows
    take(&Parts::reflectionSpread); // over all pixels
  }
  take(&Parts::lighting); // also under a debug view: layers are whole whatever the picture shows
  if (shape.hasTaa) {
    take(&Parts::motion);
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
  const FrameShape shape{.hasClear = !hasTiles || !meshRuns.empty(), // else tiles write id and depth of every pixel
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

} // namespace brickfield
