// Signs of the samples of one cell by as few inside tests as prove them all: one for each group of samples that can be
// joined within a cube where the answer is steady; cubes where it is not are split, down to single samples.
#pragma once

#include <array>

#include "bakers/inside_test.h"
#include "bakers/level_sampler.h"

namespace brickfield {

using SampleSigns = std::array<std::uint8_t, kBrickSampleCount>;

/// distances  512 unsigned ones of the cell's brick, in voxels; nothing: no triangle comes into the cell
/// returns    1 where inside
/// proved by  tests/bake/bakers/rims_test.cpp
SampleSigns askSamples(const SampleGrid& grid, glm::ivec3 cell, const InsideTest& test, const float* distances);

/// A cube of samples, as many along each side.
struct SampleCube {
  glm::ivec3 first{0};
  int side = kBrickSamples;

  double radiusVoxels() const { return 0.8660255 * (side - 1); }
  glm::dvec3 centerVoxels() const { return glm::dvec3(first) + 0.5 * (side - 1); }
  SampleCube eighth(int number) const {
    const int half = side / 2;
    return {first + half * glm::ivec3(number & 1, number >> 1 & 1, number >> 2), half};
  }
  /// Calls visit(sample).
  template <typename Visit>
  void forEach(Visit visit) const {
    for (int z = first.z; z < first.z + side; ++z)
      for (int y = first.y; y < first.y + side; ++y)
        for (int x = first.x; x < first.x + side; ++x) visit(glm::ivec3(x, y, z));
  }
};

/// By cells: 1 where the answer is steady in the whole closed cell.
///
/// cost  a look at the rims for each, less where they are far; all threads
std::vector<std::uint8_t> findSteadyCells(const SampleGrid& grid, const InsideTest& test);

} // namespace brickfield
