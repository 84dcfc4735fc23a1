// Cells are first looked at in blocks.
#include "bakers/sample_signs.h"

#include <algorithm>
#include <optional>

#include <tbb/parallel_for.h>

#include "bakers/sample_links.h"

namespace brickfield {

namespace {

class CellAsker {
public:
  CellAsker(const SampleGrid& grid, glm::ivec3 cell, const InsideTest& test, const float* distances)
      : grid_(grid), cell_(cell), test_(test), distances_(distances) {
    if (distances) links_.emplace(distances);
  }

  SampleSigns run() {
    ask(SampleCube{});
    return signs_;
  }

private:
  void ask(const SampleCube& cube) {
    if (cube.side > 1 && !isSteady(cube)) {
      for (int i = 0; i < 8; ++i) ask(cube.eighth(i));
    } else if (links_ && cube.side > 1) {
      askGroups(cube);
    } else {
      const std::uint8_t sign = test_.isInside(pointAt(cube.centerVoxels()));
      cube.forEach([&](glm::ivec3 sample) { signs_[sampleIndex(sample)] = sign; });
    }
  }

  /// The deepest sample of each group answers for it. Those on the surface have no side: outside.
  void askGroups(const SampleCube& cube) {
    SampleMask left{};
    cube.forEach([&](glm::ivec3 sample) {
      const std::size_t i = sampleIndex(sample);
      left[i / 64] |= std::uint64_t{distances_[i] > 0} << (i % 64);
    });
    for (std::size_t z = 0; z < left.size(); ++z)
      while (left[z] != 0) {
        const SampleMask group = links_->flood(64 * z + static_cast<std::size_t>(std::countr_zero(left[z])), left);
        const std::uint8_t sign = test_.isInside(grid_.sample(cell_, sampleOfIndex(deepestOf(group, distances_))));
        if (sign) forEachSample(group, [&](std::size_t i) { signs_[i] = sign; });
      }
  }

  bool isSteady(const SampleCube& cube) const {
    return test_.isSteady(pointAt(cube.centerVoxels()), cube.radiusVoxels() * grid_.voxelSize);
  }
  glm::dvec3 pointAt(glm::dvec3 voxels) const {
    return grid_.origin + grid_.voxelSize * (glm::dvec3(kBrickCells * cell_) + voxels);
  }

  const SampleGrid& grid_;
  glm::ivec3 cell_;
  const InsideTest& test_;
  const float* distances_;
  std::optional<SampleLinks> links_;
  SampleSigns signs_{};
};

constexpr int kBlockCells = 8;

class CellBlocks {
public:
  CellBlocks(const SampleGrid& grid, const InsideTest& test) : grid_(grid), test_(test), steady_(grid.cellCount(), 0) {}

  std::vector<std::uint8_t> run() {
    const glm::ivec3 blocks = (grid_.brickCounts + kBlockCells - 1) / kBlockCells;
    tbb::parallel_for(0, blocks.x * blocks.y * blocks.z, [&](int i) {
      look(kBlockCells * glm::ivec3(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y)), kBlockCells);
    });
    return std::move(steady_);
  }

private:
  void look(glm::ivec3 first, int side) {
    const glm::ivec3 end = glm::min(first + side, grid_.brickCounts);
    if (glm::any(glm::greaterThanEqual(first, end))) return;
    const glm::dvec3 low = grid_.sample(first, glm::ivec3(0)), high = grid_.sample(end, glm::ivec3(0));
    if (test_.isSteady(0.5 * (low + high), 0.5000001 * glm::length(high - low))) {
      for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
          for (int x = first.x; x < end.x; ++x) steady_[grid_.cellOfBrick({x, y, z})] = 1;
    } else if (side > 1) {
      for (int i = 0; i < 8; ++i) look(first + side / 2 * glm::ivec3(i & 1, i >> 1 & 1, i >> 2), side / 2);
    }
  }

  const SampleGrid& grid_;
  const InsideTest& test_;
  std::vector<std::uint8_t> steady_;
};

} // namespace

SampleSigns askSamples(const SampleGrid& grid, glm::ivec3 cell, const InsideTest& test, const float* distances) {
  return CellAsker(grid, cell, test, distances).run();
}

std::vector<std::uint8_t> findSteadyCells(const SampleGrid& grid, const InsideTest& test) {
  if (test.isConstantBetweenSurfaces()) return std::vector<std::uint8_t>(grid.cellCount(), 1);
  return CellBlocks(grid, test).run();
}

} // namespace brickfield
