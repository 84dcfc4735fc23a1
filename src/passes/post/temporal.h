// What temporal antialiasing keeps beside a frame: motion vectors, and the picture and depths of the frame before.
#pragma once

#include <array>

#include "gpu/framebuffer.h"
#include "gpu/texture.h"
#include "passes/frame_targets.h"
#include "resident/motion_table.h"

namespace brickfield {

struct TaaSettings {
  bool on = false;
  float sharpness = 0; ///< 0 to 1: how much of a pixel's difference from its neighbours is added to it
  float shutter = 0;   ///< 0 to 1: share of the time between two frames over which what moves is smeared

  bool operator==(const TaaSettings&) const = default;
};

/// Where in its pixel a frame samples, pixels from the centre in [-0.5, 0.5): 64 points of Halton's sequence (1960)
/// with bases 2 and 3, again and again.
glm::vec2 taaJitter(std::uint32_t frame);

struct Temporal {
  explicit Temporal(const FrameTargets& targets);

  const Texture& now() const { return history[frame % 2]; }
  const Texture& before() const { return history[(frame + 1) % 2]; }
  const Texture& depthNow() const { return historyDepth[frame % 2]; }
  const Texture& depthBefore() const { return historyDepth[(frame + 1) % 2]; }
  std::size_t bytes() const;

  Texture motion;                      ///< RGBA16F: pixels from where it was, depth there over depth here
  Framebuffer gbuffer;                 ///< the G-buffer's layers and motion behind them
  std::array<Texture, 2> history;      ///< RGBA16F: radiance, frames in it
  std::array<Texture, 2> historyDepth; ///< R32F: lib/motion.glsl viewDepth
  MotionTable table;
  std::uint32_t frame = 0;
  bool hasHistory = false;
  float sharpness = 0, shutter = 0; ///< of this frame
};

} // namespace brickfield
