// 3D textures of brick slots: one allocation of numbers, one or more textures that share it. Grows by whole layers of
// slots, keeping what is there.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gpu/texture.h"
#include "resident/range_allocator.h"

namespace brickfield {

class BrickPool {
public:
  struct Channel {
    std::string label;
    GLenum format;
  };
  explicit BrickPool(std::vector<Channel> channels);

  std::uint32_t allocate(std::uint32_t brickCount);
  void release(std::uint32_t firstSlot, std::uint32_t brickCount) { slots_.release(firstSlot, brickCount); }

  /// Makes the textures large enough for every slot handed out so far, and for this many more.
  /// error Failure: larger than the device's 3D textures
  void fit(std::uint32_t moreBricks = 0);
  /// Bricks of one channel, 512 texels each, x fastest, into consecutive slots. After fit().
  void upload(std::size_t channel, std::uint32_t firstSlot, std::span<const std::byte> bricks);

  const Texture& texture(std::size_t channel) const { return textures_[channel]; }
  std::uint32_t usedSlots() const { return slots_.used(); }
  std::size_t bytes() const;

private:
  std::vector<Channel> channels_;
  std::vector<Texture> textures_;
  RangeAllocator slots_;
  int layers_ = 0;
};

} // namespace brickfield
