// Votes on regions of steady cells; questions in others.
#include "bakers/sign_flood.h"

#include <algorithm>
#include <optional>

#include <tbb/parallel_invoke.h>

#include "bakers/each_uneven.h"
#include "bakers/patch_graph.h"
#include "bakers/sample_signs.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
constexpr std::size_t kVotes = 16; // inside tests a region; fewer where it has fewer patches

enum class PatchSign : std::uint8_t { Outside, Inside, Mixed };

/// Inside tests of a patch or a region.
struct Ballot {
  std::uint32_t inside = 0, all = 0;

  void cast(bool isInside) { inside += isInside, ++all; }
  PatchSign sign() const {
    if (inside == 0) return PatchSign::Outside;
    return inside == all ? PatchSign::Inside : PatchSign::Mixed;
  }
};

/// Patches of steady cells that meet are one region. Up to kVotes patches of each region vote, spread over its list,
/// and must be unanimous.
///
/// isVoter  a patch: it exists, in a steady cell
std::vector<PatchSign> signsByRegion(const PatchGraph& graph, const InsideTest& test,
                                     const std::vector<std::uint8_t>& isVoter) {
  const std::uint32_t count = graph.patchCount();
  SharedSets regions(count);
  forEachUneven(static_cast<std::size_t>(graph.sliceCount()), 1, [&](std::size_t z) {
    graph.forEachMeetingInSlice(static_cast<int>(z), [&](std::uint32_t a, std::uint32_t b) {
      if (isVoter[a] && isVoter[b]) regions.unite(a, b);
    });
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
  forEachUneven(voters.size(), 8, [&](std::size_t i) { votes[i] = test.isInside(graph.pointOf(voters[i])); });
  std::vector<Ballot> ballots(count);
  for (std::size_t i = 0; i < voters.size(); ++i) ballots[regionOfPatch[voters[i]]].cast(votes[i]);
  std::vector<PatchSign> signs(count);
  for (std::uint32_t patch = 0; patch < count; ++patch) signs[patch] = ballots[regionOfPatch[patch]].sign();
  return signs;
}

/// A byte of 0 or 1 for each of eight bits, the lowest first.
std::uint64_t bytesOfBits(std::uint64_t bits) {
  // Each byte gets all bits and keeps its own, which then carries into the byte's highest.
  const std::uint64_t own = bits * 0x0101010101010101u & 0x8040201008040201u;
  return (own + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u;
}

/// Decides regions together and unsteady cells sample by sample.
class SignFlood {
public:
  SignFlood(const LevelSamples& level, const InsideTest& test) : level_(level), test_(test) {}

  LevelSigns run() {
    LevelSigns signs;
    signs.cellInside.resize(level_.grid.cellCount());
    signs.sampleInside.resize(level_.brickCount() * kSamples);
    // Neither needs the other: one fills the gaps of the other.
    tbb::parallel_invoke([&] { graph_.emplace(level_); },
                         [&] {
                           isSteady_ = findSteadyCells(level_.grid, test_);
                           askUnsteadyBricks(signs);
                         });
    patchSigns_ = signsByRegion(*graph_, test_, voters());
    forEachUneven(signs.cellInside.size(), 64, [&](std::size_t cell) {
      if (level_.brickOfCell[cell] == kNoBrick)
        signs.cellInside[cell] = signOfCell(cell);
      else
        signBrick(level_.brickOfCell[cell], &signs.sampleInside[level_.brickOfCell[cell] * kSamples]);
    });
    signs.mixedCells = findMixedCells();
    return signs;
  }

private:
  void askUnsteadyBricks(LevelSigns& signs) const {
    std::vector<std::size_t> unsteady;
    for (std::size_t b = 0; b < level_.brickCount(); ++b)
      if (!isSteady_[level_.cellOfBrick[b]]) unsteady.push_back(b);
    forEachUneven(unsteady.size(), 1, [&](std::size_t i) {
      const std::size_t begin = unsteady[i] * kSamples;
      const glm::ivec3 brick = level_.grid.brickOfCell(level_.cellOfBrick[unsteady[i]]);
      const SampleSigns asked = askSamples(level_.grid, brick, test_, &level_.solidDistances[begin]);
      std::copy(asked.begin(), asked.end(), &signs.sampleInside[begin]);
    });
  }
  /// A patch: it exists, in a steady cell.
  std::vector<std::uint8_t> voters() const {
    std::vector<std::uint8_t> isVoter(graph_->patchCount());
    for (std::size_t cell = 0; cell < isSteady_.size(); ++cell)
      if (level_.brickOfCell[cell] == kNoBrick) isVoter[cell] = isSteady_[cell];
    for (std::size_t b = 0; b < level_.brickCount(); ++b)
      for (std::uint32_t patch = graph_->firstPatchOf(b); patch < graph_->endPatchOf(b); ++patch)
        isVoter[patch] = isSteady_[level_.cellOfBrick[b]];
    return isVoter;
  }
  std::uint8_t signOfCell(std::size_t cell) {
    const glm::ivec3 brick = level_.grid.brickOfCell(cell);
    if (!isSteady_[cell]) {
      Ballot ballot;
      for (const std::uint8_t sign : askSamples(level_.grid, brick, test_, nullptr)) ballot.cast(sign != 0);
      patchSigns_[cell] = ballot.sign();
    }
    return patchSigns_[cell] == PatchSign::Mixed ? test_.isInside(level_.grid.brickCenter(brick))
                                                 : patchSigns_[cell] == PatchSign::Inside;
  }

  /// Samples on the surface have no side: outside, unless one was asked for. All of unsteady bricks were.
  void signBrick(std::size_t b, std::uint8_t* sampleInside) {
    const glm::ivec3 brick = level_.grid.brickOfCell(level_.cellOfBrick[b]);
    const auto forEachPatch = [&](const auto& visit) {
      for (std::uint32_t patch = graph_->firstPatchOf(b); patch < graph_->endPatchOf(b); ++patch)
        visit(patchSigns_[patch], graph_->samplesOf(b, patch));
    };
    if (isSteady_[level_.cellOfBrick[b]]) {
      SampleMask inside{};
      forEachPatch([&](PatchSign sign, const SampleMask& samples) {
        if (sign == PatchSign::Inside)
          for (std::size_t z = 0; z < inside.size(); ++z) inside[z] |= samples[z];
        if (sign == PatchSign::Mixed)
          forEachSample(samples, [&](std::size_t i) {
            const bool isInside = test_.isInside(level_.grid.sample(brick, sampleOfIndex(i)));
            inside[i / 64] |= std::uint64_t{isInside} << (i % 64);
          });
      });
      for (std::size_t row = 0; row < kSamples / 8; ++row) {
        const std::uint64_t bytes = bytesOfBits(inside[row / 8] >> (8 * (row % 8)) & 0xffu);
        for (std::size_t i = 0; i < 8; ++i) sampleInside[8 * row + i] = static_cast<std::uint8_t>(bytes >> (8 * i));
      }
      return;
    }
    forEachPatch([&](PatchSign& sign, const SampleMask& samples) {
      Ballot ballot;
      forEachSample(samples, [&](std::size_t i) { ballot.cast(sampleInside[i] != 0); });
      sign = ballot.sign();
    });
  }

  /// Cells with patches of two signs, and those where patches that meet disagree. Not those where the sign changes only
  /// beside samples that are patches of their own: openings narrower than a voxel, which the field hides anyway.
  std::vector<std::uint32_t> findMixedCells() const {
    std::vector<std::uint8_t> isMixed(graph_->patchCount(), 0);
    for (std::uint32_t patch = 0; patch < graph_->patchCount(); ++patch)
      isMixed[patch] = graph_->exists(patch) && patchSigns_[patch] == PatchSign::Mixed;
    if (!test_.isConstantBetweenSurfaces())
      for (std::size_t cell = 0; cell < isSteady_.size(); ++cell) {
        if (isSteady_[cell]) continue; // patches of steady cells that meet are of one region
        graph_->forEachMeetingOf(cell, [&](std::uint32_t a, std::uint32_t b) {
          if (patchSigns_[a] != patchSigns_[b] && patchSigns_[a] != PatchSign::Mixed &&
              patchSigns_[b] != PatchSign::Mixed)
            isMixed[a] = isMixed[b] = 1;
        });
      }
    std::vector<std::uint32_t> cells;
    for (std::uint32_t patch = 0; patch < graph_->patchCount(); ++patch)
      if (isMixed[patch]) cells.push_back(graph_->cellOf(patch));
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
  }

  const LevelSamples& level_;
  const InsideTest& test_;
  std::optional<PatchGraph> graph_;
  std::vector<std::uint8_t> isSteady_; ///< a cell
  std::vector<PatchSign> patchSigns_;
};

} // namespace

LevelSigns floodSigns(const LevelSamples& level, const InsideTest& test) { return SignFlood(level, test).run(); }

} // namespace brickfield
