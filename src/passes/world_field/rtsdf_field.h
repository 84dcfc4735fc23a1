// What the RTSDF passes work on: the coarse seeds and distances, what is kept of the fine field from frame to frame,
// and the volume that other passes read. One window that covers the scene.
//
//   seeds (two halves) -> coarse distance -> shortest distance, votes (kept) -> field = signed - bias
//
// Values are in texels of the field. Coarse ones are at centres of coarse texels, which share the field's box. The
// published method thickens the field by its bias; here what is kept has none of it and the volume has it subtracted,
// so that every reader of a field reads this one in the same way and the recursion of equation 1 adds it only once.
#pragma once

#include <vector>

#include "core/math.h"
#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "passes/world_field/rtsdf_settings.h"
#include "shared/world_field_params.h"

namespace brickfield {

class RtsdfField {
public:
  /// error BadInput from checkRtsdfSettings, or a size that the driver's shaders cannot reach; Failure: no memory for
  /// it
  explicit RtsdfField(const RtsdfSettings& settings);

  /// Lays the window around the scene: centred, with two texels of margin or more on every side. A window that differs
  /// from the last one, and the first, forget what was kept.
  ///
  /// boundsAnchored  metres from the anchor; an empty or a flat box gets texels of some size
  void place(const Box& boundsAnchored);
  /// Forgets what was kept: the next frame is the first.
  void restart() { frame_ = 0; }
  void finishFrame() { ++frame_; }

  const RtsdfSettings& settings() const { return settings_; }
  glm::ivec3 extent() const { return extent_; }
  /// The volume's texel for a texel of the window is their lattice place modulo the extent. window.w is the longest
  /// side: the only one, but for the brute force.
  const shared::FieldCascade& cascade() const { return cascade_; }
  glm::vec3 originAnchored() const { return glm::vec3(cascade_.window) * cascade_.texel.x; }
  std::uint32_t frame() const { return frame_; } ///< finished since the last restart
  /// Of a length of the settings: the longest side is 2.
  float texelsOf(float length) const { return 0.5f * length * static_cast<float>(cascade_.window.w); }

  const Buffer& seeds(int half) const { return seeds_[half]; }
  const Buffer& largeTriangles() const { return largeTriangles_; }
  const Texture& coarse() const { return coarse_; }
  const Buffer& shortest() const { return shortest_; }
  const Buffer& votes() const { return votes_; }
  const Texture& volume() const { return volume_; } ///< R16F, repeats
  std::size_t bytes() const;

  /// Room for one number a triangle.
  void reserveTriangles(std::uint32_t count);

  /// The field without its bias, at full precision, in the window's order (x fastest); waits for the GPU. Call
  /// glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT) before.
  std::vector<float> readDistances() const;

private:
  RtsdfSettings settings_;
  glm::ivec3 extent_;
  shared::FieldCascade cascade_{};
  std::uint32_t frame_ = 0;
  Buffer seeds_[2], largeTriangles_, shortest_, votes_;
  Texture coarse_, volume_;
};

} // namespace brickfield
