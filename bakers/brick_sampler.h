// Unsigned (of slabs: signed) distances of one surface at the samples of one brick: by a block of SIMD lanes over few
// triangles where they are large, else by a walk a sample, each bounded by what its neighbours found.
#pragma once

#include "bakers/level_sampler.h"

namespace brickfield {

/// A bit a sample, row j + 8 k, bit i.
using SampleRows = std::array<std::uint8_t, kBrickSamples * kBrickSamples>;
inline SampleRows allSamples() {
  SampleRows rows;
  rows.fill(0xff);
  return rows;
}

/// The range plus what rounding and the encoding's half step might still want to see.
inline constexpr double kSampledRangeVoxels = kNarrowBandVoxels + 0.0625;

struct SurfaceSampler {
  const SampleGrid& grid;
  const MeshDistance& surface;
  const SheetSlabs* slabs = nullptr; ///< nothing: the distance is the triangles' own
  double halfThickness = 0;          ///< of the slabs
  bool isCapped = true;              ///< distances beyond the range need not be exact

  /// wanted     other samples are left as they are, or get anything
  /// distances  512 of the brick, in voxels; the range where beyond it and capped
  /// triangles  if given: the closest ones, or some of the brick's where beyond the range
  /// proved by  tests/bake/bakers/band_bake_test.cpp
  void run(glm::ivec3 brick, const SampleRows& wanted, float* distances, std::uint32_t* triangles) const;

private:
  double capVoxels() const;
  bool runBlock(glm::ivec3 brick, const SampleRows& wanted, float* distances, std::uint32_t* triangles) const;
  void runFar(glm::ivec3 brick, const SampleRows& wanted, float* distances, std::uint32_t* triangles) const;
  void runWalks(glm::ivec3 brick, const SampleRows& wanted, float* distances, std::uint32_t* triangles) const;
  float finish(glm::dvec3 point, NearestTriangle nearest) const;
};

} // namespace brickfield
