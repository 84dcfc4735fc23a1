// The public face: sets up the parts, draws with them, reads back.
#include "renderer/renderer.h"

#include <algorithm>

#include "core/error.h"
#include "renderer/frame_readback.h"
#include "renderer/parts.h"
#include "shared/bindings.h"
#include "shared/sdf_params.h"

namespace brickfield {

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
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
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
