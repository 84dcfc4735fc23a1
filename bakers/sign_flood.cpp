// Two samples p and q with d(p) + d(q) > |p - q| have no triangle between them: the balls around them hold the segment.
// So bricks fall into patches (flooded over 26 neighbours: along the diagonal nearest to its normal a surface is left
// fastest, so hardly a sample stays alone), patches of neighbouring bricks meet in the samples that both store, and the
// empty cells are each one patch that joins all of its neighbours.
#include "bakers/sign_flood.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bakers/disjoint_sets.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr std::size_t kVotes = 16;           // inside tests a region; fewer where it has fewer patches
constexpr float kSegmentSlackVoxels = 1e-4f; // over the rounding of distances to float

/// Patches of one brick.
struct BrickPatches {
  std::array<std::uint16_t, kSamples> patchOfSample; ///< numbered from 0 by first sample
  std::vector<std::uint16_t> deepest;                ///< a patch: its sample farthest from the surface
};

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

glm::ivec3 sampleOf(std::size_t index) {
  const auto i = static_cast<int>(index);
  return {i % kBrickSamples, i / kBrickSamples % kBrickSamples, i / (kBrickSamples * kBrickSamples)};
}

BrickPatches patchesOf(const float* distances) {
  static const std::vector<NeighbourStep> kSteps = laterNeighbours();
  DisjointSets sets(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const glm::ivec3 sample = sampleOf(i);
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

/// All patches of a level in one numbering: first one a cell (used by the empty ones), then those of the bricks.
class PatchGraph {
public:
  explicit PatchGraph(const LevelSamples& level)
      : level_(level), bricks_(level.brickCount()), first_(level.brickCount() + 1) {
    tbb::parallel_for(std::size_t{0}, bricks_.size(),
                      [&](std::size_t b) { bricks_[b] = patchesOf(&level.solidDistances[b * kSamples]); });
    first_[0] = static_cast<std::uint32_t>(level.grid.cellCount());
    for (std::size_t b = 0; b < bricks_.size(); ++b)
      first_[b + 1] = first_[b] + static_cast<std::uint32_t>(bricks_[b].deepest.size());
  }

  const BrickPatches& brick(std::size_t b) const { return bricks_[b]; }
  std::uint32_t patchCount() const { return first_.back(); }
  std::uint32_t patchOf(std::size_t brick, std::size_t sample) const {
    return first_[brick] + bricks_[brick].patchOfSample[sample];
  }
  bool isCell(std::uint32_t patch) const { return patch < first_.front(); }
  /// Whether a patch number is in use: a brick's cell has none of its own.
  bool exists(std::uint32_t patch) const { return !isCell(patch) || level_.brickOfCell[patch] == kNoBrick; }

  /// The point of a patch that is farthest from the surface, or a cell's centre.
  glm::dvec3 pointOf(std::uint32_t patch) const {
    if (isCell(patch)) return level_.grid.brickCenter(level_.grid.brickOfCell(patch));
    const auto after = std::upper_bound(first_.begin(), first_.end(), patch);
    const auto b = static_cast<std::size_t>(after - first_.begin() - 1);
    return level_.grid.sample(level_.grid.brickOfCell(level_.cellOfBrick[b]),
                              sampleOf(bricks_[b].deepest[patch - first_[b]]));
  }

  /// Joins what meets across the faces between cells. Samples on edges and corners follow: of the cells around an edge
  /// each shares a face with the next.
  DisjointSets join() const {
    DisjointSets regions(patchCount());
    for (std::size_t cell = 0; cell < level_.grid.cellCount(); ++cell)
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        glm::ivec3 next = level_.grid.brickOfCell(cell);
        if (++next[axis] >= level_.grid.brickCounts[axis]) continue;
        joinFace(regions, cell, level_.grid.cellOfBrick(next), axis);
      }
    return regions;
  }

private:
  void joinFace(DisjointSets& regions, std::size_t cell, std::size_t nextCell, glm::length_t axis) const {
    const std::uint32_t brick = level_.brickOfCell[cell], nextBrick = level_.brickOfCell[nextCell];
    if (brick == kNoBrick && nextBrick == kNoBrick) {
      regions.unite(static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(nextCell));
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
        regions.unite(here, there);
      }
  }

  const LevelSamples& level_;
  std::vector<BrickPatches> bricks_;
  std::vector<std::uint32_t> first_; ///< a brick: number of its first patch
};

enum class RegionSign : std::uint8_t { Outside, Inside, Mixed };

/// Up to kVotes patches of each region, spread over its list, then their majority, which must be unanimous.
class RegionVotes {
public:
  RegionVotes(const PatchGraph& graph, const InsideTest& test) : regionOfPatch_(graph.patchCount()) {
    DisjointSets regions = graph.join();
    std::vector<std::uint32_t> patchCounts(graph.patchCount(), 0), seen(graph.patchCount(), 0);
    for (std::uint32_t patch = 0; patch < graph.patchCount(); ++patch) {
      regionOfPatch_[patch] = regions.rootOf(patch);
      if (graph.exists(patch)) ++patchCounts[regionOfPatch_[patch]];
    }
    std::vector<std::uint32_t> voters;
    for (std::uint32_t patch = 0; patch < graph.patchCount(); ++patch) {
      if (!graph.exists(patch)) continue;
      const std::uint64_t count = patchCounts[regionOfPatch_[patch]], number = seen[regionOfPatch_[patch]]++;
      if (number * kVotes / count != (number + 1) * kVotes / count || count <= kVotes) voters.push_back(patch);
    }
    std::vector<std::uint8_t> votes(voters.size());
    tbb::parallel_for(std::size_t{0}, voters.size(),
                      [&](std::size_t i) { votes[i] = test.isInside(graph.pointOf(voters[i])); });
    std::vector<std::uint32_t> insideVotes(graph.patchCount(), 0), allVotes(graph.patchCount(), 0);
    for (std::size_t i = 0; i < voters.size(); ++i) {
      insideVotes[regionOfPatch_[voters[i]]] += votes[i];
      ++allVotes[regionOfPatch_[voters[i]]];
    }
    signs_.resize(graph.patchCount());
    for (std::uint32_t region = 0; region < graph.patchCount(); ++region)
      signs_[region] = insideVotes[region] == 0                  ? RegionSign::Outside
                       : insideVotes[region] == allVotes[region] ? RegionSign::Inside
                                                                 : RegionSign::Mixed;
  }
  RegionSign signOf(std::uint32_t patch) const { return signs_[regionOfPatch_[patch]]; }

private:
  std::vector<std::uint32_t> regionOfPatch_;
  std::vector<RegionSign> signs_;
};

} // namespace

LevelSigns floodSigns(const LevelSamples& level, const InsideTest& test) {
  const PatchGraph graph(level);
  std::optional<RegionVotes> votes;
  // On open meshes any region may lead through a hole to the other side: there every sample speaks for itself.
  if (test.isConstantBetweenSurfaces()) votes.emplace(graph, test);
  const auto isInside = [&](std::uint32_t patch, glm::dvec3 point) {
    const RegionSign sign = votes ? votes->signOf(patch) : RegionSign::Mixed;
    return sign == RegionSign::Mixed ? test.isInside(point) : sign == RegionSign::Inside;
  };
  LevelSigns signs;
  signs.cellInside.resize(level.grid.cellCount());
  tbb::parallel_for(std::size_t{0}, signs.cellInside.size(), [&](std::size_t cell) {
    if (level.brickOfCell[cell] == kNoBrick)
      signs.cellInside[cell] =
          isInside(static_cast<std::uint32_t>(cell), graph.pointOf(static_cast<std::uint32_t>(cell)));
  });
  signs.sampleInside.resize(level.brickCount() * kSamples);
  tbb::parallel_for(std::size_t{0}, level.brickCount(), [&](std::size_t b) {
    const glm::ivec3 brick = level.grid.brickOfCell(level.cellOfBrick[b]);
    for (std::size_t i = 0; i < kSamples; ++i)
      signs.sampleInside[b * kSamples + i] = isInside(graph.patchOf(b, i), level.grid.sample(brick, sampleOf(i)));
  });
  return signs;
}

} // namespace brickfield
