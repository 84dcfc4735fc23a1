// Distances of all samples of a brick to the triangles around it, eight samples at a time: cheaper than a walk a sample
// where triangles are not much smaller than voxels.
//
// In floats, yet exact to 1e-6 voxel: each triangle is put into a frame of the brick, in voxels around its centre, and
// its plane and edges are anchored at their points closest to that centre, so that no large coordinate enters.
#pragma once

#include <cstdint>
#include <span>

#include "bakers/triangle_soup.h"
#include "field/brick_field.h"

namespace brickfield {

/// More triangles than that are slower than a walk a sample.
inline constexpr std::size_t kMostBlockTriangles = 512;

/// A brick's samples, sample (i, j, k) at center + voxelSize * ((i, j, k) - 3.5), in soup space.
struct SampleBlock {
  glm::dvec3 center{0.0};
  double voxelSize = 0;
};

struct BlockRequest {
  const TriangleSoup* soup = nullptr;
  std::span<const std::uint32_t>
      triangles; ///< ascending, up to kMostBlockTriangles: of two as close the first is taken
  SampleBlock block;
  std::span<const std::uint8_t, 64> rows; ///< along x, row j + 8 k: a bit a sample that is wanted
  float most = 0;                         ///< voxels; farther samples get infinity and kNoTriangle
};

/// Where a sample's foot lies inside the closest triangle by more than kClearVoxels: its height over that, in voxels,
/// counter-clockwise positive. Infinite elsewhere, and as near as that to the triangle's plane.
using BlockHeights = std::span<float, kBrickSampleCount>;
inline constexpr float kClearVoxels = 1e-4f; // above the error of a block

using BlockTriangles = std::span<std::uint32_t, kBrickSampleCount>;

/// Results are voxels and triangles of the wanted samples; others get those, too, or infinity and kNoTriangle.
///
/// nearest    if given
/// heights    if given, and then nearest, too
/// proved by  tests/bake/bakers/band_bake_test.cpp
void blockDistances(const BlockRequest& request, std::span<float, kBrickSampleCount> distances,
                    BlockTriangles* nearest = nullptr, BlockHeights* heights = nullptr);

} // namespace brickfield
