// The parts of space that a level's samples can be told to lie in: patches of samples without a triangle between, and
// how they meet across bricks and empty cells.
//
// Two samples p and q with d(p) + d(q) > |p - q| have no triangle between them: the balls around them hold the segment.
// So a brick falls into patches (flooded over 26 neighbours: along the diagonal nearest to its normal a surface is left
// fastest, so hardly a sample stays alone). Patches of neighbouring bricks meet in the samples that both store, and an
// empty cell is one patch that joins all of its neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bakers/disjoint_sets.h"
#include "bakers/level_sampler.h"

namespace brickfield {

/// Patches of one brick.
struct BrickPatches {
  std::array<std::uint16_t, kBrickSampleCount> patchOfSample; ///< numbered from 0 by first sample
  std::vector<std::uint16_t> deepest;                         ///< a patch: its sample farthest from the surface
};

/// All patches of a level in one numbering: first one a cell (in use by the empty ones), then those of the bricks.
class PatchGraph {
public:
  /// level  with solid distances; must outlive this
  explicit PatchGraph(const LevelSamples& level);

  const BrickPatches& brick(std::size_t b) const { return bricks_[b]; }
  std::uint32_t patchCount() const { return first_.back(); }
  std::uint32_t patchOf(std::size_t brick, std::size_t sample) const {
    return first_[brick] + bricks_[brick].patchOfSample[sample];
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

  /// Calls visit(patch, patch) for what meets across the faces between cells, once a shared sample. What meets in edges
  /// and corners follows: of the cells around an edge each shares a face with the next.
  template <typename Visit>
  void forEachMeeting(Visit visit) const;

private:
  std::size_t brickOf(std::uint32_t patch) const;
  template <typename Visit>
  void meetAcrossFace(std::size_t cell, std::size_t nextCell, glm::length_t axis, Visit visit) const;

  const LevelSamples* level_;
  std::vector<BrickPatches> bricks_;
  std::vector<std::uint32_t> first_; ///< a brick: number of its first patch
};

template <typename Visit>
void PatchGraph::forEachMeeting(Visit visit) const {
  for (std::size_t cell = 0; cell < level_->grid.cellCount(); ++cell)
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      glm::ivec3 next = level_->grid.brickOfCell(cell);
      if (++next[axis] < level_->grid.brickCounts[axis])
        meetAcrossFace(cell, level_->grid.cellOfBrick(next), axis, visit);
    }
}

template <typename Visit>
void PatchGraph::meetAcrossFace(std::size_t cell, std::size_t nextCell, glm::length_t axis, Visit visit) const {
  const std::uint32_t brick = level_->brickOfCell[cell], nextBrick = level_->brickOfCell[nextCell];
  if (brick == kNoBrick && nextBrick == kNoBrick) {
    visit(static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(nextCell));
    return;
  }
  glm::ivec3 sample;
  for (int j = 0; j < kBrickSamples; ++j)
    for (int i = 0; i < kBrickSamples; ++i) {
      sample[(axis + 1) % 3] = i, sample[(axis + 2) % 3] = j;
      sample[axis] = kBrickCells;
      const std::uint32_t here =
          brick == kNoBrick ? static_cast<std::uint32_t>(cell) : patchOf(brick, sampleIndex(sample));
      sample[axis] = 0;
      const std::uint32_t there =
          nextBrick == kNoBrick ? static_cast<std::uint32_t>(nextCell) : patchOf(nextBrick, sampleIndex(sample));
      visit(here, there);
    }
}

} // namespace brickfield
