// Mixed cells and their neighbours get the smaller of both distances. A neighbour that was empty stays so if the
// membrane keeps away from it. Cells farther off cannot be nearer to it than the cells between.
#include "bakers/membranes.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bakers/brick_sampler.h"
#include "bakers/each_uneven.h"
#include "bakers/sample_signs.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;

constexpr float kTriangleVoxels = 0.1f; // this near a triangle, it is nearer than any membrane that matters

constexpr double kColoredVoxels = 2.5; // so near a membrane, surface attributes are looked up

/// What is so near to a cell's samples counts; beyond, a brick's codes clamp and an empty cell may stay empty.
constexpr double kReachVoxels = kSampledRangeVoxels;

struct MembraneBrick {
  struct Samples {
    BrickSamples distances;
    SampleSigns inside;
  };
  std::unique_ptr<Samples> samples; ///< nothing: no membrane comes within reach
  float least = 0;                  ///< distance to a membrane, the reach at most
};

/// Draws a brick's distances in to the membranes that come near it.
class MembraneSearch {
public:
  /// distances  512 to triangles, in voxels: what is not nearer is of no interest; nothing: all is
  MembraneSearch(const SamplingRequest& request, const InsideTest& test, glm::ivec3 brick, const float* distances)
      : request_(request),
        test_(test),
        brick_(brick),
        near_(test.nearRims(centerOf(SampleCube{}),
                            (SampleCube{}.radiusVoxels() + kReachVoxels) * request.grid.voxelSize)),
        distances_(distances) {
    voxels_.fill(std::numeric_limits<float>::infinity());
  }

  /// returns voxels from each sample to the nearest membrane, to first order; infinite beyond reach
  const std::array<float, kSamples>& run() {
    look(SampleCube{});
    return voxels_;
  }

private:
  static constexpr int kWholeCube = 2; // its samples are looked at one by one

  void look(const SampleCube& cube) {
    const SampleGrid& grid = request_.grid;
    const double radius = cube.radiusVoxels() * grid.voxelSize;
    const glm::dvec3 center = centerOf(cube);
    const double farthest = limitOf(cube);
    if (farthest <= 0) return;
    std::optional<WindingAround> around;
    if (near_) around = near_->around(center, radius);
    if (around && isFarFromMembranes(*around, glm::dvec3(0.0), radius, farthest)) return;
    // What is known of a larger ball is less: where this one's would not do, that cannot.
    const bool mayBeSteady = !near_ || (around && around->leastFromHalf(glm::dvec3(0.0), radius + limit()) > 0);
    if (!request_.isComplete && cube.side > 2 && mayBeSteady && isSteady(center, radius + limit())) return;
    if (cube.side > kWholeCube) {
      for (int i = 0; i < 8; ++i) look(cube.eighth(i));
      return;
    }
    cube.forEach([&](glm::ivec3 sample) {
      const glm::dvec3 point = grid.sample(brick_, sample);
      const double limit = limitOf(sampleIndex(sample));
      if (limit > 0 && (!around || !isFarFromMembranes(*around, point - center, 0.0, limit)))
        voxels_[sampleIndex(sample)] =
            static_cast<float>(test_.membraneDistance(point, limit, near_ ? &*near_ : nullptr) / grid.voxelSize);
    });
  }
  bool isSteady(glm::dvec3 center, double radius) const {
    if (!near_) return test_.isSteady(center, radius);
    const std::optional<WindingAround> around = near_->around(center, radius);
    return around && around->leastFromHalf(glm::dvec3(0.0), radius) > 0;
  }
  glm::dvec3 centerOf(const SampleCube& cube) const {
    const SampleGrid& grid = request_.grid;
    return grid.origin + grid.voxelSize * (glm::dvec3(kBrickCells * brick_) + cube.centerVoxels());
  }
  /// Up to where membranes matter to a sample, in soup space; 0: none does.
  double limitOf(std::size_t sample) const {
    if (!distances_) return limit();
    if (distances_[sample] < kTriangleVoxels) return 0;
    return std::min(limit(), static_cast<double>(distances_[sample]) * request_.grid.voxelSize);
  }
  double limitOf(const SampleCube& cube) const {
    double most = 0;
    cube.forEach([&](glm::ivec3 sample) { most = std::max(most, limitOf(sampleIndex(sample))); });
    return most;
  }
  /// Soup space.
  double limit() const { return request_.isComplete ? HUGE_VAL : kReachVoxels * request_.grid.voxelSize; }

  const SamplingRequest& request_;
  const InsideTest& test_;
  glm::ivec3 brick_;
  const std::optional<NearRims> near_; ///< as far as membranes matter; nothing: there are very many
  const float* distances_;
  std::array<float, kSamples> voxels_;
};

class MembraneSampler {
public:
  MembraneSampler(const SamplingRequest& request, const InsideTest& test, const LevelSamples& level,
                  const LevelSigns& signs)
      : request_(request), test_(test), level_(level), signs_(signs) {}

  /// mustStore  whether it becomes a brick although no membrane should be near
  MembraneBrick measure(std::uint32_t cell, bool mustStore) const {
    const glm::ivec3 brick = level_.grid.brickOfCell(cell);
    const std::uint32_t slot = level_.brickOfCell[cell];
    MembraneSearch search(request_, test_, brick, slot == kNoBrick ? nullptr : &level_.solidDistances[slot * kSamples]);
    const std::array<float, kSamples>& toMembrane = search.run();
    MembraneBrick result;
    result.least = static_cast<float>(kReachVoxels);
    for (const float voxels : toMembrane) result.least = std::min(result.least, voxels);
    if (!mustStore && result.least >= static_cast<float>(kReachVoxels)) return result;
    result.samples.reset(new MembraneBrick::Samples); // not zeroed
    takeSamples(cell, brick, *result.samples);
    BrickSamples& samples = result.samples->distances;
    for (std::size_t i = 0; i < kSamples; ++i) {
      float& distance = samples.solidDistances[i];
      if (distance < kTriangleVoxels || distance <= toMembrane[i]) continue;
      // The triangle gives the membrane its color; beyond the range it was not looked for.
      if (request_.keepsTriangles && distance >= static_cast<float>(kSampledRangeVoxels) &&
          static_cast<double>(toMembrane[i]) < kColoredVoxels)
        samples.solidTriangles[i] =
            request_.surfaces->solid->nearest(level_.grid.sample(brick, sampleOfIndex(i))).triangle;
      distance = toMembrane[i];
    }
    return result;
  }

private:
  /// Of the brick that there is; else anew, where no triangle comes into the cell.
  void takeSamples(std::uint32_t cell, glm::ivec3 brick, MembraneBrick::Samples& samples) const {
    const std::uint32_t slot = level_.brickOfCell[cell];
    if (slot == kNoBrick) {
      sampleBrick(request_, brick, !request_.isComplete, samples.distances);
      samples.inside = askSamples(request_.grid, brick, test_, nullptr);
      return;
    }
    const auto copy = [&](const auto& from, auto& to) {
      if (!from.empty()) std::copy_n(&from[slot * kSamples], kSamples, to.begin());
    };
    copy(level_.solidDistances, samples.distances.solidDistances);
    copy(level_.solidTriangles, samples.distances.solidTriangles);
    copy(level_.sheetDistances, samples.distances.sheetDistances);
    copy(level_.sheetTriangles, samples.distances.sheetTriangles);
    copy(signs_.sampleInside, samples.inside);
  }

  const SamplingRequest& request_;
  const InsideTest& test_;
  const LevelSamples& level_;
  const LevelSigns& signs_;
};

/// Steps over cells, diagonal ones included, to the nearest of some cells: the chessboard distance, in two passes over
/// rows (Rosenfeld and Pfaltz 1968). Each cell takes one more than the least of those around it that were passed
/// before.
class CellSteps {
public:
  CellSteps(const SampleGrid& grid, const std::vector<std::uint32_t>& sources)
      : grid_(grid),
        strides_(1, grid.brickCounts.x + 2, (grid.brickCounts.x + 2) * (grid.brickCounts.y + 2)),
        steps_(static_cast<std::size_t>(strides_.z) * static_cast<std::size_t>(grid.brickCounts.z + 2), kFar),
        leastOfThree_(steps_.size(), kFar) {
    for (const std::uint32_t cell : sources) steps_[placeOf(grid.brickOfCell(cell))] = 0;
    const glm::ivec3 last = grid.brickCounts - 1;
    for (int z = 0; z <= last.z; ++z)
      for (int y = 0; y <= last.y; ++y) passRow<1>({0, y, z});
    for (int z = last.z; z >= 0; --z)
      for (int y = last.y; y >= 0; --y) passRow<-1>({last.x, y, z});
  }

  int at(glm::ivec3 brick) const { return steps_[placeOf(brick)]; }

private:
  static constexpr int kFar = 1 << 20; // of grids without a source, and around grids

  std::size_t placeOf(glm::ivec3 brick) const {
    return static_cast<std::size_t>((brick.x + 1) + (brick.y + 1) * strides_.y + (brick.z + 1) * strides_.z);
  }
  /// first  where the pass enters the row
  template <int kWay>
  void passRow(glm::ivec3 first) {
    int* row = &steps_[placeOf(first)];
    int* least = &leastOfThree_[placeOf(first)];
    const int *beside = least - kWay * strides_.y, *before = least - kWay * strides_.z;
    for (int i = 0, x = 0; i < grid_.brickCounts.x; ++i, x += kWay) {
      const int passed =
          std::min(std::min(beside[x], before[x]), std::min(before[x - strides_.y], before[x + strides_.y]));
      row[x] = std::min(row[x], 1 + std::min(passed, row[x - kWay]));
    }
    for (int i = 0, x = 0; i < grid_.brickCounts.x; ++i, x += kWay)
      least[x] = std::min(row[x], std::min(row[x - 1], row[x + 1]));
  }

  const SampleGrid& grid_;
  glm::ivec3 strides_;            ///< of places, one more on each side than there are cells
  std::vector<int> steps_;        ///< a place
  std::vector<int> leastOfThree_; ///< a place: of it and those beside it in its row, as of the last pass
};

} // namespace

void insertMembranes(const SamplingRequest& request, const InsideTest& test, LevelSamples& level, LevelSigns& signs) {
  if (signs.mixedCells.empty()) return;
  const CellSteps steps(request.grid, signs.mixedCells);
  std::vector<std::uint32_t> cells;
  std::uint32_t number = 0;
  request.grid.forEachCell([&](glm::ivec3 brick) {
    const std::uint32_t cell = number++;
    const int stepsAway = steps.at(brick);
    if (stepsAway <= 1) cells.push_back(cell);
    const float reach = static_cast<float>(kBrickCells * std::max(0, stepsAway - 1));
    if (stepsAway > 1) level.cellBounds[cell] = std::min(level.cellBounds[cell], reach);
  });
  const auto isMixed = [&](std::uint32_t cell) { return steps.at(request.grid.brickOfCell(cell)) == 0; };
  request.admit(level.brickCount() + cells.size());
  std::vector<MembraneBrick> bricks(cells.size());
  const MembraneSampler sampler(request, test, level, signs);
  forEachUneven(cells.size(), 2, [&](std::size_t i) {
    bricks[i] = sampler.measure(cells[i], isMixed(cells[i]));
    request.done(0);
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t cell = cells[i];
    float& bound = level.cellBounds[cell];
    bound = std::min(bound, boundBySamples(bricks[i].least));
    if (!bricks[i].samples) continue;
    if (!isMixed(cell) && level.brickOfCell[cell] == kNoBrick && bound > kTouchVoxels) continue;
    storeBrick(request, cell, bricks[i].samples->distances, level);
    signs.sampleInside.resize(level.brickCount() * kSamples);
    std::copy(bricks[i].samples->inside.begin(), bricks[i].samples->inside.end(),
              signs.sampleInside.begin() + static_cast<std::ptrdiff_t>(level.brickOfCell[cell] * kSamples));
  }
}

} // namespace brickfield
