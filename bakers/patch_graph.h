// The parts of space that a level's samples can be told to lie in: patches of samples without a triangle between, and
// how they meet across bricks and empty cells.
//
// Two samples p and q with d(p) + d(q) > |p - q| have no triangle between them: the balls around them hold the segment.
// So a brick falls into patches (flooded over 26 neighbours). Samples very close to a surface that lies askew stay
// alone that way; to ask each of them for its sign costs less than to find it a neighbour.
//
// Samples on the surface are in no patch. Patches of neighbouring bricks meet in the samples that both store, and an
// empty cell is one patch that joins all of its neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <tbb/concurrent_vector.h>

#include "bakers/disjoint_sets.h"
#include "bakers/level_sampler.h"
#include "bakers/sample_links.h"

namespace brickfield {

/// All patches of a level in one numbering: first one a cell (in use by the empty ones), then those of the bricks.
class PatchGraph {
public:
  /// level  with solid distances; must outlive this
  explicit PatchGraph(const LevelSamples& level);

  std::uint32_t patchCount() const { return first_.back(); }
  /// Of a brick: numbers from .. to - 1.
  std::uint32_t firstPatchOf(std::size_t brick) const { return first_[brick]; }
  std::uint32_t endPatchOf(std::size_t brick) const { return first_[brick + 1]; }
  /// Samples of a patch of a brick.
  const SampleMask& samplesOf(std::size_t brick, std::uint32_t patch) const {
    return masks_[place_[brick] + patch - first_[brick]];
  }
  bool isCell(std::uint32_t patch) const { return patch < first_.front(); }
  /// Whether a patch number is in use: a brick's cell has none of its own.
  bool exists(std::uint32_t patch) const { return !isCell(patch) || level_->brickOfCell[patch] == kNoBrick; }
  /// The cell that holds a patch.
  std::uint32_t cellOf(std::uint32_t patch) const {
    return isCell(patch) ? patch : level_->cellOfBrick[brickOf(patch)];
  }
  /// The point of a patch that is farthest from the surface, or a cell's centre.
  glm::dvec3 pointOf(std::uint32_t patch) const;

  int sliceCount() const { return level_->grid.brickCounts.z; }
  /// Calls visit(patch, patch) once for each two that meet across a face between cells, of a slice of cells with each
  /// other and with the next slice. What meets in edges and corners follows: of the cells around an edge each shares a
  /// face with the next.
  template <typename Visit>
  void forEachMeetingInSlice(int z, Visit visit) const;
  /// The same of one cell with the six beside it.
  template <typename Visit>
  void forEachMeetingOf(std::size_t cell, Visit visit) const;

private:
  static constexpr std::size_t kFaceSamples = kBrickSamples * kBrickSamples;

  std::size_t brickOf(std::uint32_t patch) const;
  /// Samples of a patch in a face of its brick: the first or the last along an axis.
  static std::uint64_t inFace(const SampleMask& mask, glm::length_t axis, bool isLast);
  template <typename Visit>
  void meetAcrossFace(std::size_t cell, std::size_t nextCell, glm::length_t axis, Visit visit) const;

  const LevelSamples* level_;
  std::vector<std::uint32_t> first_;         ///< a brick: number of its first patch
  std::vector<std::size_t> place_;           ///< a brick: where its masks begin
  tbb::concurrent_vector<SampleMask> masks_; ///< a patch of a brick; bricks in the order that they were done in
};

template <typename Visit>
void PatchGraph::forEachMeetingInSlice(int z, Visit visit) const {
  const SampleGrid& grid = level_->grid;
  const auto stride = [&](glm::length_t axis) { return grid.cellOfBrick({axis == 0, axis == 1, axis == 2}); };
  const std::array<std::size_t, 3> strides = {stride(0), stride(1), stride(2)};
  std::size_t cell = grid.cellOfBrick({0, 0, z});
  for (int y = 0; y < grid.brickCounts.y; ++y)
    for (int x = 0; x < grid.brickCounts.x; ++x, ++cell) {
      if (x + 1 < grid.brickCounts.x) meetAcrossFace(cell, cell + strides[0], 0, visit);
      if (y + 1 < grid.brickCounts.y) meetAcrossFace(cell, cell + strides[1], 1, visit);
      if (z + 1 < grid.brickCounts.z) meetAcrossFace(cell, cell + strides[2], 2, visit);
    }
}

template <typename Visit>
void PatchGraph::forEachMeetingOf(std::size_t cell, Visit visit) const {
  const SampleGrid& grid = level_->grid;
  const glm::ivec3 brick = grid.brickOfCell(cell);
  for (glm::length_t axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      glm::ivec3 beside = brick;
      beside[axis] += side;
      if (beside[axis] < 0 || beside[axis] >= grid.brickCounts[axis]) continue;
      const std::size_t next = grid.cellOfBrick(beside);
      meetAcrossFace(std::min(cell, next), std::max(cell, next), axis, visit);
    }
}

template <typename Visit>
void PatchGraph::meetAcrossFace(std::size_t cell, std::size_t nextCell, glm::length_t axis, Visit visit) const {
  const std::uint32_t brick = level_->brickOfCell[cell], nextBrick = level_->brickOfCell[nextCell];
  if (brick == kNoBrick && nextBrick == kNoBrick)
    return visit(static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(nextCell));
  const auto forEachSide = [&](std::uint32_t b, std::size_t emptyCell, bool isLast, const auto& visitSide) {
    if (b == kNoBrick) return visitSide(static_cast<std::uint32_t>(emptyCell), ~std::uint64_t{0});
    for (std::uint32_t patch = first_[b]; patch < first_[b + 1]; ++patch)
      if (const std::uint64_t samples = inFace(samplesOf(b, patch), axis, isLast); samples != 0)
        visitSide(patch, samples);
  };
  struct Side {
    std::uint32_t patch;
    std::uint64_t samples;
  };
  std::array<Side, kFaceSamples> there; // patches share no sample
  std::size_t count = 0;
  forEachSide(nextBrick, nextCell, false, [&](std::uint32_t patch, std::uint64_t samples) {
    there[count++] = {patch, samples};
  });
  forEachSide(brick, cell, true, [&](std::uint32_t here, std::uint64_t ofHere) {
    for (std::size_t i = 0; i < count; ++i)
      if (ofHere & there[i].samples) visit(here, there[i].patch);
  });
}

} // namespace brickfield
