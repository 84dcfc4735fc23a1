// Flooding within bricks; the walk across them is in the header.
#include "bakers/patch_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "bakers/each_uneven.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr float kAloneVoxels = 0.3f;      // patches that come farther off the surface have neighbours, or are pockets
constexpr double kOffVoxels = 0.25;       // from a sample to the place that is looked at
constexpr double kMostLookVoxels = 0.5;   // a larger ball is seldom empty
constexpr double kLookSlackVoxels = 1e-5; // over the rounding of distances in voxels to float

/// Joins the patches of a brick that a look at one place each tells to be parts of others.
class PatchJoiner {
public:
  PatchJoiner(const LevelSamples& level, const MeshDistance& solid, std::size_t b, std::vector<SampleMask>& patches)
      : level_(level),
        solid_(solid),
        brick_(level.grid.brickOfCell(level.cellOfBrick[b])),
        distances_(&level.solidDistances[b * kSamples]),
        patches_(patches) {}

  void run() {
    if (patches_.size() < 2) return;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      if (reachesOff(patches_[i])) continue;
      const std::size_t sample = deepestOf(patches_[i], distances_);
      const std::size_t neighbour = findNeighbour(sample, patches_[i]);
      if (neighbour == kSamples) continue;
      const auto holder = std::find_if(patches_.begin(), patches_.end(),
                                       [&](const SampleMask& patch) { return isIn(patch, neighbour); });
      for (std::size_t z = 0; z < holder->size(); ++z) (*holder)[z] |= patches_[i][z];
      patches_[i].fill(0);
    }
    const auto isEmpty = [](const SampleMask& patch) { return patch == SampleMask{}; };
    patches_.erase(std::remove_if(patches_.begin(), patches_.end(), isEmpty), patches_.end());
  }

private:
  bool reachesOff(const SampleMask& patch) const {
    for (std::size_t z = 0; z < patch.size(); ++z)
      for (std::uint64_t rest = patch[z]; rest != 0; rest &= rest - 1)
        if (distances_[64 * z + static_cast<std::size_t>(std::countr_zero(rest))] > kAloneVoxels) return true;
    return false;
  }
  /// A sample of another patch without a triangle between; kSamples: none is known.
  std::size_t findNeighbour(std::size_t sample, const SampleMask& own) const {
    const glm::dvec3 point = level_.grid.sample(brick_, sampleOfIndex(sample));
    const double voxel = level_.grid.voxelSize;
    const double known = (static_cast<double>(distances_[sample]) + kLookSlackVoxels) * voxel;
    const std::uint32_t triangle = solid_.nearest(point, known).triangle;
    if (triangle == kNoTriangle) return kSamples;
    const glm::dvec3 on = closestPointOnTriangle(point, solid_.hierarchy().soup().corners(triangle)).point;
    const double away = glm::length(point - on);
    if (!(away > 0)) return kSamples;
    const glm::dvec3 toPlace = kOffVoxels / away * (point - on); // voxels
    // A larger ball holds what is closest.
    const double most = std::min(kMostLookVoxels, kOffVoxels + static_cast<double>(distances_[sample]));
    const auto [neighbour, gap] = nearestBall(sample, toPlace, own, most);
    const double radius = std::max({kOffVoxels - static_cast<double>(distances_[sample]), gap, 0.0}) + kLookSlackVoxels;
    if (neighbour == kSamples || radius > most) return kSamples;
    const bool isClear = solid_.nearest(point + voxel * toPlace, radius * voxel).triangle == kNoTriangle;
    return isClear ? neighbour : kSamples;
  }

  struct Ball {
    std::size_t sample = kSamples;
    double gap = std::numeric_limits<double>::infinity(); ///< voxels from a place to it; negative inside
  };
  /// Of the balls around a sample's neighbours in other patches the one that comes nearest to a place, as near as most.
  Ball nearestBall(std::size_t sample, glm::dvec3 toPlace, const SampleMask& own, double most) const {
    // Neighbours are 1 or more away, and the place is kOffVoxels nearer at the most.
    const auto least = static_cast<float>(1 - kOffVoxels - most);
    const glm::ivec3 from = sampleOfIndex(sample);
    const glm::ivec3 low = glm::max(from - 1, 0), high = glm::min(from + 1, kBrickSamples - 1);
    Ball nearest;
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::size_t i = sampleIndex({x, y, z});
          if (!(distances_[i] > 0) || distances_[i] < least || isIn(own, i)) continue;
          const double gap =
              glm::length(toPlace - glm::dvec3(glm::ivec3(x, y, z) - from)) - static_cast<double>(distances_[i]);
          if (gap < nearest.gap) nearest = {i, gap};
        }
    return nearest;
  }

  const LevelSamples& level_;
  const MeshDistance& solid_;
  glm::ivec3 brick_;
  const float* distances_;
  std::vector<SampleMask>& patches_;
};

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

PatchGraph::PatchGraph(const LevelSamples& level, const MeshDistance& solid)
    : level_(&level), first_(level.brickCount() + 1), place_(level.brickCount()) {
  // Faces along the grid make a patch of each of their samples: masks are stored once, at once.
  forEachUneven(level.brickCount(), 4, [&](std::size_t b) {
    std::vector<SampleMask> patches = patchesOf(&level.solidDistances[b * kSamples]);
    PatchJoiner(level, solid, b, patches).run();
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
