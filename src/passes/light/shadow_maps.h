// The shadow maps of a frame: their textures, the views that they are drawn from, and what the shaders know of them.
// Drawn by shadow_map_pass, filtered by shadow_moments_pass, read by map_shadow_pass.
#pragma once

#include <array>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/framebuffer.h"
#include "gpu/texture.h"
#include "passes/geometry/visible_draws.h"
#include "passes/visible_boxes.h"
#include "scene/shadow_views.h"
#include "shared/frame_params.h"
#include "shared/shadow_map_params.h"

namespace brickfield {

/// How a map's depths become a share of light: of three texels a side, or by blurred moments (15 texels a side).
enum class ShadowFilter : std::uint8_t { Pcf, Evsm };

struct ShadowMapSettings {
  ShadowFilter filter = ShadowFilter::Pcf;
  int size = 2048; ///< texels of a side, kLeastShadowTexels to 8192

  bool operator==(const ShadowMapSettings&) const = default;
};

class ShadowMaps {
public:
  /// hasRanges  in place of a filter: nearest and farthest depths over squares
  ShadowMaps(const ShadowMapSettings& settings, bool hasRanges);

  /// Lays out the views of a frame for the first MOST_SHADOWED_LIGHTS lights and makes room for their layers.
  ///
  /// boundsWorld    of all casters and receivers
  /// frame          whose counts the views' parameters take over
  /// sdfInstances   boxes that a view may hold
  /// casters        of which each view draws those that it may see
  /// error          Failure: no memory
  void prepare(const std::vector<PosedLight>& lights, const View& camera, const Box& boundsWorld,
               const shared::FrameParams& frame, std::uint32_t sdfInstances, const MeshDraws& casters);

  const ShadowMapSettings& settings() const { return settings_; }
  bool hasRanges() const { return hasRanges_; }
  int layerCount() const { return static_cast<int>(views_.size()); }
  const std::vector<ShadowView>& views() const { return views_; }
  const shared::ShadowMapParams& params() const { return params_; }
  /// Makes a layer's view the frame's, for what is drawn next.
  void bindView(int layer) const;
  const Framebuffer& framebuffer(int layer) const { return framebuffers_[static_cast<std::size_t>(layer)]; }
  const VisibleBoxes& visible() const { return visible_; }
  const std::vector<DrawRun>& casters(int layer) const { return casters_[static_cast<std::size_t>(layer)]; }
  /// Of meshes, over all layers.
  std::uint32_t drawCount() const;
  /// Keeps what the boxes' commands say of a layer, for boxCount.
  void keepCommands(int layer) const;
  /// Of SDF objects, over all layers of a frame that kept their commands.
  std::uint32_t boxCount() const;
  const Texture& depths() const { return depths_; }
  const Texture& moments() const { return moments_; }      ///< empty but for EVSM
  const Texture& blurredAlongX() const { return alongX_; } ///< the same
  /// Of squares of 2, 4, 8, ... texels a side, a level above the other as rangeBox says; empty unless asked for.
  const Texture& ranges() const { return ranges_; }
  int rangeLevels() const { return params_.size.z; }
  /// Of a level in the ranges: first row, and squares a side.
  glm::ivec2 rangeBox(int level) const;
  /// Parameters and textures for lib/shadow_map.glsl.
  void bind() const;
  std::size_t bytes() const;

private:
  void fitLayers();

  ShadowMapSettings settings_;
  bool hasRanges_;
  std::vector<ShadowView> views_;
  shared::ShadowMapParams params_{};
  Texture depths_, moments_, alongX_, ranges_;
  std::vector<Framebuffer> framebuffers_;
  std::vector<std::vector<DrawRun>> casters_; ///< a layer each
  Buffer viewParams_, mapParams_, keptCommands_;
  VisibleBoxes visible_;
};

} // namespace brickfield
