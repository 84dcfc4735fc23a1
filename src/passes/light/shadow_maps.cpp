// A frame's parameters a layer in one uniform buffer, bound by ranges.
#include "passes/light/shadow_maps.h"

#include <algorithm>

#include "passes/view_params.h"
#include "shared/bindings.h"

namespace brickfield {

namespace {

// A multiple of every alignment of uniform ranges that OpenGL allows a driver to ask for (256 at most).
constexpr std::size_t kViewStrideBytes = 1024;
static_assert(sizeof(shared::FrameParams) <= kViewStrideBytes);

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
  layer.depth = {view.view.nearDistance, view.farDistance, view.view.orthographic ? 1 : 0, 0};
  return layer;
}

} // namespace

ShadowMaps::ShadowMaps(const ShadowMapSettings& settings)
    : settings_(settings),
      viewParams_("shadow_map_views", kViewStrideBytes * shared::MOST_SHADOW_LAYERS),
      mapParams_("shadow_map_params", sizeof(shared::ShadowMapParams)) {}

void ShadowMaps::prepare(const std::vector<PosedLight>& lights, const View& camera, const Box& boundsWorld,
                         const shared::FrameParams& frame, std::uint32_t sdfInstances) {
  const Box bounds = boundsWorld.isEmpty() ? Box{glm::vec3(-1), glm::vec3(1)} : boundsWorld;
  params_ = {};
  views_.clear();
  for (std::size_t i = 0; i < std::min<std::size_t>(lights.size(), shared::MOST_SHADOWED_LIGHTS); ++i) {
    const std::vector<ShadowView> views = makeShadowViews(lights[i], camera, bounds, settings_.size);
    params_.lights[i].layers = {layerCount(), static_cast<int>(views.size()),
                                layoutNumber(shadowLayoutOf(lights[i].light)), 0};
    views_.insert(views_.end(), views.begin(), views.end());
  }
  params_.size = {settings_.size, layerCount(), 0, 0};
  for (int layer = 0; layer < layerCount(); ++layer) {
    const ShadowView& view = views_[static_cast<std::size_t>(layer)];
    params_.layers[layer] = layerOf(view);
    shared::FrameParams params = frame;
    setViewParams(params, view.view);
    viewParams_.upload(kViewStrideBytes * static_cast<std::size_t>(layer), std::vector{params});
  }
  mapParams_.uploadValue(params_);
  visible_.fit(std::max(1u, sdfInstances));
  fitLayers();
}

void ShadowMaps::fitLayers() {
  const int size = settings_.size, layers = layerCount();
  if (layers == 0 || (depths_ && depths_.depth() >= layers)) return;
  framebuffers_.clear();
  depths_ = Texture();
  depths_ = Texture::make2DArray("shadow_map", GL_DEPTH_COMPONENT32F, size, size, layers);
  for (int layer = 0; layer < layers; ++layer)
    framebuffers_.push_back(Framebuffer("shadow_map", {{GL_DEPTH_ATTACHMENT, &depths_, 0, layer}}));
  if (settings_.filter != ShadowFilter::Evsm) return;
  moments_ = Texture();
  moments_ = Texture::make2DArray("shadow_moments", GL_RGBA32F, size, size, layers);
  if (!alongX_) alongX_ = Texture::make2DArray("shadow_moments_blurred_along_x", GL_RGBA32F, size, size, 1);
}

void ShadowMaps::bindView(int layer) const {
  viewParams_.bindUniform(shared::kFrameUniformBinding, kViewStrideBytes * static_cast<std::size_t>(layer),
                          sizeof(shared::FrameParams));
}

void ShadowMaps::bind() const {
  mapParams_.bindUniform(shared::kShadowMapUniformBinding);
  if (depths_) depths_.bind(shared::kShadowMapUnit);
  if (moments_) moments_.bind(shared::kShadowMomentsUnit);
}

std::size_t ShadowMaps::bytes() const {
  std::size_t sum = viewParams_.bytes() + mapParams_.bytes();
  for (const Texture* texture : {&depths_, &moments_, &alongX_})
    if (*texture) sum += texture->bytes();
  return sum;
}

} // namespace brickfield
