// Which samples of a brick are known to have no triangle between them: p and q with d(p) + d(q) > |p - q|, as the balls
// around them hold the segment. Among 26 neighbours: along the diagonal nearest to its normal a surface is left
// fastest.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "bakers/brick_sampler.h"

namespace brickfield {

/// Links to the neighbours that come later in scan order: a row of bits a step.
class SampleLinks {
public:
  /// distances  512, unsigned, in voxels
  explicit SampleLinks(const float* distances);

  /// Floods from one sample over those that are left: takes them out of `left`, calls visit(sample) for each.
  template <typename Visit>
  void flood(std::size_t from, SampleRows& left, const Visit& visit) const;

private:
  struct Step {
    int x, y, z;
    float length;
  };
  static constexpr int kRows = kBrickSamples * kBrickSamples; // along x, row y + 8 z
  static constexpr float kDiagonal = 1.41421356f, kSpaceDiagonal = 1.73205081f;
  static constexpr std::array<Step, 13> kLaterNeighbours = {{
      {1, 0, 0, 1.0f},
      {-1, 1, 0, kDiagonal},
      {0, 1, 0, 1.0f},
      {1, 1, 0, kDiagonal},
      {-1, -1, 1, kSpaceDiagonal},
      {0, -1, 1, kDiagonal},
      {1, -1, 1, kSpaceDiagonal},
      {-1, 0, 1, kDiagonal},
      {0, 0, 1, 1.0f},
      {1, 0, 1, kDiagonal},
      {-1, 1, 1, kSpaceDiagonal},
      {0, 1, 1, kDiagonal},
      {1, 1, 1, kSpaceDiagonal},
  }};

  /// The row some steps from another; -1: beyond the brick.
  static int rowAt(int row, int y, int z) {
    const int toY = row % kBrickSamples + y, toZ = row / kBrickSamples + z;
    if (toY < 0 || toY >= kBrickSamples || toZ < 0 || toZ >= kBrickSamples) return -1;
    return toZ * kBrickSamples + toY;
  }
  static std::uint8_t moved(std::uint8_t bits, int x) {
    return static_cast<std::uint8_t>(x > 0 ? bits << x : bits >> -x);
  }
  std::uint8_t linkBits(const Step& step, int row) const;

  std::array<float, kBrickSampleCount + 2> padded_{};
  std::array<SampleRows, kLaterNeighbours.size()> links_;
};

template <typename Visit>
void SampleLinks::flood(std::size_t from, SampleRows& left, const Visit& visit) const {
  SampleRows added{};
  std::array<std::uint8_t, kRows> pending;
  std::size_t pendingCount = 0;
  const auto add = [&](int row, std::uint8_t bits) {
    const auto r = static_cast<std::size_t>(row);
    bits &= left[r];
    if (bits == 0) return;
    left[r] = static_cast<std::uint8_t>(left[r] & ~bits);
    if (added[r] == 0) pending[pendingCount++] = static_cast<std::uint8_t>(row);
    added[r] |= bits;
    for (unsigned rest = bits; rest != 0; rest &= rest - 1)
      visit(r * kBrickSamples + static_cast<std::size_t>(std::countr_zero(rest)));
  };
  add(static_cast<int>(from / kBrickSamples), static_cast<std::uint8_t>(1u << from % kBrickSamples));
  while (pendingCount > 0) {
    const int row = pending[--pendingCount];
    const std::uint8_t bits = std::exchange(added[static_cast<std::size_t>(row)], std::uint8_t{0});
    for (std::size_t s = 0; s < kLaterNeighbours.size(); ++s) {
      const Step& step = kLaterNeighbours[s];
      const int ahead = rowAt(row, step.y, step.z), behind = rowAt(row, -step.y, -step.z);
      if (ahead >= 0) add(ahead, moved(bits & links_[s][static_cast<std::size_t>(row)], step.x));
      if (behind >= 0) add(behind, moved(bits, -step.x) & links_[s][static_cast<std::size_t>(behind)]);
    }
  }
}

} // namespace brickfield
