// Flooding within bricks; the walk across them is in the header.
#include "bakers/patch_graph.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "bakers/each_uneven.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;

std::vector<SampleMask> patchesOf(const float* distances) {
  if (areAllLinked(distances)) return {allSamplesMask()};
  const SampleLinks links(distances);
  std::vector<SampleMask> patches;
  SampleMask left = samplesOffSurface(distances);
  for (std::size_t z = 0; z < left.size(); ++z)
    while (left[z] != 0)
      patches.push_back(links.flood(64 * z + static_cast<std::size_t>(std::countr_zero(left[z])), left));
  return patches;
}

} // namespace

PatchGraph::PatchGraph(const LevelSamples& level)
    : level_(&level), first_(level.brickCount() + 1), place_(level.brickCount()) {
  // Faces along the grid make a patch of each of their samples: masks are stored once, at once.
  forEachUneven(level.brickCount(), 4, [&](std::size_t b) {
    std::vector<SampleMask> patches = patchesOf(&level.solidDistances[b * kSamples]);
    place_[b] = static_cast<std::size_t>(masks_.grow_by(patches.begin(), patches.end()) - masks_.begin());
    first_[b + 1] = static_cast<std::uint32_t>(patches.size());
  });
  first_[0] = static_cast<std::uint32_t>(level.grid.cellCount());
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

std::size_t PatchGraph::brickOf(std::uint32_t patch) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), patch) - first_.begin() - 1);
}

glm::dvec3 PatchGraph::pointOf(std::uint32_t patch) const {
  const SampleGrid& grid = level_->grid;
  if (isCell(patch)) return grid.brickCenter(grid.brickOfCell(patch));
  const std::size_t b = brickOf(patch);
  const std::size_t deepest = deepestOf(samplesOf(b, patch), &level_->solidDistances[b * kSamples]);
  return grid.sample(grid.brickOfCell(level_->cellOfBrick[b]), sampleOfIndex(deepest));
}

std::uint64_t PatchGraph::inFace(const SampleMask& mask, glm::length_t axis, bool isLast) {
  constexpr std::uint64_t kFirstColumn = 0x0101010101010101u;
  if (axis == 2) return mask[isLast ? kBrickSamples - 1 : 0];
  const int by = isLast ? kBrickSamples - 1 : 0;
  std::uint64_t face = 0;
  for (std::size_t z = 0; z < mask.size(); ++z) {
    // The product puts bit 8 i, of column x in row i, at place 56 + i.
    const std::uint64_t row = axis == 1 ? mask[z] >> (kBrickSamples * by) & 0xffu
                                        : (mask[z] >> by & kFirstColumn) * 0x0102040810204080u >> 56;
    face |= row << (8 * z);
  }
  return face;
}

} // namespace brickfield
