// Slots fill a layer of 64x64, x fastest; uploads go by rows of slots, one box of texels each.
#include "resident/brick_pool.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "field/brick_field.h"
#include "shared/sdf_params.h"

namespace brickfield {

namespace {
constexpr int kSlotsAcross = shared::BRICK_POOL_SIDE;
constexpr int kSlotsPerLayer = kSlotsAcross * kSlotsAcross;
} // namespace

BrickPool::BrickPool(std::vector<Channel> channels) : channels_(std::move(channels)) {
  // One texel stands in until there is a brick, so that the pool can always be bound.
  for (const Channel& channel : channels_) {
    textures_.push_back(Texture::make3D(channel.label, channel.format, glm::ivec3(1)));
    textures_.back().clear(glm::vec4(0));
  }
}

std::uint32_t BrickPool::allocate(std::uint32_t brickCount) { return slots_.allocate(brickCount); }

void BrickPool::fit(std::uint32_t moreBricks) {
  const int wanted = static_cast<int>(ceilDivide(slots_.end() + moreBricks, kSlotsPerLayer));
  if (wanted <= layers_) return;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  // Grown by half as much again: adding objects one by one copies each texel a bounded number of times.
  const int most = largest / kBrickSamples;
  if (wanted > most || kSlotsAcross * kBrickSamples > largest)
    throw Failure(fmt::format("{}: {} bricks are more than this device's 3D textures hold ({})", channels_[0].label,
                              slots_.end() + moreBricks, static_cast<std::int64_t>(most) * kSlotsPerLayer));
  const int layers = std::min(most, std::max(wanted, layers_ + layers_ / 2));
  const int side = kSlotsAcross * kBrickSamples;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    Texture grown = Texture::make3D(channels_[i].label, channels_[i].format, {side, side, layers * kBrickSamples});
    if (layers_ > 0)
      glCopyImageSubData(textures_[i].id(), GL_TEXTURE_3D, 0, 0, 0, 0, grown.id(), GL_TEXTURE_3D, 0, 0, 0, 0, side,
                         side, layers_ * kBrickSamples);
    textures_[i] = std::move(grown);
  }
  layers_ = layers;
}

void BrickPool::upload(std::size_t channel, std::uint32_t firstSlot, std::span<const std::byte> bricks) {
  const std::size_t texelBytes = static_cast<std::size_t>(nativeLayout(channels_[channel].format).bytesPerPixel);
  const std::size_t brickBytes = texelBytes * kBrickSampleCount;
  const std::size_t rowBytes = texelBytes * kBrickSamples; // of one brick
  std::uint32_t left = static_cast<std::uint32_t>(bricks.size() / brickBytes);
  std::vector<std::byte> box;
  for (std::uint32_t slot = firstSlot; left > 0;) {
    const std::uint32_t column = slot % kSlotsAcross;
    const std::uint32_t run = std::min(left, kSlotsAcross - column);
    box.resize(run * brickBytes);
    for (std::uint32_t brick = 0; brick < run; ++brick)
      for (std::uint32_t row = 0; row < kBrickSamples * kBrickSamples; ++row)
        std::copy_n(bricks.data() + brick * brickBytes + row * rowBytes, rowBytes,
                    box.data() + (row * run + brick) * rowBytes);
    const glm::ivec3 texel =
        glm::ivec3(column, slot / kSlotsAcross % kSlotsAcross, slot / kSlotsPerLayer) * kBrickSamples;
    textures_[channel].upload(0, texel, {static_cast<int>(run) * kBrickSamples, kBrickSamples, kBrickSamples},
                              std::span<const std::byte>(box));
    bricks = bricks.subspan(run * brickBytes);
    slot += run;
    left -= run;
  }
}

std::size_t BrickPool::bytes() const {
  std::size_t sum = 0;
  for (const Texture& texture : textures_) sum += texture.bytes();
  return sum;
}

} // namespace brickfield
