// Mixed cells and their neighbours are measured anew, without cap, and get the smaller of both distances. A neighbour
// that was empty stays so if the membrane keeps away from it. Cells farther off cannot be nearer to it than the cells
// between.
#include "bakers/membranes.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bakers/patch_graph.h"

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;

/// Calls `visit` with the cell and those of its 26 neighbours that are in the grid.
template <typename Visit>
void forEachAround(const SampleGrid& grid, std::size_t cell, Visit visit) {
  const glm::ivec3 center = grid.brickOfCell(cell);
  const glm::ivec3 low = glm::max(center - 1, 0), high = glm::min(center + 1, grid.brickCounts - 1);
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) visit(grid.cellOfBrick({x, y, z}));
}

constexpr double kFarExcess = 0.45;     // almost no turn or almost a whole one: no hole is near
constexpr float kTriangleVoxels = 0.1f; // this near a triangle, it is nearer than any membrane that matters
constexpr int kLatticeEdge = kBrickSamples + 2;

/// The inside test's excess at the samples of a brick and one layer around them: all that slopes over two voxels need.
class ExcessLattice {
public:
  ExcessLattice(const SampleGrid& grid, const InsideTest& test, glm::ivec3 brick)
      : grid_(grid), test_(test), brick_(brick), excesses_(kLatticeEdge * kLatticeEdge * kLatticeEdge) {
    std::size_t i = 0;
    for (int z = -1; z <= kBrickSamples; ++z)
      for (int y = -1; y <= kBrickSamples; ++y)
        for (int x = -1; x <= kBrickSamples; ++x) excesses_[i++] = test.excess(grid.sample(brick, {x, y, z}));
  }

  double at(glm::ivec3 sample) const {
    return excesses_[static_cast<std::size_t>(((sample.z + 1) * kLatticeEdge + sample.y + 1) * kLatticeEdge + sample.x +
                                              1)];
  }

  /// Voxels from a sample to the nearest membrane, to first order: excess over slope. Infinite where there is none.
  ///
  /// triangleVoxels  distance to the nearest triangle: a slope taken across it would see its jump
  double membraneVoxels(glm::ivec3 sample, float triangleVoxels) const {
    const double excess = at(sample);
    if (std::abs(excess) > kFarExcess || triangleVoxels < kTriangleVoxels) return HUGE_VAL;
    const double step = triangleVoxels > 1.0f ? 1.0 : 0.9 * static_cast<double>(triangleVoxels);
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 offset(0);
      offset[axis] = 1;
      slope[axis] = triangleVoxels > 1.0f ? at(sample + offset) - at(sample - offset)
                                          : excessBeside(sample, glm::dvec3(offset) * step) -
                                                excessBeside(sample, glm::dvec3(offset) * -step);
    }
    const double steepness = glm::length(slope) / (2 * step);
    return std::isfinite(steepness) ? std::abs(excess) / std::max(steepness, 1e-12) : HUGE_VAL;
  }

private:
  double excessBeside(glm::ivec3 sample, glm::dvec3 offsetVoxels) const {
    return test_.excess(grid_.sample(brick_, sample) + grid_.voxelSize * offsetVoxels);
  }

  const SampleGrid& grid_;
  const InsideTest& test_;
  glm::ivec3 brick_;
  std::vector<double> excesses_;
};

struct MembraneBrick {
  BrickSamples samples;
  std::array<std::uint8_t, kSamples> inside;
  float least = 0; ///< distance to anything
};

MembraneBrick measure(const SamplingRequest& request, const InsideTest& test, glm::ivec3 brick) {
  MembraneBrick result;
  sampleBrick(request, brick, false, result.samples);
  const ExcessLattice lattice(request.grid, test, brick);
  result.least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < kSamples; ++i) {
    const glm::ivec3 sample = sampleOfIndex(i);
    float& distance = result.samples.solidDistances[i];
    result.inside[i] = lattice.at(sample) >= 0;
    distance = std::min(distance, static_cast<float>(lattice.membraneVoxels(sample, distance)));
    result.least = std::min(result.least, distance);
    if (request.surfaces->sheets) result.least = std::min(result.least, std::abs(result.samples.sheetDistances[i]));
  }
  return result;
}

/// Steps over cells, diagonal ones included, to the nearest of `sources`.
std::vector<int> stepsFrom(const SampleGrid& grid, const std::vector<std::uint32_t>& sources) {
  std::vector<int> steps(grid.cellCount(), -1);
  std::vector<std::uint32_t> front = sources, next;
  for (const std::uint32_t cell : sources) steps[cell] = 0;
  for (int step = 1; !front.empty(); ++step, front.swap(next), next.clear())
    for (const std::uint32_t cell : front)
      forEachAround(grid, cell, [&](std::size_t neighbour) {
        if (steps[neighbour] >= 0) return;
        steps[neighbour] = step;
        next.push_back(static_cast<std::uint32_t>(neighbour));
      });
  return steps;
}

} // namespace

void insertMembranes(const SamplingRequest& request, const InsideTest& test, LevelSamples& level, LevelSigns& signs) {
  if (signs.mixedCells.empty()) return;
  const std::vector<int> steps = stepsFrom(request.grid, signs.mixedCells);
  std::vector<std::uint32_t> cells;
  for (std::uint32_t cell = 0; cell < steps.size(); ++cell) {
    if (steps[cell] <= 1) cells.push_back(cell);
    const float reach = static_cast<float>(kBrickCells * std::max(0, steps[cell] - 1));
    if (steps[cell] > 1) level.cellBounds[cell] = std::min(level.cellBounds[cell], reach);
  }
  request.admit(level.brickCount() + cells.size());
  std::vector<MembraneBrick> bricks(cells.size());
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) {
    bricks[i] = measure(request, test, request.grid.brickOfCell(cells[i]));
    request.done(0);
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t cell = cells[i];
    float& bound = level.cellBounds[cell];
    bound = std::min(bound, boundBySamples(bricks[i].least));
    if (steps[cell] > 0 && level.brickOfCell[cell] == kNoBrick && bound > kTouchVoxels) continue;
    storeBrick(request, cell, bricks[i].samples, level);
    signs.sampleInside.resize(level.brickCount() * kSamples);
    std::copy(bricks[i].inside.begin(), bricks[i].inside.end(),
              signs.sampleInside.begin() + static_cast<std::ptrdiff_t>(level.brickOfCell[cell] * kSamples));
  }
}

} // namespace brickfield
