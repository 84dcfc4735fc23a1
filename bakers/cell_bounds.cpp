// The centres of cells are a lattice like the samples of a brick, seven voxels wide: what measures bricks measures them
// too, where triangles are few. Else cells are walked to one after another, along rows.
#include "bakers/cell_bounds.h"

#include <algorithm>
#include <cmath>

#include "bakers/block_distance.h"
#include "bakers/brick_sampler.h"
#include "bakers/each_uneven.h"

namespace brickfield {

namespace {

constexpr double kEighthHalfDiagonalVoxels = 0.5 * kBrickHalfDiagonalVoxels;
constexpr double kBoundSlackVoxels = 1e-3; // over the rounding of double and of the float that stores the bound
constexpr double kBlockSlack = 1e-5;       // share of a distance: over the error of a block, and that of double

/// Cells of a grid that are looked at together, as many along each axis as a brick has samples.
struct CellBlock {
  glm::ivec3 first, counts;

  std::size_t placeOf(glm::ivec3 cell) const { return sampleIndex(cell - first); }
  /// Calls visit(cell) along rows.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    const glm::ivec3 end = first + counts;
    for (int z = first.z; z < end.z; ++z)
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) visit(glm::ivec3(x, y, z));
  }
};

/// Distances from the centres of a block's cells to one surface, all at once: where triangles are not many more than
/// those cells, that is several times faster than a walk each.
class CellCenters {
public:
  CellCenters(const SampleGrid& grid, const MeshDistance& surface, const CellBlock& cells)
      : cells_(cells), spacing_(kBrickCells * grid.voxelSize) {
    closest_.fill(kNoTriangle);
    measure(surface, {grid.origin + spacing_ * (glm::dvec3(cells.first) + 0.5 * kBrickSamples), spacing_});
  }

  /// Within kBlockSlack of the distance; no triangle where a walk is needed.
  NearestTriangle at(glm::ivec3 cell) const {
    const std::size_t place = cells_.placeOf(cell);
    if (closest_[place] == kNoTriangle) return {};
    return {static_cast<double>(distances_[place]) * spacing_, closest_[place], kNoLeaf};
  }

private:
  void measure(const MeshDistance& surface, const SampleBlock& block) {
    const double halfEdge = 0.5 * (kBrickSamples - 1) * spacing_;
    const NearestTriangle nearest = surface.nearest(block.center);
    // No centre is farther from its closest triangle than from that one, as far as a corner at most.
    double reach = 0;
    const auto corners = surface.hierarchy().soup().corners(nearest.triangle);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 corner = block.center + halfEdge * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      reach = std::max(reach, glm::length(corner - closestPointOnTriangle(corner, corners).point));
    }
    std::array<std::uint32_t, kMostBlockTriangles> near;
    const auto cells = static_cast<std::size_t>(cells_.counts.x * cells_.counts.y * cells_.counts.z);
    const std::span<std::uint32_t> place = std::span(near).first(std::min(kTrianglesACell * cells, near.size()));
    const std::size_t count = surface.collect({block.center, halfEdge, reach}, place);
    if (count > place.size()) return;
    std::sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count));
    SampleRows rows{};
    for (int z = 0; z < cells_.counts.z; ++z)
      for (int y = 0; y < cells_.counts.y; ++y)
        rows[static_cast<std::size_t>(y + kBrickSamples * z)] = static_cast<std::uint8_t>((1u << cells_.counts.x) - 1);
    const auto most = static_cast<float>(reach / spacing_ + 1);
    BlockTriangles closest(closest_);
    blockDistances({&surface.hierarchy().soup(), place.first(count), block, rows, most}, distances_, &closest);
  }

  static constexpr std::size_t kTrianglesACell = 2; // more cost as much as walks

  const CellBlock& cells_;
  double spacing_;
  std::array<float, kBrickSampleCount> distances_; ///< between neighbours is 1
  std::array<std::uint32_t, kBrickSampleCount> closest_;
};

/// Of each surface that there is.
struct SurfaceCenters {
  std::optional<CellCenters> solid, sheets;
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

  /// The least of the bound at a point and of what bounds elsewhere are, in voxels: walks need not go farther.
  double leastVoxels(glm::dvec3 point, double elsewhere) {
    PointBound bound{elsewhere};
    if (solid_) {
      const double limit = (elsewhere + request_.solidGrowthVoxels) * voxelSize();
      bound.voxels = std::min(elsewhere, boundBySolid(solid_->nearest(point, limit)).voxels);
    }
    if (sheets_) addSheets(point, sheets_->nearest(point, bound.voxels * voxelSize() + reach()), bound);
    return bound.voxels;
  }

  /// At the centre of a cell.
  PointBound atCell(glm::ivec3 brick, const SurfaceCenters& centers) {
    const glm::dvec3 center = request_.grid.brickCenter(brick);
    PointBound bound;
    if (solid_) bound = boundBySolid(nearestTo(center, brick, *solid_, *centers.solid, HUGE_VAL));
    if (sheets_)
      addSheets(center, nearestTo(center, brick, *sheets_, *centers.sheets, bound.voxels * voxelSize() + reach()),
                bound);
    return bound;
  }

private:
  double voxelSize() const { return request_.grid.voxelSize; }
  double reach() const { return request_.surfaces->slabs->mostReach(request_.halfThickness); }

  static NearestTriangle nearestTo(glm::dvec3 point, glm::ivec3 cell, PathOfPoints& path, const CellCenters& centers,
                                   double limit) {
    const NearestTriangle known = centers.at(cell);
    return known.triangle != kNoTriangle ? path.start(point, known) : path.nearest(point, limit);
  }

  PointBound boundBySolid(NearestTriangle nearest) const {
    return {std::max(0.0, nearest.distance * (1 - kBlockSlack) / voxelSize() - request_.solidGrowthVoxels), false,
            nearest.triangle};
  }
  void addSheets(glm::dvec3 point, NearestTriangle nearest, PointBound& bound) const {
    const SheetSlabs& slabs = *request_.surfaces->slabs;
    if (nearest.triangle == kNoTriangle || nearest.distance > bound.voxels * voxelSize() + reach()) return;
    // A slab behind another sheet's triangle may reach this much nearer than the closest triangle's own.
    double least = nearest.distance - reach();
    if (least < kBlockSlack * nearest.distance) { // the point may lie in a slab
      const PointOnTriangle on = closestPointOnTriangle(point, request_.soup->corners(nearest.triangle));
      const ClosestTriangle closest{glm::length(point - on.point), nearest.triangle, on};
      bound.inSheet = slabs.distance(point, closest, request_.halfThickness) < 0;
    }
    if (slabs.areAllCentred())
      least = std::abs(slabs.centredDistance(nearest.triangle, nearest.distance, request_.halfThickness));
    const double voxels = std::max(least - kBlockSlack * nearest.distance, 0.0) / voxelSize();
    if (voxels < bound.voxels) bound.voxels = voxels, bound.triangle = nearest.triangle;
  }

  const SamplingRequest& request_;
  std::optional<PathOfPoints> solid_, sheets_;
};

/// Bound over a whole cell. Cells that the centre cannot clear are looked at by eighths, until one may be touched: by
/// how much is of no interest.
float cellBound(const SamplingRequest& request, glm::ivec3 brick, const SurfaceCenters& centers, BoundPath& path,
                bool& inSheet) {
  const PointBound atCenter = path.atCell(brick, centers);
  inSheet = atCenter.inSheet;
  const double byCenter = atCenter.voxels - kBrickHalfDiagonalVoxels - kBoundSlackVoxels;
  if (byCenter > kTouchVoxels || byCenter < -kEighthHalfDiagonalVoxels) return static_cast<float>(byCenter);
  const glm::dvec3 center = request.grid.brickCenter(brick);
  const double quarter = 0.25 * kBrickCells * request.grid.voxelSize;
  const auto corners = request.soup->corners(atCenter.triangle);
  const glm::dvec3 towards = closestPointOnTriangle(center, corners).point - center;
  const auto centerOfEighth = [&](int i) {
    return center + glm::dvec3(i & 1 ? quarter : -quarter, i & 2 ? quarter : -quarter, i & 4 ? quarter : -quarter);
  };
  const auto boundBy = [](double voxels) { return voxels - kEighthHalfDiagonalVoxels - kBoundSlackVoxels; };
  // The one towards the surface first: it probably is touched, and mostly by the same triangle.
  const int first = (towards.x > 0 ? 1 : 0) + (towards.y > 0 ? 2 : 0) + (towards.z > 0 ? 4 : 0);
  const glm::dvec3 nearest = centerOfEighth(first);
  const double away = glm::length(closestPointOnTriangle(nearest, corners).point - nearest);
  const bool isThin = request.halfThickness <= request.grid.voxelSize; // else it may lie deep in a slab
  if (isThin && boundBy(away / request.grid.voxelSize) <= kTouchVoxels) return static_cast<float>(byCenter);
  double least = std::numeric_limits<double>::infinity();
  BoundPath eighthPath = path;
  for (int number = 0; number < 8 && boundBy(least) > kTouchVoxels; ++number)
    least = eighthPath.leastVoxels(centerOfEighth(first ^ number), least);
  return static_cast<float>(std::max(byCenter, boundBy(least)));
}

} // namespace

void boundCells(const SamplingRequest& request, LevelSamples& level) {
  const SampleGrid& grid = request.grid;
  level.cellBounds.resize(grid.cellCount());
  level.cellInSheet.resize(grid.cellCount());
  const glm::ivec3 blocks = (grid.brickCounts + kBrickSamples - 1) / kBrickSamples;
  forEachUneven(static_cast<std::size_t>(blocks.x * blocks.y * blocks.z), 1, [&](std::size_t number) {
    const auto i = static_cast<int>(number);
    const glm::ivec3 first =
        kBrickSamples * glm::ivec3(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y));
    const CellBlock cells{first, glm::min(grid.brickCounts - first, kBrickSamples)};
    SurfaceCenters centers;
    if (request.surfaces->solid) centers.solid.emplace(grid, *request.surfaces->solid, cells);
    if (request.surfaces->sheets) centers.sheets.emplace(grid, *request.surfaces->sheets, cells);
    BoundPath path(request);
    cells.forEach([&](glm::ivec3 brick) {
      const std::size_t cell = grid.cellOfBrick(brick);
      bool inSheet = false;
      level.cellBounds[cell] = cellBound(request, brick, centers, path, inSheet);
      level.cellInSheet[cell] = inSheet;
    });
    request.done(0);
  });
  level.queries += level.cellBounds.size(); // eighths are not counted
}

} // namespace brickfield
