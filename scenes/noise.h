// Repeatable noise: hashes of integers, not a random device, so that the same call gives the same bytes everywhere.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace brickfield::scenes {

/// Mixes all bits (the finalizer of SplitMix64, Steele et al. 2014).
inline std::uint64_t mixBits(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

/// Uniform in [0,1) for a cell of an integer grid.
inline float cellNoise(int x, int y, std::uint32_t seed) {
  std::uint64_t key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) | static_cast<std::uint32_t>(y);
  return static_cast<float>(mixBits(mixBits(key) ^ seed) >> 40) * 0x1p-24f;
}

/// Smooth noise in [0,1), repeating after `period` cells along each axis.
inline float valueNoise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed) {
  glm::vec2 cell = glm::floor(p);
  glm::vec2 t = p - cell;
  t = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
  auto at = [&](int dx, int dy) {
    int x = (static_cast<int>(cell.x) + dx) % period.x;
    int y = (static_cast<int>(cell.y) + dy) % period.y;
    return cellNoise(x < 0 ? x + period.x : x, y < 0 ? y + period.y : y, seed);
  };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), t.x), glm::mix(at(0, 1), at(1, 1), t.x), t.y);
}

/// A run of uniform numbers.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(mixBits(seed)) {}
  std::uint64_t bits() { return mixBits(state_++); }
  /// In [0,1).
  float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }

private:
  std::uint64_t state_;
};

} // namespace brickfield::scenes
