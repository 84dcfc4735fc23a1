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
    bound.voxels = std::max(0.0, closest.distance / request.grid.voxelSize - request.solidGrowthVoxels);
  }
  if (request.surfaces->sheets) {
    const ClosestTriangle closest = request.surfaces->sheets->closest(point, HUGE_VAL, hints.sheet);
    hints.sheet = closest.triangle;
    const SheetSlabs& slabs = *request.surfaces->slabs;
    const double fromSlab = slabs.distance(point, closest, request.halfThickness);
    bound.inSheet = fromSlab < 0;
    // A slab behind another sheet's triangle may reach this much nearer than the closest triangle's own.
    const double least =
        slabs.areAllCentred() ? std::abs(fromSlab) : closest.distance - SheetSlabs::depthOf(request.halfThickness);
    bound.voxels = std::min(bound.voxels, std::max(least, 0.0) / request.grid.voxelSize);
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
struct SurfaceSampler {
  const SampleGrid& grid;
  const MeshDistance& surface;
  const SheetSlabs* slabs; ///< nothing: the distance is the triangles' own
  double halfThickness;    ///< of the slabs
  bool isCapped;

  void run(glm::ivec3 brick, float* distances, std::uint32_t* triangles) const {
    const double cap = kSampledRangeVoxels * grid.voxelSize + (slabs ? SheetSlabs::depthOf(halfThickness) : 0.0);
    std::uint32_t rowHint = kNoTriangle, layerHint = kNoTriangle;
    std::size_t i = 0;
    for (int z = 0; z < kBrickSamples; ++z)
      for (int y = 0; y < kBrickSamples; ++y) {
        std::uint32_t hint = y == 0 ? layerHint : rowHint;
        for (int x = 0; x < kBrickSamples; ++x, ++i) {
          const double limit = isCapped && i > 0 ? cap : HUGE_VAL;
          const glm::dvec3 point = grid.sample(brick, {x, y, z});
          const ClosestTriangle closest = surface.closest(point, limit, hint);
          double distance = kSampledRangeVoxels * grid.voxelSize;
          if (closest.triangle != kNoTriangle) {
            hint = closest.triangle;
            distance = slabs ? slabs->distance(point, closest, halfThickness) : closest.distance;
          }
          distances[i] = static_cast<float>(distance / grid.voxelSize);
          triangles[i] = hint;
          if (x == 0) rowHint = hint;
          if (x == 0 && y == 0) layerHint = hint;
        }
      }
  }
};

float leastDistance(const SamplingRequest& request, const BrickSamples& samples) {
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < kSamples; ++i) {
    if (request.surfaces->solid)
      least = std::min(least, samples.solidDistances[i] - static_cast<float>(request.solidGrowthVoxels));
    if (request.surfaces->sheets) least = std::min(least, std::abs(samples.sheetDistances[i]));
  }
  return least;
}

/// Copies a brick's samples to a slot of the level's arrays.
void putBrick(const SamplingRequest& request, std::size_t slot, const BrickSamples& samples, LevelSamples& level) {
  const auto put = [slot](const auto& from, auto& to) {
    std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(slot * kSamples));
  };
  if (request.surfaces->solid)
    put(samples.solidDistances, level.solidDistances), put(samples.solidTriangles, level.solidTriangles);
  if (request.surfaces->sheets)
    put(samples.sheetDistances, level.sheetDistances), put(samples.sheetTriangles, level.sheetTriangles);
}

void resizeBricks(const SamplingRequest& request, std::size_t count, LevelSamples& level) {
  if (request.surfaces->solid)
    level.solidDistances.resize(count * kSamples), level.solidTriangles.resize(count * kSamples);
  if (request.surfaces->sheets)
    level.sheetDistances.resize(count * kSamples), level.sheetTriangles.resize(count * kSamples);
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
    float& cellBound = level.cellBounds[candidates[slot]];
    cellBound = std::max(cellBound, boundBySamples(leastVoxels[slot]));
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

float boundBySamples(float leastVoxels) {
  return static_cast<float>(static_cast<double>(leastVoxels) - kFaceHalfDiagonalVoxels - kBoundSlackVoxels);
}

void sampleBrick(const SamplingRequest& request, glm::ivec3 brick, bool isCapped, BrickSamples& samples) {
  const BakeSurfaces& surfaces = *request.surfaces;
  if (surfaces.solid)
    SurfaceSampler{request.grid, *surfaces.solid, nullptr, 0, isCapped}.run(brick, samples.solidDistances.data(),
                                                                            samples.solidTriangles.data());
  if (surfaces.sheets)
    SurfaceSampler{request.grid, *surfaces.sheets, &*surfaces.slabs, request.halfThickness, isCapped}.run(
        brick, samples.sheetDistances.data(), samples.sheetTriangles.data());
}

void storeBrick(const SamplingRequest& request, std::size_t cell, const BrickSamples& samples, LevelSamples& level) {
  std::uint32_t& slot = level.brickOfCell[cell];
  if (slot == kNoBrick) {
    slot = static_cast<std::uint32_t>(level.brickCount());
    level.cellOfBrick.push_back(static_cast<std::uint32_t>(cell));
    resizeBricks(request, level.brickCount(), level);
  }
  putBrick(request, slot, samples, level);
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
  std::vector<float> leastVoxels(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t slot) {
    BrickSamples samples;
    sampleBrick(request, request.grid.brickOfCell(candidates[slot]), !request.isComplete, samples);
    leastVoxels[slot] = leastDistance(request, samples);
    putBrick(request, slot, samples, level);
    request.done(1);
  });
  dropBricks(level, candidates, leastVoxels, request.isComplete);
  return level;
}

} // namespace brickfield
