// Flooding within bricks; the walk across them is in the header.
#include "bakers/patch_graph.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "bakers/sample_links.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
BrickPatches patchesOf(const float* distances) {
  const SampleLinks links(distances);
  BrickPatches patches;
  SampleRows left = allSamples();
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
