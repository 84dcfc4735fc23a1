// Links of samples beside planes.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "bakers/sample_links.h"
#include "field/brick_layout.h"

namespace brickfield::test {
namespace {

/// Into how many parts the samples of a brick fall beside a plane along the grid, so far off the samples of a slice.
std::size_t partsBeside(float offVoxels) {
  std::array<float, kBrickSampleCount> distances;
  for (int z = 0; z < kBrickSamples; ++z)
    for (int y = 0; y < kBrickSamples; ++y)
      for (int x = 0; x < kBrickSamples; ++x)
        distances[sampleIndex({x, y, z})] = std::abs(static_cast<float>(z - 3) - offVoxels);
  const SampleLinks links(distances.data());
  SampleMask left = samplesOffSurface(distances.data());
  std::size_t parts = 0;
  for (std::size_t i = 0; i < kBrickSampleCount; ++i)
    if (isIn(left, i)) links.flood(i, left), ++parts;
  return parts;
}

} // namespace

// A box whose faces are to lie on samples has them some 1e-6 voxels off: each of 64 would be asked for its side.
TEST(SampleLinks, PlanesAlongTheGridPartABrickInTwo) {
  for (const float off : {0.0f, 1e-6f, 4e-6f, 8e-6f, 2e-5f, 6e-5f, 1e-3f, 0.1f, 0.5f})
    EXPECT_EQ(partsBeside(off), 2u) << off;
}

} // namespace brickfield::test
