// Votes on regions of steady cells; questions in others.
#include "bakers/sign_flood.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "bakers/patch_graph.h"
#include "bakers/sample_signs.h"

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

/// Patches of steady cells that meet are one region. Up to kVotes patches of each region vote, spread over its list,
/// and must be unanimous.
///
/// isVoter  a patch: it exists, in a steady cell
std::vector<PatchSign> signsByRegion(const PatchGraph& graph, const InsideTest& test,
                                     const std::vector<std::uint8_t>& isVoter) {
  const std::uint32_t count = graph.patchCount();
  DisjointSets regions(count);
  graph.forEachMeeting([&](std::uint32_t a, std::uint32_t b) {
    if (isVoter[a] && isVoter[b]) regions.unite(a, b);
  });
  std::vector<std::uint32_t> regionOfPatch(count), patchCounts(count, 0), seen(count, 0), voters;
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    regionOfPatch[patch] = regions.rootOf(patch);
    patchCounts[regionOfPatch[patch]] += isVoter[patch];
  }
  for (std::uint32_t patch = 0; patch < count; ++patch) {
    if (!isVoter[patch]) continue;
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

/// Decides regions together and unsteady cells sample by sample.
class SignFlood {
public:
  SignFlood(const LevelSamples& level, const InsideTest& test)
      : level_(level), test_(test), graph_(level), isSteady_(findSteadyCells(level.grid, test)) {
    isVoter_.resize(graph_.patchCount());
    for (std::size_t cell = 0; cell < isSteady_.size(); ++cell)
      if (level.brickOfCell[cell] == kNoBrick) isVoter_[cell] = isSteady_[cell];
    for (std::size_t b = 0; b < level.brickCount(); ++b)
      for (const std::uint16_t deepest : graph_.brick(b).deepest)
        isVoter_[graph_.patchOf(b, deepest)] = isSteady_[level.cellOfBrick[b]];
  }

  LevelSigns run() {
    patchSigns_ = signsByRegion(graph_, test_, isVoter_);
    LevelSigns signs;
    signs.cellInside.resize(level_.grid.cellCount());
    signs.sampleInside.resize(level_.brickCount() * kSamples);
    tbb::parallel_for(std::size_t{0}, signs.cellInside.size(), [&](std::size_t cell) {
      if (level_.brickOfCell[cell] == kNoBrick)
        signs.cellInside[cell] = signOfCell(cell);
      else
        signBrick(level_.brickOfCell[cell], &signs.sampleInside[level_.brickOfCell[cell] * kSamples]);
    });
    signs.mixedCells = findMixedCells();
    return signs;
  }

private:
  std::uint8_t signOfCell(std::size_t cell) {
    const glm::ivec3 brick = level_.grid.brickOfCell(cell);
    if (!isSteady_[cell]) {
      Ballot ballot(1);
      for (const std::uint8_t sign : askSamples(level_.grid, brick, test_, nullptr)) ballot.cast(0, sign);
      patchSigns_[cell] = ballot.signOf(0);
    }
    return patchSigns_[cell] == PatchSign::Mixed ? test_.isInside(level_.grid.brickCenter(brick))
                                                 : patchSigns_[cell] == PatchSign::Inside;
  }

  void signBrick(std::size_t b, std::uint8_t* sampleInside) {
    const glm::ivec3 brick = level_.grid.brickOfCell(level_.cellOfBrick[b]);
    if (isSteady_[level_.cellOfBrick[b]]) {
      for (std::size_t i = 0; i < kSamples; ++i) {
        const PatchSign sign = patchSigns_[graph_.patchOf(b, i)];
        sampleInside[i] = sign == PatchSign::Mixed ? test_.isInside(level_.grid.sample(brick, sampleOfIndex(i)))
                                                   : sign == PatchSign::Inside;
      }
      return;
    }
    const SampleSigns asked = askSamples(level_.grid, brick, test_, &level_.solidDistances[b * kSamples]);
    std::copy(asked.begin(), asked.end(), sampleInside);
    const BrickPatches& patches = graph_.brick(b);
    Ballot ballot(patches.deepest.size());
    for (std::size_t i = 0; i < kSamples; ++i) ballot.cast(patches.patchOfSample[i], asked[i]);
    for (std::size_t patch = 0; patch < patches.deepest.size(); ++patch)
      patchSigns_[graph_.patchOf(b, patches.deepest[patch])] = ballot.signOf(patch);
  }

  /// Cells with patches of two signs, and those where patches that meet disagree.
  std::vector<std::uint32_t> findMixedCells() const {
    std::vector<std::uint8_t> isMixed(graph_.patchCount(), 0);
    for (std::uint32_t patch = 0; patch < graph_.patchCount(); ++patch)
      isMixed[patch] = graph_.exists(patch) && patchSigns_[patch] == PatchSign::Mixed;
    if (!test_.isConstantBetweenSurfaces())
      graph_.forEachMeeting([&](std::uint32_t a, std::uint32_t b) {
        if (patchSigns_[a] != patchSigns_[b] && patchSigns_[a] != PatchSign::Mixed &&
            patchSigns_[b] != PatchSign::Mixed)
          isMixed[a] = isMixed[b] = 1;
      });
    std::vector<std::uint32_t> cells;
    for (std::uint32_t patch = 0; patch < graph_.patchCount(); ++patch)
      if (isMixed[patch]) cells.push_back(graph_.cellOf(patch));
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  const LevelSamples& level_;
  const InsideTest& test_;
  const PatchGraph graph_;
  const std::vector<std::uint8_t> isSteady_; ///< a cell
  std::vector<std::uint8_t> isVoter_;        ///< a patch
  std::vector<PatchSign> patchSigns_;
};

} // namespace

LevelSigns floodSigns(const LevelSamples& level, const InsideTest& test) { return SignFlood(level, test).run(); }

} // namespace brickfield
