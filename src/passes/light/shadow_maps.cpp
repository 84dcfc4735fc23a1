// A frame's parameters a layer in one uniform buffer, bound by ranges.
#include "passes/light/shadow_maps.h"

#include <algorithm>
#include <bit>

#include "passes/view_params.h"
#include "shared/bindings.h"
#include "shared/sdf_params.h"

namespace brickfield {

namespace {

// A multiple of every alignment of uniform ranges that OpenGL allows a driver to ask for (256 at most).
constexpr std::size_t kViewStrideBytes = 1024;
static_assert(sizeof(shared::FrameParams) <= kViewStrideBytes);
constexpr std::size_t kCommandsBytes = shared::BOX_COMMANDS * sizeof(shared::BoxCommand);

int layoutNumber(ShadowLayout layout) {
  return layout == ShadowLayout::Cascades ? shared::SHADOW_LAYOUT_CASCADES
         : layout == ShadowLayout::Spot   ? shared::SHADOW_LAYOUT_SPOT
                                          : shared::SHADOW_LAYOUT_CUBE;
}

shared::ShadowMapLayer layerOf(const ShadowView& view) {
  const glm::dmat4 clip = clipFromEye(view.view);
  shared::ShadowMapLayer layer{};
  layer.clipFromEye = glm::mat4(clip);
  layer.eyeFromClip = glm::mat4(glm::inverse(clip));
  layer.eyeWorld = glm::vec4(view.view.eyeWorld, view.texelSpan);
  layer.depth = {view.view.nearDistance, view.farDistance, view.view.orthographic ? 1 : 0, view.holdsScene ? 1 : 0};
  return layer;
}

} // namespace

ShadowMaps::ShadowMaps(const ShadowMapSettings& settings, bool hasRanges)
    : settings_(settings),
      hasRanges_(hasRanges),
      viewParams_("shadow_map_views", kViewStrideBytes * shared::MOST_SHADOW_LAYERS),
      mapParams_("shadow_map_params", sizeof(shared::ShadowMapParams)),
      keptCommands_("shadow_map_commands", kCommandsBytes * shared::MOST_SHADOW_LAYERS) {}

void ShadowMaps::prepare(const std::vector<PosedLight>& lights, const View& camera, const Box& boundsWorld,
                         const shared::FrameParams& frame, std::uint32_t sdfInstances, const MeshDraws& casters) {
  const Box bounds = boundsWorld.isEmpty() ? Box{glm::vec3(-1), glm::vec3(1)} : boundsWorld;
  params_ = {};
  views_.clear();
  casters_.clear();
  for (std::size_t i = 0; i < std::min<std::size_t>(lights.size(), shared::MOST_SHADOWED_LIGHTS); ++i) {
    const std::vector<ShadowView> views = makeShadowViews(lights[i], camera, bounds, settings_.size);
    params_.lights[i].layers = {layerCount(), static_cast<int>(views.size()),
                                layoutNumber(shadowLayoutOf(lights[i].light)), 0};
    views_.insert(views_.end(), views.begin(), views.end());
  }
  const int levels = std::bit_width(static_cast<unsigned>(settings_.size) / 2u);
  params_.size = {settings_.size, layerCount(), levels, 0};
  for (int layer = 0; layer < layerCount(); ++layer) {
    const ShadowView& view = views_[static_cast<std::size_t>(layer)];
    params_.layers[layer] = layerOf(view);
    casters_.push_back(visibleDraws(casters, view.view));
    shared::FrameParams params = frame;
    setViewParams(params, view.view);
    viewParams_.upload(kViewStrideBytes * static_cast<std::size_t>(layer), std::vector{params});
  }
  mapParams_.uploadValue(params_);
  visible_.fit(std::max(1u, sdfInstances));
  fitLayers();
}

std::uint32_t ShadowMaps::drawCount() const {
  std::uint32_t sum = 0;
  for (const std::vector<DrawRun>& runs : casters_)
    for (const DrawRun& run : runs) sum += run.drawCount;
  return sum;
}

void ShadowMaps::keepCommands(int layer) const {
  glCopyNamedBufferSubData(visible_.commands().id(), keptCommands_.id(), 0,
                           static_cast<GLintptr>(kCommandsBytes * static_cast<std::size_t>(layer)), kCommandsBytes);
}

std::uint32_t ShadowMaps::boxCount() const {
  const std::vector<shared::BoxCommand> commands = keptCommands_.read<shared::BoxCommand>();
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < shared::BOX_COMMANDS * views_.size(); ++i) sum += commands[i].instances;
  return sum;
}

void ShadowMaps::fitLayers() {
  const int size = settings_.size, layers = layerCount();
  if (layers == 0 || (depths_ && depths_.depth() >= layers)) return;
  framebuffers_.clear();
  depths_ = Texture();
  depths_ = Texture::make2DArray("shadow_map", GL_DEPTH_COMPONENT32F, size, size, layers);
  for (int layer = 0; layer < layers; ++layer)
    framebuffers_.push_back(Framebuffer("shadow_map", {{GL_DEPTH_ATTACHMENT, &depths_, 0, layer}}));
  if (hasRanges_) {
    ranges_ = Texture();
    ranges_ = Texture::make2DArray("shadow_range", GL_RG32F, size / 2, size, layers);
    return;
  }
  if (settings_.filter != ShadowFilter::Evsm) return;
  moments_ = Texture();
  moments_ = Texture::make2DArray("shadow_moments", GL_RGBA32F, size, size, layers);
  if (!alongX_) alongX_ = Texture::make2DArray("shadow_moments_blurred_along_x", GL_RGBA32F, size, size, 1);
}

// Below a level lie all larger ones, whose rows add up to no more than this.
glm::ivec2 ShadowMaps::rangeBox(int level) const {
  return {settings_.size - (settings_.size >> level), settings_.size >> (level + 1)};
}

void ShadowMaps::bindView(int layer) const {
  viewParams_.bindUniform(shared::kFrameUniformBinding, kViewStrideBytes * static_cast<std::size_t>(layer),
                          sizeof(shared::FrameParams));
}

void ShadowMaps::bind() const {
  mapParams_.bindUniform(shared::kShadowMapUniformBinding);
  if (depths_) depths_.bind(shared::kShadowMapUnit);
  if (moments_) moments_.bind(shared::kShadowMomentsUnit);
  if (ranges_) ranges_.bind(shared::kShadowRangeUnit);
}

std::size_t ShadowMaps::bytes() const {
  std::size_t sum = viewParams_.bytes() + mapParams_.bytes() + keptCommands_.bytes();
  for (const Texture* texture : {&depths_, &moments_, &alongX_, &ranges_})
    if (*texture) sum += texture->bytes();
  return sum;
}

} // namespace brickfield
