// A picture on the CPU as the commands pass it around.
#pragma once

#include <vector>

#include "core/math.h"

namespace brickfield {

/// Rows from the top, size.x * size.y pixels. Whether the values are linear radiance or display values says who made
/// it.
struct RgbImage {
  glm::uvec2 size{0};
  std::vector<glm::vec3> pixels;

  const glm::vec3& at(std::uint32_t x, std::uint32_t y) const { return pixels[std::size_t{y} * size.x + x]; }
};

inline constexpr std::uint32_t kLargestImageSide = 16384; ///< pixels; of files read and images made
/// Of images made: 8K; a frame holds about 150 bytes a pixel, so this many take 5 GiB.
inline constexpr std::uint64_t kLargestImagePixels = std::uint64_t{1} << 25;

} // namespace brickfield
