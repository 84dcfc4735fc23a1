// Which samples of a brick are known to have no triangle between them: p and q with d(p) + d(q) > |p - q|, as the balls
// around them hold the segment. Among 26 neighbours: along the diagonal nearest to its normal a surface is left
// fastest.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "field/brick_field.h"

namespace brickfield {

/// A bit a sample of a brick: slice z, bit x + 8 y.
using SampleMask = std::array<std::uint64_t, kBrickSamples>;

inline bool isIn(const SampleMask& mask, std::size_t sample) { return mask[sample / 64] >> (sample % 64) & 1; }

/// Calls visit(sample) for those of a mask, ascending.
template <typename Visit>
void forEachSample(const SampleMask& mask, const Visit& visit) {
  for (std::size_t z = 0; z < mask.size(); ++z)
    for (std::uint64_t rest = mask[z]; rest != 0; rest &= rest - 1)
      visit(64 * z + static_cast<std::size_t>(std::countr_zero(rest)));
}

/// Not those that a triangle goes through, or within 5e-6 voxels of: they have no side, and no neighbour can be told to
/// lie on theirs.
SampleMask samplesOffSurface(const float* distances);
/// Samples with values below a limit.
SampleMask samplesBelow(const float* values, float limit);

inline SampleMask allSamplesMask() {
  SampleMask mask;
  mask.fill(~std::uint64_t{0});
  return mask;
}

/// Whether all are so far from triangles that each is linked to its neighbours.
bool areAllLinked(const float* distances);

/// Of some samples of a brick that with the largest distance, of several the first.
std::size_t deepestOf(const SampleMask& samples, const float* distances);

/// Links to the neighbours that come later in scan order.
class SampleLinks {
public:
  /// distances  512, unsigned, in voxels
  explicit SampleLinks(const float* distances);

  /// Takes out the links that cross what hangs from an edge down along z without end, and some that almost do.
  ///
  /// from, to  voxels from the brick's first sample
  void cutBelow(glm::vec3 from, glm::vec3 to);
  /// Floods from a sample over those that are left, and takes them out of `left`.
  ///
  /// returns  what was reached, the sample among it
  SampleMask flood(std::size_t from, SampleMask& left) const;

private:
  struct Step {
    int x, y, z;
    float length;
  };
  static constexpr float kDiagonal = 1.41421356f, kSpaceDiagonal = 1.73205081f;
  static constexpr std::size_t kStepsWithinSlice = 4;
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

  template <std::size_t kStep>
  static std::uint64_t ahead(std::uint64_t bits);
  template <std::size_t kStep>
  static std::uint64_t behind(std::uint64_t bits);
  struct Crossing;
  void cutCrossing(const Crossing& crossing);
  std::uint64_t grownWithin(std::size_t z, std::uint64_t front) const;
  std::uint64_t grownUp(std::size_t z, std::uint64_t bits) const;
  std::uint64_t grownDown(std::size_t z, std::uint64_t bits) const;

  std::array<SampleMask, kLaterNeighbours.size()> links_; ///< a step: samples that it links to the next
};

} // namespace brickfield
