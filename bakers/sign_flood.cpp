// Votes on regions (closed meshes) or on patches (open ones).
#include "bakers/sign_flood.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "bakers/patch_graph.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr std::size_t kVotes = 16; // inside tests a region; fewer where it has fewer patches

enum class PatchSign : std::uint8_t { Outside, Inside, Mixed };

/// Counts the inside tests of each of many things.
class Ballot {
public:
  explicit Ballot(std::size_t count) : inside_(count, 0), all_(count, 0) {}
  void cast(std::size_t thing, bool inside) {
    inside_[thing] += inside;
    ++all_[thing];
  }
  PatchSign signOf(std::size_t thing) const {
    if (inside_[thing] == 0) return PatchSign::Outside;
    return inside_[thing] == all_[thing] ? PatchSign::Inside : PatchSign::Mixed;
  }

private:
  std::vector<std::uint32_t> inside_, all_;
};

/// For closed meshes: patches that meet are one region. Up to kVotes patches of each region vote, spread over its list,
/// and must be unanimous.
std::vector<PatchSign> signsByRegion(const PatchGraph& graph, const InsideTest& test) {
  const std::uint32_t count = graph.patchCount();
  DisjointSets regions(count);
  graph.forEachMeeting([&](std::uint32_t a, std::uint32_t b) { regions.unite(a, b); });
  std::vector<std::uint32_t> regionOfPatch(count), patchCounts(count, 0), seen(count, 0), voters;
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    regionOfPatch[patch] = regions.rootOf(patch);
    patchCounts[regionOfPatch[patch]] += graph.exists(patch);
  }
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    if (!graph.exists(patch)) continue;
    const std::uint64_t total = patchCounts[regionOfPatch[patch]], number = seen[regionOfPatch[patch]]++;
    if (total <= kVotes || number * kVotes / total != (number + 1) * kVotes / total) voters.push_back(patch);
  }
  std::vector<std::uint8_t> votes(voters.size());
  tbb::parallel_for(std::size_t{0}, voters.size(),
                    [&](std::size_t i) { votes[i] = test.isInside(graph.pointOf(voters[i])); });
  Ballot ballot(count);
  for (std::size_t i = 0; i < voters.size(); ++i) ballot.cast(regionOfPatch[voters[i]], votes[i]);
  std::vector<PatchSign> signs(count);
  for (std::uint32_t patch = 0; patch < count; ++patch) signs[patch] = ballot.signOf(regionOfPatch[patch]);
  return signs;
}

/// For open meshes: any region may lead through a hole to the other side. So each patch votes for itself, by a lattice
/// of its samples (cells: their corners) and its deepest point; and where neighbours in one sample disagree, both are
/// mixed.
class PatchVotes {
public:
  PatchVotes(const LevelSamples& level, const PatchGraph& graph, const InsideTest& test)
      : level_(level), graph_(graph), test_(test), signs_(graph.patchCount(), PatchSign::Outside) {}

  std::vector<PatchSign> run() {
    askCorners();
    tbb::parallel_for(std::size_t{0}, level_.grid.cellCount(), [&](std::size_t cell) {
      if (level_.brickOfCell[cell] == kNoBrick)
        voteOnCell(cell);
      else
        voteOnBrick(level_.brickOfCell[cell], level_.grid.brickOfCell(cell));
    });
    std::vector<PatchSign> result = signs_;
    graph_.forEachMeeting([&](std::uint32_t a, std::uint32_t b) {
      if (signs_[a] != signs_[b] && signs_[a] != PatchSign::Mixed && signs_[b] != PatchSign::Mixed)
        result[a] = result[b] = PatchSign::Mixed;
    });
    return result;
  }

private:
  /// Asks at the corners of all cells, once for the eight that share one.
  void askCorners() {
    const glm::ivec3 corners = level_.grid.brickCounts + 1;
    cornerInside_.resize(static_cast<std::size_t>(corners.x * corners.y * corners.z));
    tbb::parallel_for(std::size_t{0}, cornerInside_.size(), [&](std::size_t i) {
      const auto index = static_cast<int>(i);
      const glm::ivec3 corner(index % corners.x, index / corners.x % corners.y, index / (corners.x * corners.y));
      cornerInside_[i] = test_.isInside(level_.grid.sample(corner, glm::ivec3(0)));
    });
  }

  void voteOnCell(std::size_t cell) {
    Ballot ballot(1);
    const glm::ivec3 brick = level_.grid.brickOfCell(cell), corners = level_.grid.brickCounts + 1;
    ballot.cast(0, test_.isInside(level_.grid.brickCenter(brick)));
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 corner = brick + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
      ballot.cast(0, cornerInside_[static_cast<std::size_t>((corner.z * corners.y + corner.y) * corners.x + corner.x)]);
    }
    signs_[cell] = ballot.signOf(0);
  }

  void voteOnBrick(std::uint32_t slot, glm::ivec3 brick) {
    constexpr std::array<int, 4> kLattice = {0, 2, 5, 7}; // of the eight samples along an axis
    const BrickPatches& patches = graph_.brick(slot);
    Ballot ballot(patches.deepest.size());
    const auto vote = [&](std::size_t index) {
      ballot.cast(patches.patchOfSample[index], test_.isInside(level_.grid.sample(brick, sampleOfIndex(index))));
    };
    for (const int z : kLattice)
      for (const int y : kLattice)
        for (const int x : kLattice) vote(sampleIndex({x, y, z}));
    for (const std::uint16_t deepest : patches.deepest) vote(deepest);
    for (std::size_t patch = 0; patch < patches.deepest.size(); ++patch)
      signs_[graph_.patchOf(slot, patches.deepest[patch])] = ballot.signOf(patch);
  }

  const LevelSamples& level_;
  const PatchGraph& graph_;
  const InsideTest& test_;
  std::vector<PatchSign> signs_;
  std::vector<std::uint8_t> cornerInside_; ///< a corner of the cells, x fastest
};

} // namespace

LevelSigns floodSigns(const LevelSamples& level, const InsideTest& test) {
  const PatchGraph graph(level);
  const std::vector<PatchSign> patchSigns =
      test.isConstantBetweenSurfaces() ? signsByRegion(graph, test) : PatchVotes(level, graph, test).run();
  const auto isInside = [&](std::uint32_t patch, glm::dvec3 point) {
    return patchSigns[patch] == PatchSign::Mixed ? test.isInside(point) : patchSigns[patch] == PatchSign::Inside;
  };
  LevelSigns signs;
  signs.cellInside.resize(level.grid.cellCount());
  tbb::parallel_for(std::size_t{0}, signs.cellInside.size(), [&](std::size_t cell) {
    const auto patch = static_cast<std::uint32_t>(cell);
    if (graph.exists(patch)) signs.cellInside[cell] = isInside(patch, graph.pointOf(patch));
  });
  signs.sampleInside.resize(level.brickCount() * kSamples);
  tbb::parallel_for(std::size_t{0}, level.brickCount(), [&](std::size_t b) {
    const glm::ivec3 brick = level.grid.brickOfCell(level.cellOfBrick[b]);
    for (std::size_t i = 0; i < kSamples; ++i)
      signs.sampleInside[b * kSamples + i] = isInside(graph.patchOf(b, i), level.grid.sample(brick, sampleOfIndex(i)));
  });
  for (std::uint32_t patch = 0; patch < graph.patchCount(); ++patch)
    if (graph.exists(patch) && patchSigns[patch] == PatchSign::Mixed) signs.mixedCells.push_back(graph.cellOf(patch));
  std::sort(signs.mixedCells.begin(), signs.mixedCells.end());
  signs.mixedCells.erase(std::unique(signs.mixedCells.begin(), signs.mixedCells.end()), signs.mixedCells.end());
  return signs;
}

} // namespace brickfield
