// The centres of cells are a lattice like the samples of a brick, seven voxels wide: what measures bricks measures them
// too, where triangles are few. Else cells are walked to one after another, along rows.
#include "bakers/cell_bounds.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "bakers/block_distance.h"
#include "bakers/brick_sampler.h"

namespace brickfield {

namespace {

constexpr double kEighthHalfDiagonalVoxels = 0.5 * kBrickHalfDiagonalVoxels;
constexpr double kBoundSlackVoxels = 1e-3; // over the rounding of double and of the float that stores the bound
constexpr double kBlockSlack = 1e-5;       // share of a distance: over the error of a block, and that of double

/// Distances from the centres of cells to one surface, of 8^3 cells at once: where triangles are not many more than
/// those cells, that is several times faster than a walk each.
class CellCenters {
public:
  CellCenters(const SampleGrid& grid, const MeshDistance& surface)
      : grid_(grid), surface_(surface), found_(grid.cellCount()) {
    const glm::ivec3 blocks = (grid.brickCounts + kBrickSamples - 1) / kBrickSamples;
    tbb::parallel_for(0, blocks.x * blocks.y * blocks.z, [&](int i) {
      measure(kBrickSamples * glm::ivec3(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y)));
    });
  }

  /// Within kBlockSlack of the distance; no triangle where a walk is needed.
  NearestTriangle at(std::size_t cell) const {
    const Found& found = found_[cell];
    return {static_cast<double>(found.distance) * spacing(), found.triangle, kNoLeaf};
  }

private:
  struct Found {
    float distance = 0; ///< between neighbours is 1
    std::uint32_t triangle = kNoTriangle;
  };

  double spacing() const { return kBrickCells * grid_.voxelSize; }

  /// first  of the cells of a block
  void measure(glm::ivec3 first) {
    const glm::ivec3 count = glm::min(grid_.brickCounts - first, kBrickSamples);
    const double halfEdge = 0.5 * (kBrickSamples - 1) * spacing();
    const SampleBlock block{grid_.origin + spacing() * (glm::dvec3(first) + 0.5 * kBrickSamples), spacing()};
    const NearestTriangle nearest = surface_.nearest(block.center);
    // No centre is farther from its closest triangle than from that one, as far as a corner at most.
    double reach = 0;
    const auto corners = surface_.hierarchy().soup().corners(nearest.triangle);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner = block.center + halfEdge * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      reach = std::max(reach, glm::length(corner - closestPointOnTriangle(corner, corners).point));
    }
    std::array<std::uint32_t, kMostBlockTriangles> near;
    const auto cells = static_cast<std::size_t>(count.x * count.y * count.z);
    const std::span<std::uint32_t> place = std::span(near).first(std::min(kTrianglesACell * cells, near.size()));
    const std::size_t triangleCount = surface_.collect({block.center, halfEdge, reach}, place);
    if (triangleCount > place.size()) return;
    std::sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(triangleCount));
    const std::span<const std::uint32_t> triangles = place.first(triangleCount);
    SampleRows rows{};
    for (int z = 0; z < count.z; ++z)
      for (int y = 0; y < count.y; ++y)
        rows[static_cast<std::size_t>(y + kBrickSamples * z)] = static_cast<std::uint8_t>((1u << count.x) - 1);
    std::array<float, kBrickSampleCount> distances;
    std::array<std::uint32_t, kBrickSampleCount> closest;
    const auto most = static_cast<float>(reach / spacing() + 1);
    blockDistances({&surface_.hierarchy().soup(), triangles, block, rows, most}, distances, closest);
    for (int z = 0; z < count.z; ++z)
      for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x) {
          const std::size_t i = sampleIndex({x, y, z});
          found_[grid_.cellOfBrick(first + glm::ivec3(x, y, z))] = {distances[i], closest[i]};
        }
  }

  static constexpr std::size_t kTrianglesACell = 2; // more cost as much as walks

  const SampleGrid& grid_;
  const MeshDistance& surface_;
  std::vector<Found> found_; ///< a cell
};

/// Lower bound, in voxels, of the distance to any surface at a point; and whether a slab holds it.
struct PointBound {
  double voxels = std::numeric_limits<double>::infinity();
  bool inSheet = false;
  std::uint32_t triangle = kNoTriangle; ///< that it comes from
};

/// A query that knows how far the last one was from its surface: a walk of so much farther is the most that can follow.
class PathOfPoints {
public:
  explicit PathOfPoints(const MeshDistance& surface) : surface_(surface) {}

  /// limit  nothing is found where the surface is farther away
  NearestTriangle nearest(glm::dvec3 point, double limit = HUGE_VAL) {
    distance_ = (distance_ + glm::length(point - point_)) * kPathSlack, point_ = point;
    return take(surface_.nearest(point, std::min(distance_, limit), leaf_));
  }
  /// What is known of a point, to kBlockSlack.
  NearestTriangle start(glm::dvec3 point, NearestTriangle known) {
    point_ = point;
    take(known);
    distance_ *= 1 + kBlockSlack;
    return known;
  }
  const MeshDistance& surface() const { return surface_; }

private:
  static constexpr double kPathSlack = 1.0 + 1e-9; // over the rounding of the sum

  NearestTriangle take(NearestTriangle found) {
    if (found.triangle != kNoTriangle) distance_ = found.distance, leaf_ = found.leaf;
    return found;
  }

  const MeshDistance& surface_;
  glm::dvec3 point_{0.0};
  double distance_ = std::numeric_limits<double>::infinity(); ///< at most; of the point
  std::uint32_t leaf_ = kNoLeaf;
};

/// Bounds at one point after another.
class BoundPath {
public:
  explicit BoundPath(const SamplingRequest& request) : request_(request) {
    if (request.surfaces->solid) solid_.emplace(*request.surfaces->solid);
    if (request.surfaces->sheets) sheets_.emplace(*request.surfaces->sheets);
  }

  PointBound at(glm::dvec3 point) {
    PointBound bound;
    if (solid_) bound = boundBySolid(solid_->nearest(point));
    if (sheets_) addSheets(point, sheets_->nearest(point, bound.voxels * voxelSize() + reach()), bound);
    return bound;
  }

  /// At the centre of a cell.
  PointBound atCell(glm::ivec3 brick, const CellCenters* solids, const CellCenters* sheets) {
    const glm::dvec3 center = request_.grid.brickCenter(brick);
    const std::size_t cell = request_.grid.cellOfBrick(brick);
    PointBound bound;
    if (solid_) bound = boundBySolid(nearestTo(center, cell, *solid_, solids, HUGE_VAL));
    if (sheets_)
      addSheets(center, nearestTo(center, cell, *sheets_, sheets, bound.voxels * voxelSize() + reach()), bound);
    return bound;
  }

private:
  double voxelSize() const { return request_.grid.voxelSize; }
  double reach() const { return request_.surfaces->slabs->mostReach(request_.halfThickness); }

  static NearestTriangle nearestTo(glm::dvec3 point, std::size_t cell, PathOfPoints& path, const CellCenters* centers,
                                   double limit) {
    const NearestTriangle known = centers ? centers->at(cell) : NearestTriangle{};
    return known.triangle != kNoTriangle ? path.start(point, known) : path.nearest(point, limit);
  }

  PointBound boundBySolid(NearestTriangle nearest) const {
    return {std::max(0.0, nearest.distance * (1 - kBlockSlack) / voxelSize() - request_.solidGrowthVoxels), false,
            nearest.triangle};
  }
  void addSheets(glm::dvec3 point, NearestTriangle nearest, PointBound& bound) const {
    const SheetSlabs& slabs = *request_.surfaces->slabs;
    if (nearest.triangle == kNoTriangle || nearest.distance > bound.voxels * voxelSize() + reach()) return;
    const PointOnTriangle on = closestPointOnTriangle(point, request_.soup->corners(nearest.triangle));
    const ClosestTriangle closest{glm::length(point - on.point), nearest.triangle, on};
    const double fromSlab = slabs.distance(point, closest, request_.halfThickness);
    bound.inSheet = fromSlab < 0;
    // A slab behind another sheet's triangle may reach this much nearer than the closest triangle's own.
    const double least = slabs.areAllCentred() ? std::abs(fromSlab) : closest.distance - reach();
    const double voxels = std::max(least - kBlockSlack * closest.distance, 0.0) / voxelSize();
    if (voxels < bound.voxels) bound.voxels = voxels, bound.triangle = nearest.triangle;
  }

  const SamplingRequest& request_;
  std::optional<PathOfPoints> solid_, sheets_;
};

/// Bound over a whole cell. Cells that the centre cannot clear are looked at by eighths, until one may be touched: by
/// how much is of no interest.
float cellBound(const SamplingRequest& request, glm::ivec3 brick, const CellCenters* solids, const CellCenters* sheets,
                BoundPath& path, bool& inSheet) {
  const PointBound atCenter = path.atCell(brick, solids, sheets);
  inSheet = atCenter.inSheet;
  const double byCenter = atCenter.voxels - kBrickHalfDiagonalVoxels - kBoundSlackVoxels;
  if (byCenter > kTouchVoxels || byCenter < -kEighthHalfDiagonalVoxels) return static_cast<float>(byCenter);
  const glm::dvec3 center = request.grid.brickCenter(brick);
  const double quarter = 0.25 * kBrickCells * request.grid.voxelSize;
  const glm::dvec3 towards = closestPointOnTriangle(center, request.soup->corners(atCenter.triangle)).point - center;
  double byEighths = std::numeric_limits<double>::infinity();
  BoundPath eighthPath = path;
  // The one towards the surface first: it probably is touched.
  const int first = (towards.x > 0 ? 1 : 0) + (towards.y > 0 ? 2 : 0) + (towards.z > 0 ? 4 : 0);
  for (int number = 0; number < 8 && byEighths > kTouchVoxels; ++number) {
    const int i = first ^ number;
    const glm::dvec3 corner(i & 1 ? quarter : -quarter, i & 2 ? quarter : -quarter, i & 4 ? quarter : -quarter);
    byEighths =
        std::min(byEighths, eighthPath.at(center + corner).voxels - kEighthHalfDiagonalVoxels - kBoundSlackVoxels);
  }
  return static_cast<float>(std::max(byCenter, byEighths));
}

} // namespace

void boundCells(const SamplingRequest& request, LevelSamples& level) {
  level.cellBounds.resize(request.grid.cellCount());
  level.cellInSheet.resize(request.grid.cellCount());
  std::optional<CellCenters> solids, sheets;
  if (request.surfaces->solid) solids.emplace(request.grid, *request.surfaces->solid);
  if (request.surfaces->sheets) sheets.emplace(request.grid, *request.surfaces->sheets);
  const auto rows =
      static_cast<std::size_t>(request.grid.brickCounts.y) * static_cast<std::size_t>(request.grid.brickCounts.z);
  const auto rowLength = static_cast<std::size_t>(request.grid.brickCounts.x);
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    BoundPath path(request);
    for (std::size_t cell = row * rowLength; cell < (row + 1) * rowLength; ++cell) {
      bool inSheet = false;
      level.cellBounds[cell] = cellBound(request, request.grid.brickOfCell(cell), solids ? &*solids : nullptr,
                                         sheets ? &*sheets : nullptr, path, inSheet);
      level.cellInSheet[cell] = inSheet;
    }
    request.done(0);
  });
  level.queries += level.cellBounds.size(); // eighths are not counted
}

} // namespace brickfield
