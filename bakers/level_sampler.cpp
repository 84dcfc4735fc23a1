// Cells first, by one query each; then the samples of the cells that are left.
#include "bakers/level_sampler.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "bakers/brick_sampler.h"
#include "bakers/cell_bounds.h"
#include "bakers/each_uneven.h"
#include "bakers/float4.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
// A point of a brick's surface is at most half a cell's face diagonal from a sample of it.
constexpr double kFaceHalfDiagonalVoxels = 0.70710679;
constexpr double kBoundSlackVoxels = 1e-3; // over the rounding of double and of the float that stores the bound

/// Where a brick's samples go; nothing for a surface that there is not, and for triangles that are not kept.
struct BrickPlaces {
  float *solidDistances, *sheetDistances;
  std::uint32_t *solidTriangles, *sheetTriangles;
};

void sampleRows(const SamplingRequest& request, glm::ivec3 brick, const SampleRows& rows, bool isCapped,
                const BrickPlaces& places) {
  const BakeSurfaces& surfaces = *request.surfaces;
  if (surfaces.solid)
    SurfaceSampler{request.grid, *surfaces.solid, nullptr, 0, isCapped}.run(brick, rows, places.solidDistances,
                                                                            places.solidTriangles);
  if (surfaces.sheets)
    SurfaceSampler{request.grid, *surfaces.sheets, &*surfaces.slabs, request.halfThickness, isCapped}.run(
        brick, rows, places.sheetDistances, places.sheetTriangles);
}

/// Where a brick or one beside it stands among the 27 of these.
constexpr std::size_t placeOf(glm::ivec3 offset) {
  return static_cast<std::size_t>(9 * (offset.z + 1) + 3 * (offset.y + 1) + offset.x + 1);
}

/// Samples of a brick that bricks beside it measure where they exist: those of a corner, an edge or a face.
struct SharedSide {
  glm::ivec3 first{0}, last{0};
  SampleRows others{};                    ///< all samples but these
  std::array<glm::ivec3, 7> neighbours{}; ///< that have them too, the one that comes first before the others
  std::size_t neighbourCount = 0;
};

/// Along an axis samples are a brick's first, its last or between, and of two bricks the one that begins with a sample
/// comes before the one that ends with it: what has no last sample the brick measures itself.
constexpr auto kSharedSides = [] {
  std::array<SharedSide, 27 - 8> sides{};
  std::size_t count = 0;
  for (int number = 0; number < 27; ++number) {
    const std::array<int, 3> side = {number % 3, number / 3 % 3, number / 9}; // 0 first, 1 between, 2 last
    if (side[0] != 2 && side[1] != 2 && side[2] != 2) continue;
    SharedSide& shared = sides[count++];
    constexpr std::array<int, 3> kFirst = {0, 1, kBrickCells}, kLast = {0, kBrickCells - 1, kBrickCells};
    const auto of = [&](const std::array<int, 3>& ends, std::size_t axis) {
      return ends[static_cast<std::size_t>(side[axis])];
    };
    shared.first = {of(kFirst, 0), of(kFirst, 1), of(kFirst, 2)};
    shared.last = {of(kLast, 0), of(kLast, 1), of(kLast, 2)};
    for (std::uint8_t& row : shared.others) row = 0xff;
    const unsigned xs = (1u << (shared.last.x + 1)) - (1u << shared.first.x);
    for (int z = shared.first.z; z <= shared.last.z; ++z)
      for (int y = shared.first.y; y <= shared.last.y; ++y)
        shared.others[static_cast<std::size_t>(kBrickSamples * z + y)] = static_cast<std::uint8_t>(~xs & 0xffu);
    const auto steps = [&](std::size_t axis) { return side[axis] == 1 ? 1 : 2; };
    bool isBeforeOwn = true;
    for (int z = 0; z < steps(2); ++z)
      for (int y = 0; y < steps(1); ++y)
        for (int x = 0; x < steps(0); ++x) {
          const glm::ivec3 offset((side[0] == 2) - x, (side[1] == 2) - y, (side[2] == 2) - z);
          isBeforeOwn = isBeforeOwn && (offset.x != 0 || offset.y != 0 || offset.z != 0);
          if (isBeforeOwn) shared.neighbours[shared.neighbourCount++] = offset;
        }
  }
  return sides;
}();

/// Which brick measures the samples that several share: of those that exist, the first.
class SharedSamples {
public:
  /// slotOfCell  kNoBrick where there is no brick
  SharedSamples(const SampleGrid& grid, const std::vector<std::uint32_t>& slotOfCell, glm::ivec3 brick) {
    slots_.fill(kNoBrick);
    const glm::ivec3 low = glm::max(brick - 1, 0), high = glm::min(brick + 1, grid.brickCounts - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y) {
        const std::size_t row = grid.cellOfBrick({0, y, z});
        for (int x = low.x; x <= high.x; ++x)
          slots_[placeOf(glm::ivec3(x, y, z) - brick)] = slotOfCell[row + static_cast<std::size_t>(x)];
      }
  }

  SampleRows ownRows() const {
    SampleRows rows = allSamples();
    forEachForeignSide([&](const SharedSide& side, glm::ivec3) {
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i] &= side.others[i];
    });
    return rows;
  }
  /// Calls visit(first sample, slot of the owner, its sample, count) for the rows of samples of others.
  template <typename Visit>
  void forEachForeign(Visit visit) const {
    forEachForeignSide([&](const SharedSide& side, glm::ivec3 owner) {
      const std::size_t slot = slots_[placeOf(owner)];
      const auto count = static_cast<std::size_t>(side.last.x - side.first.x + 1);
      for (int z = side.first.z; z <= side.last.z; ++z)
        for (int y = side.first.y; y <= side.last.y; ++y) {
          const glm::ivec3 sample(side.first.x, y, z);
          visit(sampleIndex(sample), slot, sampleIndex(sample - kBrickCells * owner), count);
        }
    });
  }

private:
  /// Calls visit(side, offset of the owner).
  template <typename Visit>
  void forEachForeignSide(Visit visit) const {
    for (const SharedSide& side : kSharedSides)
      for (std::size_t i = 0; i < side.neighbourCount; ++i) {
        if (slots_[placeOf(side.neighbours[i])] == kNoBrick) continue;
        visit(side, side.neighbours[i]);
        break;
      }
  }

  std::array<std::uint32_t, 27> slots_; ///< of the bricks around, by place
};

/// How many samples are in rows.
std::size_t countOf(const SampleRows& rows) {
  std::array<std::uint64_t, sizeof(SampleRows) / sizeof(std::uint64_t)> words;
  std::memcpy(words.data(), rows.data(), sizeof(words));
  std::size_t count = 0;
  for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

/// Distances at candidates: each measures its own samples, then takes those that it shares from their owners.
class CandidateSampler {
public:
  CandidateSampler(const SamplingRequest& request, const std::vector<std::uint32_t>& candidates, LevelSamples& level)
      : request_(request), candidates_(candidates), level_(level), slotOfCell_(request.grid.cellCount(), kNoBrick) {
    for (std::uint32_t slot = 0; slot < candidates.size(); ++slot) slotOfCell_[candidates[slot]] = slot;
  }

  /// returns the least distance of each candidate's samples to a surface, in voxels
  std::vector<float> run() {
    std::atomic<std::uint64_t> queries = 0;
    forEachUneven(candidates_.size(), 2, [&](std::size_t slot) {
      const glm::ivec3 brick = request_.grid.brickOfCell(candidates_[slot]);
      const SampleRows rows = SharedSamples(request_.grid, slotOfCell_, brick).ownRows();
      queries += countOf(rows);
      const std::size_t first = slot * kSamples;
      sampleRows(request_, brick, rows, !request_.isComplete, samplesAt(first));
      request_.done(1);
    });
    std::vector<float> leastVoxels(candidates_.size());
    tbb::parallel_for(std::size_t{0}, candidates_.size(), [&](std::size_t slot) {
      copyForeign(slot);
      leastVoxels[slot] = leastDistance(slot);
    });
    level_.queries += queries;
    return leastVoxels;
  }

private:
  BrickPlaces samplesAt(std::size_t first) {
    const auto at = [first](auto& values) { return values.empty() ? nullptr : &values[first]; };
    return {at(level_.solidDistances), at(level_.sheetDistances), at(level_.solidTriangles), at(level_.sheetTriangles)};
  }
  void copyForeign(std::size_t slot) {
    const BrickPlaces to = samplesAt(slot * kSamples);
    SharedSamples(request_.grid, slotOfCell_, request_.grid.brickOfCell(candidates_[slot]))
        .forEachForeign([&](std::size_t sample, std::size_t owner, std::size_t ownerSample, std::size_t count) {
          const BrickPlaces from = samplesAt(owner * kSamples);
          const auto copyRow = [&](auto* values, const auto* ofOwner) {
            if (count == 1)
              values[sample] = ofOwner[ownerSample];
            else // of the samples between two sides
              std::memcpy(values + sample, ofOwner + ownerSample, (kBrickSamples - 2) * sizeof(*values));
          };
          if (to.solidDistances) copyRow(to.solidDistances, from.solidDistances);
          if (to.sheetDistances) copyRow(to.sheetDistances, from.sheetDistances);
          if (to.solidTriangles) copyRow(to.solidTriangles, from.solidTriangles);
          if (to.sheetTriangles) copyRow(to.sheetTriangles, from.sheetTriangles);
        });
  }
  float leastDistance(std::size_t slot) {
    const BrickPlaces samples = samplesAt(slot * kSamples);
    float least = std::numeric_limits<float>::infinity();
    if (samples.solidDistances)
      least = leastOf(samples.solidDistances, kSamples, [](Float4 v) { return v; }) -
              static_cast<float>(request_.solidGrowthVoxels);
    if (samples.sheetDistances)
      least = std::min(least, leastOf(samples.sheetDistances, kSamples, [](Float4 v) { return maximum(v, -v); }));
    return least;
  }

  const SamplingRequest& request_;
  const std::vector<std::uint32_t>& candidates_;
  LevelSamples& level_;
  std::vector<std::uint32_t> slotOfCell_; ///< of the candidates
};

/// Copies a brick's samples to a slot of the level's arrays.
void putBrick(std::size_t slot, const BrickSamples& samples, LevelSamples& level) {
  const auto put = [slot](const auto& from, auto& to) {
    if (!to.empty()) std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(slot * kSamples));
  };
  put(samples.solidDistances, level.solidDistances), put(samples.solidTriangles, level.solidTriangles);
  put(samples.sheetDistances, level.sheetDistances), put(samples.sheetTriangles, level.sheetTriangles);
}

void resizeBricks(const SamplingRequest& request, std::size_t count, LevelSamples& level) {
  const std::size_t samples = count * kSamples;
  if (request.surfaces->solid) level.solidDistances.resize(samples);
  if (request.surfaces->sheets) level.sheetDistances.resize(samples);
  if (!request.keepsTriangles) return;
  level.solidTriangles.resize(level.solidDistances.size());
  level.sheetTriangles.resize(level.sheetDistances.size());
}

template <typename Value>
void keepBricks(LargeVector<Value>& values, const std::vector<std::size_t>& kept) {
  if (values.empty()) return;
  for (std::size_t to = 0; to < kept.size(); ++to)
    if (to != kept[to]) std::copy_n(&values[kept[to] * kSamples], kSamples, &values[to * kSamples]);
  values.resize(kept.size() * kSamples);
}

/// Lets go of the bricks that turned out to be too far from the surface.
void dropBricks(LevelSamples& level, const std::vector<std::uint32_t>& candidates,
                const std::vector<float>& leastVoxels, bool isComplete) {
  std::vector<std::size_t> kept;
  for (std::size_t slot = 0; slot < candidates.size(); ++slot) {
    float& cellBound = level.cellBounds[candidates[slot]];
    cellBound = std::max(cellBound, boundBySamples(leastVoxels[slot]));
    if (isComplete || isBrickStored(cellBound)) kept.push_back(slot);
  }
  tbb::parallel_invoke([&] { keepBricks(level.solidDistances, kept); }, [&] { keepBricks(level.solidTriangles, kept); },
                       [&] { keepBricks(level.sheetDistances, kept); },
                       [&] { keepBricks(level.sheetTriangles, kept); });
  for (const std::size_t slot : kept) {
    level.brickOfCell[candidates[slot]] = static_cast<std::uint32_t>(level.cellOfBrick.size());
    level.cellOfBrick.push_back(candidates[slot]);
  }
}

} // namespace

float boundBySamples(float leastVoxels) {
  return static_cast<float>(static_cast<double>(leastVoxels) - kFaceHalfDiagonalVoxels - kBoundSlackVoxels);
}

void sampleBrick(const SamplingRequest& request, glm::ivec3 brick, bool isCapped, BrickSamples& samples) {
  sampleRows(request, brick, allSamples(), isCapped,
             {samples.solidDistances.data(), samples.sheetDistances.data(),
              request.keepsTriangles ? samples.solidTriangles.data() : nullptr,
              request.keepsTriangles ? samples.sheetTriangles.data() : nullptr});
}

void storeBrick(const SamplingRequest& request, std::size_t cell, const BrickSamples& samples, LevelSamples& level) {
  std::uint32_t& slot = level.brickOfCell[cell];
  if (slot == kNoBrick) {
    slot = static_cast<std::uint32_t>(level.brickCount());
    level.cellOfBrick.push_back(static_cast<std::uint32_t>(cell));
    resizeBricks(request, level.brickCount(), level);
  }
  putBrick(slot, samples, level);
}

LevelSamples sampleLevel(const SamplingRequest& request) {
  LevelSamples level;
  level.grid = request.grid;
  level.halfThickness = request.halfThickness;
  boundCells(request, level);
  level.brickOfCell.assign(request.grid.cellCount(), kNoBrick);
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t cell = 0; cell < level.cellBounds.size(); ++cell)
    if (request.isComplete || isBrickStored(level.cellBounds[cell])) candidates.push_back(cell);
  request.admit(candidates.size());
  resizeBricks(request, candidates.size(), level);
  const std::vector<float> leastVoxels = CandidateSampler(request, candidates, level).run();
  dropBricks(level, candidates, leastVoxels, request.isComplete);
  return level;
}

} // namespace brickfield
