// Bounds of cells against exact distances, where centres are measured 8^3 at once and where they are walked to.
#include <gtest/gtest.h>

#include "bakers/cell_bounds.h"
#include "tests/bake/bakers/mesh_cases.h"

namespace brickfield::test {
namespace {

constexpr int kCellsAlong = 19; // two whole blocks of eight and a part of one

} // namespace

TEST(CellBounds, AreThoseOfExactDistancesToCentres) {
  for (const char* name : {"box.glb", "tree_leaf_cards.glb", "utah_teapot_1k.glb", "stanford_dragon_11k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    const TriangleSoup soup = gatherTriangles(file.input());
    std::vector<std::uint32_t> all(soup.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    const MeshHierarchy hierarchy(soup, all);
    BakeSurfaces surfaces;
    surfaces.solid.emplace(hierarchy);
    SamplingRequest request;
    request.soup = &soup, request.surfaces = &surfaces;
    request.grid.voxelSize = 3.0 * soup.reach / (kBrickCells * kCellsAlong); // the mesh, and space all around it
    request.grid.brickCounts = glm::ivec3(kCellsAlong);
    request.grid.origin = glm::dvec3(-0.5 * kCellsAlong * kBrickCells * request.grid.voxelSize);
    request.done = [](std::size_t) {};
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

} // namespace brickfield::test
