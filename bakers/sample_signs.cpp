// Cells are first looked at in blocks.
#include "bakers/sample_signs.h"

#include <algorithm>
#include <optional>

#include "bakers/brick_sampler.h"
#include "bakers/each_uneven.h"
#include "bakers/rim_turns.h"
#include "bakers/sample_links.h"

namespace brickfield {

namespace {

constexpr std::size_t kMostSides = 4;   // of one half and whole turns more, in a cube
constexpr std::size_t kMostUnsure = 16; // twice what smaller cubes would ask

class CellAsker {
public:
  CellAsker(const SampleGrid& grid, glm::ivec3 cell, const InsideTest& test, const float* distances)
      : grid_(grid),
        cell_(cell),
        test_(test),
        near_(test.nearRims(pointAt(SampleCube{}.centerVoxels()), SampleCube{}.radiusVoxels() * grid.voxelSize)),
        distances_(distances ? distances : nowhere().data()),
        links_(distances_),
        offSurface_(samplesOffSurface(distances_)) {}

  SampleSigns run() {
    if (near_) {
      const RimTurns rims(*test_.rims(), pointAt(glm::dvec3(0.0)), grid_.voxelSize);
      if (rims.areMeasured()) {
        askByTurns(rims);
        return signs_;
      }
    }
    ask(SampleCube{});
    return signs_;
  }

private:
  /// Distances of a cell that no triangle comes into.
  static const std::array<float, kBrickSampleCount>& nowhere() {
    static const std::array<float, kBrickSampleCount> far = [] {
      std::array<float, kBrickSampleCount> distances;
      distances.fill(static_cast<float>(kSampledRangeVoxels));
      return distances;
    }();
    return far;
  }

  /// The deepest sample of each group tells by which whole number rims and curtains are off in all of it.
  void askByTurns(const RimTurns& rims) {
    rims.cut(links_);
    SampleMask left = rims.known(), unknown = offSurface_;
    for (std::size_t z = 0; z < left.size(); ++z) left[z] &= offSurface_[z], unknown[z] &= ~left[z];
    forEachSample(unknown, [&](std::size_t i) { signs_[i] = isInside(sampleOfIndex(i)); });
    for (std::size_t z = 0; z < left.size(); ++z)
      while (left[z] != 0) {
        const SampleMask group = links_.flood(64 * z + static_cast<std::size_t>(std::countr_zero(left[z])), left);
        const glm::ivec3 deepest = sampleOfIndex(deepestOf(group, distances_));
        const double turns = test_.nearlyTurns(grid_.sample(cell_, deepest), *near_).turns;
        const double whole = std::round(turns - rims.at(sampleIndex(deepest)).turns);
        forEachSample(group, [&](std::size_t i) {
          const auto [ofRims, slack] = rims.at(i);
          const bool isInsideHere = test_.isInsideBy(ofRims + whole - slack);
          const bool isClear = isInsideHere == test_.isInsideBy(ofRims + whole + slack);
          signs_[i] = isClear ? isInsideHere : isInside(sampleOfIndex(i));
        });
      }
  }

  void ask(const SampleCube& cube) {
    if (cube.side == 1) return askOne(cube.first);
    const double radius = cube.radiusVoxels() * grid_.voxelSize;
    if (near_) {
      const std::optional<WindingAround> around = near_->around(pointAt(cube.centerVoxels()), radius);
      if (around && askBySides(cube, *around)) return;
    } else if (test_.isSteady(pointAt(cube.centerVoxels()), radius)) {
      return askGroups(samplesOf(cube)); // very many rims
    }
    for (int i = 0; i < 8; ++i) ask(cube.eighth(i));
  }
  void askOne(glm::ivec3 sample) { signs_[sampleIndex(sample)] = isInside(sample); }
  bool isInside(glm::ivec3 sample) const {
    return test_.isInside(grid_.sample(cell_, sample), near_ ? &*near_ : nullptr);
  }

  static SampleMask samplesOf(const SampleCube& cube) {
    SampleMask mask{};
    cube.forEach([&](glm::ivec3 sample) { mask[sampleIndex(sample) / 64] |= bitOf(sample); });
    return mask;
  }
  static std::uint64_t bitOf(glm::ivec3 sample) { return std::uint64_t{1} << (sampleIndex(sample) % 64); }

  /// By groups on the same side of one half, as far as that is known; a way between two of them keeps to their side, as
  /// what is known holds on it too. Other samples are asked one by one.
  ///
  /// returns  false, and has asked nothing, where those are so many that smaller cubes are better
  bool askBySides(const SampleCube& cube, const WindingAround& around) {
    const glm::dvec3 center = pointAt(cube.centerVoxels());
    if (around.leastFromHalf(glm::dvec3(0.0), cube.radiusVoxels() * grid_.voxelSize) > 0) {
      askGroups(samplesOf(cube));
      return true;
    }
    std::array<SampleMask, kMostSides> sides{};
    std::array<glm::ivec3, kMostUnsure> unsure;
    std::size_t unsureCount = 0;
    bool isSplit = false;
    cube.forEach([&](glm::ivec3 sample) {
      const glm::dvec3 offset = grid_.sample(cell_, sample) - center;
      const double side = std::floor(around.at(offset) + 0.5) + kMostSides / 2;
      if (side >= 0 && side < kMostSides && around.leastFromHalf(offset, 0.0) > 0)
        sides[static_cast<std::size_t>(side)][sampleIndex(sample) / 64] |= bitOf(sample);
      else if (unsureCount < unsure.size())
        unsure[unsureCount++] = sample;
      else
        isSplit = true;
    });
    if (isSplit) return false;
    for (const SampleMask& side : sides) askGroups(side);
    for (std::size_t i = 0; i < unsureCount; ++i) askOne(unsure[i]);
    return true;
  }

  /// The deepest sample of each group answers for it. Those on the surface have no side: outside.
  void askGroups(SampleMask left) {
    for (std::size_t z = 0; z < left.size(); ++z) left[z] &= offSurface_[z];
    for (std::size_t z = 0; z < left.size(); ++z)
      while (left[z] != 0) {
        const SampleMask group = links_.flood(64 * z + static_cast<std::size_t>(std::countr_zero(left[z])), left);
        answer(deepestOf(group, distances_), group);
      }
  }
  void answer(std::size_t sample, const SampleMask& group) {
    if (isInside(sampleOfIndex(sample))) forEachSample(group, [&](std::size_t i) { signs_[i] = 1; });
  }

  glm::dvec3 pointAt(glm::dvec3 voxels) const {
    return grid_.origin + grid_.voxelSize * (glm::dvec3(kBrickCells * cell_) + voxels);
  }

  const SampleGrid& grid_;
  glm::ivec3 cell_;
  const InsideTest& test_;
  const std::optional<NearRims> near_; ///< of the cell; nothing: there are none or very many
  const float* distances_;
  SampleLinks links_;
  SampleMask offSurface_;
  SampleSigns signs_{};
};

constexpr int kBlockCells = 8;
constexpr int kCellHalvings = 3; // what a fourth would clear costs more than it saves

class CellBlocks {
public:
  CellBlocks(const SampleGrid& grid, const InsideTest& test) : grid_(grid), test_(test), steady_(grid.cellCount(), 0) {}

  std::vector<std::uint8_t> run() {
    const glm::ivec3 blocks = (grid_.brickCounts + kBlockCells - 1) / kBlockCells;
    forEachUneven(static_cast<std::size_t>(blocks.x * blocks.y * blocks.z), 1, [&](std::size_t number) {
      const auto i = static_cast<int>(number);
      look(kBlockCells * glm::ivec3(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y)), kBlockCells);
    });
    return std::move(steady_);
  }

private:
  void look(glm::ivec3 first, int side) {
    const glm::ivec3 end = glm::min(first + side, grid_.brickCounts);
    if (glm::any(glm::greaterThanEqual(first, end))) return;
    const glm::dvec3 low = grid_.sample(first, glm::ivec3(0)), high = grid_.sample(end, glm::ivec3(0));
    if (isSteady(0.5 * (low + high), high - low, side == 1)) {
      for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
          for (int x = first.x; x < end.x; ++x) steady_[grid_.cellOfBrick({x, y, z})] = 1;
    } else if (side > 1) {
      for (int i = 0; i < 8; ++i) look(first + side / 2 * glm::ivec3(i & 1, i >> 1 & 1, i >> 2), side / 2);
    }
  }

  bool isSteady(glm::dvec3 center, glm::dvec3 extent, bool isCell) const {
    const double radius = 0.5000001 * glm::length(extent);
    if (test_.isSteady(center, radius)) return true;
    if (!isCell) return false;
    const std::optional<NearRims> near = test_.nearRims(center, radius);
    return near && isSteadyByParts(*near, center, extent, kCellHalvings);
  }
  /// Whether the answer is steady in all eighths of a box: then it cannot change on a way through several.
  ///
  /// halvings  so often may the box be cut
  static bool isSteadyByParts(const NearRims& near, glm::dvec3 center, glm::dvec3 extent, int halvings) {
    const double radius = 0.2500001 * glm::length(extent);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner(i & 1 ? 0.25 : -0.25, i & 2 ? 0.25 : -0.25, i & 4 ? 0.25 : -0.25);
      const std::optional<WindingAround> around = near.around(center + corner * extent, radius);
      if (around && around->leastFromHalf(glm::dvec3(0.0), radius) > 0) continue;
      if (halvings == 1 || !isSteadyByParts(near, center + corner * extent, 0.5 * extent, halvings - 1)) return false;
    }
    return true;
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
