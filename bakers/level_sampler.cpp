// Cells first, by one query each; then the samples of the cells that are left.
#include "bakers/level_sampler.h"

#include <algorithm>
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

/// Which brick measures the samples that several share: of those that exist, the first.
class SharedSamples {
public:
  /// slotOfCell  kNoBrick where there is no brick
  SharedSamples(const SampleGrid& grid, const std::vector<std::uint32_t>& slotOfCell, glm::ivec3 brick)
      : grid_(grid), slotOfCell_(slotOfCell), brick_(brick) {
    lookAround();
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) ownerOf_[placeOf({x, y, z})] = findOwner({x, y, z});
  }

  SampleRows ownRows() const {
    SampleRows rows = allSamples();
    forEachForeign([&](std::size_t i, std::size_t, std::size_t, std::size_t count) {
      rows[i / kBrickSamples] &= static_cast<std::uint8_t>(~(((1u << count) - 1) << (i % kBrickSamples)));
    });
    return rows;
  }
  /// Calls visit(first sample, slot of the owner, its sample, count) for the rows of samples of others.
  template <typename Visit>
  void forEachForeign(Visit visit) const {
    for (std::size_t sides = 0; sides < ownerOf_.size(); ++sides) {
      const glm::ivec3 owner = ownerOf_[sides];
      if (owner == glm::ivec3(0)) continue;
      const std::size_t slot = slots_[placeOf(owner + 1)];
      const auto s = static_cast<int>(sides);
      const Samples x = samplesOn(s % 3), y = samplesOn(s / 3 % 3), z = samplesOn(s / 9);
      glm::ivec3 sample(x.first, 0, 0);
      for (sample.z = z.first; sample.z <= z.last; ++sample.z)
        for (sample.y = y.first; sample.y <= y.last; ++sample.y)
          visit(sampleIndex(sample), slot, sampleIndex(sample - kBrickCells * owner),
                static_cast<std::size_t>(x.last - x.first + 1));
    }
  }

private:
  /// Along an axis: side 0 is the first sample, 2 the last, 1 those between.
  struct Samples {
    int first, last;
  };
  static Samples samplesOn(int side) {
    return side == 0 ? Samples{0, 0} : side == 1 ? Samples{1, kBrickCells - 1} : Samples{kBrickCells, kBrickCells};
  }
  static std::size_t placeOf(glm::ivec3 sides) { return static_cast<std::size_t>(9 * sides.z + 3 * sides.y + sides.x); }
  void lookAround() {
    slots_.fill(kNoBrick);
    const glm::ivec3 low = glm::max(brick_ - 1, 0), high = glm::min(brick_ + 1, grid_.brickCounts - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y) {
        const std::size_t row = grid_.cellOfBrick({0, y, z});
        for (int x = low.x; x <= high.x; ++x)
          slots_[placeOf(glm::ivec3(x, y, z) - brick_ + 1)] = slotOfCell_[row + static_cast<std::size_t>(x)];
      }
  }
  bool exists(glm::ivec3 offset) const { return slots_[placeOf(offset + 1)] != kNoBrick; }
  /// Bricks that hold samples of these sides: along an axis the one that begins there before the one that ends there.
  glm::ivec3 findOwner(glm::ivec3 sides) const {
    const auto steps = [&](glm::length_t axis) { return sides[axis] == 1 ? 1 : 2; };
    for (int z = 0; z < steps(2); ++z)
      for (int y = 0; y < steps(1); ++y)
        for (int x = 0; x < steps(0); ++x) {
          const glm::ivec3 offset = glm::ivec3(sides.x == 2, sides.y == 2, sides.z == 2) - glm::ivec3(x, y, z);
          if (exists(offset)) return offset;
        }
    return glm::ivec3(0);
  }

  const SampleGrid& grid_;
  const std::vector<std::uint32_t>& slotOfCell_;
  glm::ivec3 brick_;
  std::array<std::uint32_t, 27> slots_; ///< of the bricks around, by offset + 1
  std::array<glm::ivec3, 27> ownerOf_;  ///< by sides
};

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
      std::uint64_t count = 0;
      for (const std::uint8_t row : rows) count += static_cast<std::uint64_t>(std::popcount(row));
      queries += count;
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
