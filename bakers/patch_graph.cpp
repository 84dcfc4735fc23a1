// Flooding within bricks; the walk across them is in the header.
#include "bakers/patch_graph.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr float kSegmentSlackVoxels = 1e-4f; // over the rounding of distances to float

struct NeighbourStep {
  glm::ivec3 step;
  float length;
};

/// The 13 neighbours that come later in scan order.
std::vector<NeighbourStep> laterNeighbours() {
  std::vector<NeighbourStep> steps;
  for (int z = 0; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if (z > 0 || y > 0 || (y == 0 && x > 0))
          steps.push_back({{x, y, z}, std::sqrt(static_cast<float>(x * x + y * y + z * z))});
  return steps;
}

BrickPatches patchesOf(const float* distances) {
  static const std::vector<NeighbourStep> kSteps = laterNeighbours();
  DisjointSets sets(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const glm::ivec3 sample = sampleOfIndex(i);
    for (const NeighbourStep& neighbour : kSteps) {
      const glm::ivec3 other = sample + neighbour.step;
      if (glm::any(glm::lessThan(other, glm::ivec3(0))) ||
          glm::any(glm::greaterThanEqual(other, glm::ivec3(kBrickSamples))))
        continue;
      const std::size_t j = sampleIndex(other);
      if (distances[i] + distances[j] > neighbour.length + kSegmentSlackVoxels)
        sets.unite(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
    }
  }
  BrickPatches patches;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    const std::uint32_t root = sets.rootOf(i); // the smallest sample: met before the others
    if (root == i) {
      patches.patchOfSample[i] = static_cast<std::uint16_t>(patches.deepest.size());
      patches.deepest.push_back(static_cast<std::uint16_t>(i));
      continue;
    }
    patches.patchOfSample[i] = patches.patchOfSample[root];
    std::uint16_t& deepest = patches.deepest[patches.patchOfSample[i]];
    if (distances[i] > distances[deepest]) deepest = static_cast<std::uint16_t>(i);
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
