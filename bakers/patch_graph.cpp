// Flooding within bricks; the walk across them is in the header.
#include "bakers/patch_graph.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <tbb/parallel_for.h>

#include "bakers/float4.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr float kSegmentSlackVoxels = 1e-4f; // over the rounding of distances to float

/// The 13 neighbours that come later in scan order, and how far they are.
struct NeighbourStep {
  int x, y, z;
  float length;
};
constexpr float kDiagonal = 1.41421356f, kSpaceDiagonal = 1.73205081f;
constexpr std::array<NeighbourStep, 13> kLaterNeighbours = {{
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

constexpr int kRows = kBrickSamples * kBrickSamples; // along x, row y + 8 z
using RowBits = std::array<std::uint8_t, kRows>;     // a bit a sample

std::uint8_t moved(std::uint8_t bits, int x) { return static_cast<std::uint8_t>(x > 0 ? bits << x : bits >> -x); }

/// Which samples have no triangle between themselves and a later neighbour: a row of bits a step.
class BrickLinks {
public:
  explicit BrickLinks(const float* distances) {
    std::copy_n(distances, kSamples, padded_.begin() + 1);
    for (std::size_t s = 0; s < kLaterNeighbours.size(); ++s)
      for (int row = 0; row < kRows; ++row)
        links_[s][static_cast<std::size_t>(row)] = linkBits(kLaterNeighbours[s], row);
  }

  /// Floods from one sample over those that are left: takes them out of `left`, calls visit(sample) for each.
  template <typename Visit>
  void flood(std::size_t from, RowBits& left, const Visit& visit) const {
    RowBits added{};
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
        const NeighbourStep& step = kLaterNeighbours[s];
        const int ahead = rowAt(row, step.y, step.z), behind = rowAt(row, -step.y, -step.z);
        if (ahead >= 0) add(ahead, moved(bits & links_[s][static_cast<std::size_t>(row)], step.x));
        if (behind >= 0) add(behind, moved(bits, -step.x) & links_[s][static_cast<std::size_t>(behind)]);
      }
    }
  }

private:
  /// The row some steps from another; -1: beyond the brick.
  static int rowAt(int row, int y, int z) {
    const int toY = row % kBrickSamples + y, toZ = row / kBrickSamples + z;
    if (toY < 0 || toY >= kBrickSamples || toZ < 0 || toZ >= kBrickSamples) return -1;
    return toZ * kBrickSamples + toY;
  }
  std::uint8_t linkBits(const NeighbourStep& step, int row) const {
    const int other = rowAt(row, step.y, step.z);
    if (other < 0) return 0;
    const Float4 reach = broadcast(step.length + kSegmentSlackVoxels);
    unsigned bits = 0;
    for (int half = 0; half < 2; ++half) {
      Float4 here, there;
      std::memcpy(&here, &padded_[static_cast<std::size_t>(1 + row * kBrickSamples + 4 * half)], sizeof(here));
      std::memcpy(&there, &padded_[static_cast<std::size_t>(1 + other * kBrickSamples + 4 * half + step.x)],
                  sizeof(there));
      const auto isLinked = here + there > reach;
      for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(isLinked[i] & 1) << (4 * half + i);
    }
    const unsigned inside = step.x > 0 ? 0x7fu : step.x < 0 ? 0xfeu : 0xffu; // the neighbour lies in its row
    return static_cast<std::uint8_t>(bits & inside);
  }

  std::array<float, kSamples + 2> padded_{};
  std::array<RowBits, kLaterNeighbours.size()> links_;
};

BrickPatches patchesOf(const float* distances) {
  const BrickLinks links(distances);
  BrickPatches patches;
  RowBits left;
  left.fill(0xff);
  for (std::size_t i = 0; i < kSamples; ++i) {
    if (!(left[i / kBrickSamples] >> i % kBrickSamples & 1)) continue;
    const auto number = static_cast<std::uint16_t>(patches.deepest.size());
    std::size_t deepest = i; // of several as deep the first
    links.flood(i, left, [&](std::size_t sample) {
      patches.patchOfSample[sample] = number;
      if (distances[sample] > distances[deepest] || (distances[sample] == distances[deepest] && sample < deepest))
        deepest = sample;
    });
    patches.deepest.push_back(static_cast<std::uint16_t>(deepest));
  }
  return patches;
}

} // namespace

PatchGraph::PatchGraph(const LevelSamples& level)
    : level_(&level), bricks_(level.brickCount()), first_(level.brickCount() + 1) {
  tbb::parallel_for(std::size_t{0}, bricks_.size(),
                    [&](std::size_t b) { bricks_[b] = patchesOf(&level.solidDistances[b * kSamples]); });
  first_[0] = static_cast<std::uint32_t>(level.grid.cellCount());
  for (std::size_t b = 0; b < bricks_.size(); ++b)
    first_[b + 1] = first_[b] + static_cast<std::uint32_t>(bricks_[b].deepest.size());
}

std::size_t PatchGraph::brickOf(std::uint32_t patch) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), patch) - first_.begin() - 1);
}

glm::dvec3 PatchGraph::pointOf(std::uint32_t patch) const {
  const SampleGrid& grid = level_->grid;
  if (isCell(patch)) return grid.brickCenter(grid.brickOfCell(patch));
  const std::size_t b = brickOf(patch);
  return grid.sample(grid.brickOfCell(level_->cellOfBrick[b]), sampleOfIndex(bricks_[b].deepest[patch - first_[b]]));
}

} // namespace brickfield
