// Cells first, by one query each; then the samples of the cells that are left. Every query starts from the triangle
// that its neighbour found, and ends at the range: what lies beyond is clamped anyway, and the flood of signs only asks
// whether two neighbours are farther from the surface than from each other.
#include "bakers/level_sampler.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace brickfield {

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;
// The range plus what rounding and the encoding's half step might still want to see.
constexpr double kSampledRangeVoxels = kNarrowBandVoxels + 0.0625;
// A point of a brick's surface is at most half a cell's face diagonal from a sample of it.
constexpr double kFaceHalfDiagonalVoxels = 0.70710679;
constexpr double kEighthHalfDiagonalVoxels = 0.5 * kBrickHalfDiagonalVoxels;
constexpr double kBoundSlackVoxels = 1e-3; // over the rounding of double and of the float that stores the bound

/// Triangles that the last query found.
struct Hints {
  std::uint32_t solid = kNoTriangle, sheet = kNoTriangle;
};

/// Lower bound, in voxels, of the distance to any surface at a point; and whether a slab holds it.
struct PointBound {
  double voxels = std::numeric_limits<double>::infinity();
  bool inSheet = false;
};

PointBound boundAt(const SamplingRequest& request, glm::dvec3 point, Hints& hints) {
  PointBound bound;
  if (request.surfaces->solid) {
    const ClosestTriangle closest = request.surfaces->solid->closest(point, HUGE_VAL, hints.solid);
    hints.solid = closest.triangle;
    bound.voxels = closest.distance / request.grid.voxelSize;
  }
  if (request.surfaces->sheets) {
    const ClosestTriangle closest = request.surfaces->sheets->closest(point, HUGE_VAL, hints.sheet);
    hints.sheet = closest.triangle;
    const double fromSlab = closest.distance - request.halfThickness;
    bound.inSheet = fromSlab < 0;
    bound.voxels = std::min(bound.voxels, std::abs(fromSlab) / request.grid.voxelSize);
  }
  return bound;
}

/// Bound over a whole cell. Cells that the centre cannot clear are looked at by eighths.
float cellBound(const SamplingRequest& request, glm::ivec3 brick, Hints& hints, bool& inSheet) {
  const glm::dvec3 center = request.grid.brickCenter(brick);
  const PointBound atCenter = boundAt(request, center, hints);
  inSheet = atCenter.inSheet;
  const double byCenter = atCenter.voxels - kBrickHalfDiagonalVoxels - kBoundSlackVoxels;
  if (byCenter > kTouchVoxels || byCenter < -kEighthHalfDiagonalVoxels) return static_cast<float>(byCenter);
  const double quarter = 0.25 * kBrickCells * request.grid.voxelSize;
  double byEighths = std::numeric_limits<double>::infinity();
  Hints eighthHints = hints;
  for (int i = 0; i < 8 && byEighths > kTouchVoxels; ++i) {
    const glm::dvec3 corner(i & 1 ? quarter : -quarter, i & 2 ? quarter : -quarter, i & 4 ? quarter : -quarter);
    const double bound = boundAt(request, center + corner, eighthHints).voxels;
    byEighths = std::min(byEighths, bound - kEighthHalfDiagonalVoxels - kBoundSlackVoxels);
  }
  return static_cast<float>(std::max(byCenter, byEighths));
}

void boundCells(const SamplingRequest& request, LevelSamples& level) {
  level.cellBounds.resize(request.grid.cellCount());
  level.cellInSheet.resize(request.grid.cellCount());
  const auto rows =
      static_cast<std::size_t>(request.grid.brickCounts.y) * static_cast<std::size_t>(request.grid.brickCounts.z);
  const auto rowLength = static_cast<std::size_t>(request.grid.brickCounts.x);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    Hints hints;
    for (std::size_t cell = row * rowLength; cell < (row + 1) * rowLength; ++cell) {
      bool inSheet = false;
      level.cellBounds[cell] = cellBound(request, request.grid.brickOfCell(cell), hints, inSheet);
      level.cellInSheet[cell] = inSheet;
    }
    request.done(0);
  });
}

/// One surface's distances at the 512 samples of a brick. Each query starts from the sample before it along x, at the
/// row's start from the row before; the very first is not capped, so that there always is a triangle to start from.
struct BrickSampler {
  const SamplingRequest& request;
  const MeshDistance& surface;
  double offset; ///< taken off the distance

  void run(glm::ivec3 brick, float* distances, std::uint32_t* triangles) const {
    const double voxelSize = request.grid.voxelSize;
    const double cap = kSampledRangeVoxels * voxelSize + offset;
    std::uint32_t rowHint = kNoTriangle, layerHint = kNoTriangle;
    std::size_t i = 0;
    for (int z = 0; z < kBrickSamples; ++z)
      for (int y = 0; y < kBrickSamples; ++y) {
        std::uint32_t hint = y == 0 ? layerHint : rowHint;
        for (int x = 0; x < kBrickSamples; ++x, ++i) {
          const bool isCapped = !request.isComplete && i > 0;
          const ClosestTriangle closest =
              surface.closest(request.grid.sample(brick, {x, y, z}), isCapped ? cap : HUGE_VAL, hint);
          if (closest.triangle != kNoTriangle) hint = closest.triangle;
          const double distance = closest.triangle != kNoTriangle ? closest.distance : cap;
          distances[i] = static_cast<float>((distance - offset) / voxelSize);
          triangles[i] = hint;
          if (x == 0) rowHint = hint;
          if (x == 0 && y == 0) layerHint = hint;
        }
      }
  }
};

/// Distances of one brick to solids and sheets; returns the least to any surface.
float sampleBrick(const SamplingRequest& request, LevelSamples& level, std::size_t slot, glm::ivec3 brick) {
  float least = std::numeric_limits<float>::infinity();
  const std::size_t begin = slot * kSamples;
  const auto take = [&](const std::optional<MeshDistance>& surface, std::vector<float>& distances,
                        std::vector<std::uint32_t>& triangles, double offset) {
    if (!surface) return;
    BrickSampler{request, *surface, offset}.run(brick, &distances[begin], &triangles[begin]);
    for (std::size_t i = begin; i < begin + kSamples; ++i) least = std::min(least, std::abs(distances[i]));
  };
  take(request.surfaces->solid, level.solidDistances, level.solidTriangles, 0);
  take(request.surfaces->sheets, level.sheetDistances, level.sheetTriangles, request.halfThickness);
  return least;
}

template <typename Value>
void keepBricks(std::vector<Value>& values, const std::vector<std::size_t>& kept) {
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
    const double bound = static_cast<double>(leastVoxels[slot]) - kFaceHalfDiagonalVoxels - kBoundSlackVoxels;
    float& cellBound = level.cellBounds[candidates[slot]];
    cellBound = std::max(cellBound, static_cast<float>(bound));
    if (isComplete || isBrickStored(cellBound)) kept.push_back(slot);
  }
  keepBricks(level.solidDistances, kept);
  keepBricks(level.solidTriangles, kept);
  keepBricks(level.sheetDistances, kept);
  keepBricks(level.sheetTriangles, kept);
  for (const std::size_t slot : kept) {
    level.brickOfCell[candidates[slot]] = static_cast<std::uint32_t>(level.cellOfBrick.size());
    level.cellOfBrick.push_back(candidates[slot]);
  }
}

} // namespace

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
  if (request.surfaces->solid) {
    level.solidDistances.resize(candidates.size() * kSamples);
    level.solidTriangles.resize(candidates.size() * kSamples);
  }
  if (request.surfaces->sheets) {
    level.sheetDistances.resize(candidates.size() * kSamples);
    level.sheetTriangles.resize(candidates.size() * kSamples);
  }
  std::vector<float> leastVoxels(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t slot) {
    leastVoxels[slot] = sampleBrick(request, level, slot, request.grid.brickOfCell(candidates[slot]));
    request.done(1);
  });
  dropBricks(level, candidates, leastVoxels, request.isComplete);
  return level;
}

} // namespace brickfield
