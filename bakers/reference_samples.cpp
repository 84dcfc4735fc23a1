// Kensler's permutation and multi-jitter on 64-bit hashes; maps from the square to disks and caps.
#include "bakers/reference_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace brickfield {

namespace {

/// Place of `index` in a random order of 0 to count - 1: a hash that is a bijection on the next power of two, walked
/// until it falls below the count (cycle walking; Kensler 2013, listing 2, does the same with other constants).
std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint64_t bits) {
  std::uint32_t mask = count - 1;
  for (int shift = 1; shift < 32; shift *= 2) mask |= mask >> shift;
  const auto low = static_cast<std::uint32_t>(bits), high = static_cast<std::uint32_t>(bits >> 32);
  const std::uint32_t halfway = std::max(1u, static_cast<std::uint32_t>(std::bit_width(mask)) / 2);
  do {
    // Each step can be undone below the mask: adding, an odd factor, a shifted exclusive or.
    index = (index + low) & mask;
    index = (index * (high | 1u)) & mask;
    index ^= index >> halfway;
    index = (index * 0x2c1b3c6du) & mask;
    index ^= index >> halfway;
    index = (index + (high >> 7)) & mask;
    index = (index * 0x297a2d39u) & mask;
    index ^= index >> halfway;
  } while (index >= count);
  // A turn by a random amount makes each place equally likely for each index, which walking alone does not.
  return static_cast<std::uint32_t>((std::uint64_t{index} + mixBits(bits) % count) % count);
}

float unitFloat(std::uint64_t bits) { return static_cast<float>(bits >> 40) / 16777216.0f; } // 24 bits: below 1

} // namespace

std::uint64_t mixBits(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

PixelSamples::PixelSamples(glm::uvec2 pixel, std::uint64_t seed, int count)
    : pixelBits_(mixBits(mixBits(seed) ^ (std::uint64_t{pixel.y} << 32 | pixel.x))), count_(std::max(count, 1)) {}

PixelSamples PixelSamples::ofMirrored() const {
  PixelSamples samples = *this;
  samples.pixelBits_ = mixBits(pixelBits_ + 1);
  return samples;
}

glm::vec2 PixelSamples::point(int index, SamplePurpose purpose, std::uint32_t number) const {
  const std::uint64_t set = mixBits(pixelBits_ ^ mixBits(static_cast<std::uint64_t>(purpose) + number));
  const auto count = static_cast<std::uint32_t>(count_);
  const auto columns = std::max(1u, static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count))));
  const std::uint32_t rows = ceilDivide(count, columns);
  const std::uint32_t place = permuted(static_cast<std::uint32_t>(index), count, mixBits(set + 1));
  const std::uint32_t column = permuted(place % columns, columns, mixBits(set + 2));
  const std::uint32_t row = permuted(place / columns, rows, mixBits(set + 3));
  const std::uint64_t jitter = mixBits(set ^ mixBits(place + 4));
  const double x = (column + (row + double{unitFloat(jitter)}) / rows) / columns;
  const double y = (place + double{unitFloat(mixBits(jitter))}) / count;
  constexpr float kLargestBelowOne = 0x1.fffffep-1f;
  return {std::min(static_cast<float>(x), kLargestBelowOne), std::min(static_cast<float>(y), kLargestBelowOne)};
}

glm::vec2 diskFromSquare(glm::vec2 square) {
  const glm::vec2 centred = 2.0f * square - 1.0f;
  if (centred == glm::vec2(0.0f)) return centred;
  constexpr float kEighthTurn = std::numbers::pi_v<float> / 4.0f;
  const bool isWide = std::abs(centred.x) > std::abs(centred.y);
  const float radius = isWide ? centred.x : centred.y;
  const float angle = isWide ? kEighthTurn * centred.y / centred.x : kEighthTurn * (2.0f - centred.x / centred.y);
  return radius * glm::vec2(std::cos(angle), std::sin(angle));
}

glm::mat3 basisAround(glm::vec3 axis) {
  const float sign = std::copysign(1.0f, axis.z);
  const float a = -1.0f / (sign + axis.z), b = axis.x * axis.y * a;
  return {glm::vec3(1.0f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
          glm::vec3(b, sign + axis.y * axis.y * a, -axis.y), axis};
}

glm::vec3 directionOfCap(const glm::mat3& basis, float oneMinusCosine, glm::vec2 square) {
  // Archimedes: the height over a sphere is uniform. With s the squared radius on the disk, 1 - cos = s (1 - cosMax).
  const glm::vec2 disk = diskFromSquare(square);
  const float height = glm::dot(disk, disk) * oneMinusCosine;
  const float sinePerRadius = std::sqrt(std::max(0.0f, oneMinusCosine * (2.0f - height)));
  return glm::normalize(basis * glm::vec3(disk * sinePerRadius, 1.0f - height));
}

glm::vec3 directionByCosine(const glm::mat3& basis, glm::vec2 square) {
  const glm::vec2 disk = diskFromSquare(square);
  return glm::normalize(basis * glm::vec3(disk, std::sqrt(std::max(0.0f, 1.0f - glm::dot(disk, disk)))));
}

} // namespace brickfield
