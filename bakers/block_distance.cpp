// Frames of a brick's triangles; what is done with them stands in block_distance.inl.
#include "bakers/block_distance.h"

#include <algorithm>
#include <bit>
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

/// What is linear in a point, of a triangle in voxels around the brick's centre: its height over the plane, then how
/// far it lies along each edge from the edge's anchor, then how far inwards of it.
constexpr std::size_t kHeight = 0, kAlong = 1, kInward = 4, kForms = 7;

/// A triangle by these forms, direction times point less offset, lane by lane.
struct BlockFrame {
  using Lanes = std::array<float, 8>;
  Lanes x, y, z; ///< of the directions, unit
  Lanes offset;
  std::array<Lanes, kForms> steps; ///< a form: what it adds at the corners of a unit cube, from the lowest on
  std::array<float, 3> from, to;   ///< an edge: its ends, from the anchor
};

using Frames = std::array<BlockFrame, kMostBlockTriangles + 3>; // the last four are made together

/// 512 of each; triangles and heights if they are asked for.
struct BlockResults {
  float* distances;
  std::uint32_t* nearest;
  float* heights;
};

/// What is told of samples besides distances.
enum class BlockTells { Distances, Triangles, Heights };

/// Places in the frames, for each of eight centres.
struct EightPicks {
  std::array<std::array<std::uint16_t, kMostBlockTriangles + 1>, 8> places; // one more is written than kept
  std::array<std::size_t, 8> counts;

  std::span<const std::uint16_t> of(std::size_t center) const {
    return std::span(places[center]).first(counts[center]);
  }
};

#define BRICKFIELD_SIMD_FILE "bakers/block_distance.inl"
#include "bakers/each_simd.inl"

} // namespace

void blockDistances(const BlockRequest& request, std::span<float, kBrickSampleCount> distances, BlockTriangles* nearest,
                    BlockHeights* heights) {
  Frames frames;
  const BlockResults results{distances.data(), nearest ? nearest->data() : nullptr,
                             heights ? heights->data() : nullptr};
  BRICKFIELD_BEST_SIMD(measureBlock(request, frames.data(), results));
}

} // namespace brickfield
