// Bounds of cells against exact distances, where centres are measured 8^3 at once and where they are walked to.
#include <gtest/gtest.h>

#include "bakers/cell_bounds.h"
#include "tests/bake/bakers/mesh_cases.h"

namespace brickfield::test {
namespace {

constexpr int kCellsAlong = 19;     // two whole blocks of eight and a part of one
constexpr double kNearbyVoxels = 3; // what the eighths of a cell clear has no larger bounds

std::vector<std::uint32_t> allOf(const TriangleSoup& soup) {
  std::vector<std::uint32_t> all(soup.triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  return all;
}

/// The mesh, and space all around it.
SamplingRequest around(const TriangleSoup& soup, const BakeSurfaces& surfaces) {
  SamplingRequest request;
  request.soup = &soup, request.surfaces = &surfaces;
  request.grid.voxelSize = 3.0 * soup.reach / (kBrickCells * kCellsAlong);
  request.grid.brickCounts = glm::ivec3(kCellsAlong);
  request.grid.origin = glm::dvec3(-0.5 * kCellsAlong * kBrickCells * request.grid.voxelSize);
  request.done = [](std::size_t) {};
  return request;
}

/// Voxels from a point to what is drawn.
double voxelsTo(const SamplingRequest& request, glm::dvec3 point) {
  const BakeSurfaces& surfaces = *request.surfaces;
  double least = std::numeric_limits<double>::infinity();
  if (surfaces.solid)
    least = surfaces.solid->nearest(point).distance / request.grid.voxelSize - request.solidGrowthVoxels;
  if (surfaces.sheets)
    least = std::min(least, surfaces.slabs->distance(point, surfaces.sheets->closest(point), request.halfThickness) /
                                request.grid.voxelSize);
  return least;
}

/// Of empty cells that the surface comes near to: no point of them may be nearer than the bound.
///
/// returns how many there are
std::size_t expectTrueNearby(const SamplingRequest& request) {
  LevelSamples level;
  boundCells(request, level);
  std::size_t nearby = 0;
  for (std::size_t cell = 0; cell < level.cellBounds.size(); ++cell) {
    const auto bound = static_cast<double>(level.cellBounds[cell]);
    if (isBrickStored(level.cellBounds[cell]) || bound > kNearbyVoxels) continue;
    ++nearby;
    const glm::ivec3 brick = request.grid.brickOfCell(cell);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < kBrickSampleCount; ++i)
      least = std::min(least, voxelsTo(request, request.grid.sample(brick, sampleOfIndex(i))));
    EXPECT_LE(bound, least) << cell;
  }
  return nearby;
}

} // namespace

TEST(CellBounds, AreThoseOfExactDistancesToCentres) {
  for (const char* name : {"box.glb", "tree_leaf_cards.glb", "utah_teapot_1k.glb", "stanford_dragon_11k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    const TriangleSoup soup = gatherTriangles(file.input());
    const MeshHierarchy hierarchy(soup, allOf(soup));
    BakeSurfaces surfaces;
    surfaces.solid.emplace(hierarchy);
    const SamplingRequest request = around(soup, surfaces);
    LevelSamples level;
    boundCells(request, level);
    ASSERT_EQ(level.cellBounds.size(), request.grid.cellCount());
    std::size_t cleared = 0;
    for (std::size_t cell = 0; cell < level.cellBounds.size(); ++cell) {
      const glm::dvec3 center = request.grid.brickCenter(request.grid.brickOfCell(cell));
      const double voxels = surfaces.solid->nearest(center).distance / request.grid.voxelSize;
      const double bound = voxels - static_cast<double>(kBrickHalfDiagonalVoxels);
      if (bound <= static_cast<double>(kTouchVoxels) + 1.0 / 64) continue; // looked at by eighths
      ++cleared;
      ASSERT_LE(static_cast<double>(level.cellBounds[cell]), bound) << cell;
      ASSERT_GE(static_cast<double>(level.cellBounds[cell]), bound - 1.0 / 64) << cell; // a quarter of what is stored
    }
    EXPECT_GT(cleared, level.cellBounds.size() / 2);
  }
}

TEST(CellBounds, HoldInAllOfTheCell) {
  for (const char* name : {"tree_leaf_cards.glb", "utah_teapot_1k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    const TriangleSoup soup = gatherTriangles(file.input());
    const MeshHierarchy hierarchy(soup, allOf(soup));
    BakeSurfaces solid, sheets;
    solid.solid.emplace(hierarchy);
    SamplingRequest request = around(soup, solid);
    EXPECT_GT(expectTrueNearby(request), 60u);
    request.solidGrowthVoxels = 0.7;
    EXPECT_GT(expectTrueNearby(request), 60u) << "grown";
    for (const bool mayLieBehind : {false, true}) {
      SlabRequest slabs;
      request.halfThickness = slabs.halfThickness = 0.5625 * request.grid.voxelSize;
      slabs.mayLieBehind.assign(soup.triangles.size(), mayLieBehind);
      slabs.isDoubleSided.assign(soup.triangles.size(), false);
      slabs.isTurned.assign(soup.triangles.size(), false);
      sheets.sheets.emplace(hierarchy);
      sheets.slabs.emplace(soup, hierarchy, slabs);
      request.surfaces = &sheets;
      EXPECT_GT(expectTrueNearby(request), 60u) << "slabs behind: " << mayLieBehind;
    }
  }
}

} // namespace brickfield::test
