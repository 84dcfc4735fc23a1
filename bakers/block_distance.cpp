// Frames of a brick's triangles; what is done with them stands in block_distance.inl.
#include "bakers/block_distance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bakers/float4.h"
#include "bakers/mesh_topology.h"
#include "bakers/simd_level.h"
#include "field/brick_layout.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

constexpr float kHalfDiagonal = 0.8660254f; // of a cube
constexpr float kHalfBrick = 0.5f * static_cast<float>(kBrickCells);
constexpr float kPickSlackVoxels = 1e-3f; // over the rounding of distances up to some tens of voxels

/// A triangle in voxels around the brick's centre.
struct BlockFrame {
  struct Edge {
    std::array<float, 3> along, inward; ///< unit; along the edge, and away from it in the plane
    float alongOffset, inwardOffset;    ///< of the anchor, from the brick's centre
    float from, to;                     ///< ends, from the anchor
  };
  std::array<float, 3> normal;
  float height; ///< of the plane over the brick's centre
  std::array<Edge, 3> edges;
};

using Frames = std::array<BlockFrame, kMostBlockTriangles + 3>; // the last four are made together

/// Places in the frames, for each of eight centres.
struct EightPicks {
  std::array<std::array<std::uint16_t, kMostBlockTriangles>, 8> places;
  std::array<std::size_t, 8> counts{};

  std::span<const std::uint16_t> of(std::size_t center) const {
    return std::span(places[center]).first(counts[center]);
  }
};

namespace portable {
#include "bakers/block_distance.inl"
}
#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2")
#define BRICKFIELD_AVX // g++ 12 lets the pragma define no macro
namespace avx2 {
#include "bakers/block_distance.inl"
}
#undef BRICKFIELD_AVX
#pragma GCC pop_options
#endif

} // namespace

void blockDistances(const BlockRequest& request, std::span<float, kBrickSampleCount> distances,
                    std::span<std::uint32_t, kBrickSampleCount> nearest) {
  Frames frames;
#if defined(__x86_64__)
  if (activeSimd() == SimdLevel::Avx2) {
    avx2::measureBlock(request, frames.data(), distances.data(), nearest.data());
    return;
  }
#endif
  portable::measureBlock(request, frames.data(), distances.data(), nearest.data());
}

} // namespace brickfield
