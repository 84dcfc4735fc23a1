// Samples of slabs, measured eight at a time in floats, against each one's closest triangle in double.
#include <gtest/gtest.h>

#include "bakers/brick_sampler.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr double kVoxel = 0.05;     // soup space
constexpr double kMostError = 1e-5; // voxels: of the band before coding
constexpr std::size_t kQuadsAside = 10;

/// Two wavy sheets, one above the other, of triangles of two voxels' side.
MeshCase wavySheets() {
  MeshCase sheets;
  const auto at = [](int x, int z, float height) {
    return glm::vec3(0.1f * static_cast<float>(x), height + 0.07f * std::sin(1.3f * static_cast<float>(x + 2 * z)),
                     0.1f * static_cast<float>(z));
  };
  for (const float height : {0.0f, 0.8f})
    for (std::size_t i = 0; i < kQuadsAside * kQuadsAside; ++i) {
      const int x = static_cast<int>(i % kQuadsAside), z = static_cast<int>(i / kQuadsAside);
      sheets.addQuad(at(x, z, height), at(x, z + 1, height), at(x + 1, z + 1, height), at(x + 1, z, height));
    }
  return sheets;
}

/// Bricks around a mesh.
SampleGrid gridAround(const TriangleSoup& soup) {
  glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const glm::dvec3 position : soup.positions) low = glm::min(low, position), high = glm::max(high, position);
  const double brick = kBrickCells * kVoxel;
  return {low - glm::dvec3(0.77, 0.81, 0.73) * brick, kVoxel, glm::ivec3(glm::ceil((high - low) / brick)) + 2};
}

struct Compared {
  double largestError = 0;
  std::size_t before = 0, behind = 0; ///< in the band
};

/// behind         which triangles' slabs may lie behind them
/// isDoubleSided  rims are as wide as centred slabs'
Compared compare(const std::function<bool(std::uint32_t)>& behind, bool isDoubleSided = false) {
  TriangleSoup soup = wavySheets().soup();
  soup.pieceBarycentrics.resize(soup.triangles.size() / 2); // the upper sheet counts as cut by a mask
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const MeshDistance surface(hierarchy);
  SlabRequest request;
  request.halfThickness = 0.5625 * kVoxel;
  request.pieceShare = 0.9;
  request.isDoubleSided.assign(soup.triangles.size(), isDoubleSided);
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
    request.mayLieBehind.push_back(behind(t));
    request.isTurned.push_back(t >= soup.triangles.size() / 2); // the upper sheet
  }
  const SheetSlabs slabs(soup, hierarchy, request);
  const SampleGrid grid = gridAround(soup);
  Compared result;
  std::array<float, kBrickSampleCount> distances;
  std::array<std::uint32_t, kBrickSampleCount> triangles;
  for (std::size_t cell = 0; cell < grid.cellCount(); ++cell) {
    const glm::ivec3 brick = grid.brickOfCell(cell);
    SurfaceSampler{grid, surface, &slabs, request.halfThickness, true}.run(brick, allSamples(), distances.data(),
                                                                           triangles.data());
    for (std::size_t i = 0; i < kBrickSampleCount; ++i) {
      const glm::dvec3 point = grid.sample(brick, sampleOfIndex(i));
      ClosestTriangle closest = surface.closest(point);
      if (closest.distance / kVoxel > kNarrowBandVoxels + 1.9) continue; // no slab is so deep
      // Of two that are as close any may be found: at the corner of a rim their slabs differ.
      const PointOnTriangle on = closestPointOnTriangle(point, soup.corners(triangles[i]));
      if (glm::length(point - on.point) < closest.distance + 1e-6 * kVoxel)
        closest = {glm::length(point - on.point), triangles[i], on};
      const double exact = slabs.distance(point, closest, request.halfThickness) / kVoxel;
      const double found = static_cast<double>(distances[i]), range = kNarrowBandVoxels;
      result.largestError = std::max(result.largestError, std::abs(std::min(found, range) - std::min(exact, range)));
      if (exact < range) ++(closest.distance / kVoxel < range ? result.before : result.behind);
    }
  }
  return result;
}

} // namespace

TEST(SlabSamples, CentredOnesAreExact) {
  const Compared compared = compare([](std::uint32_t) { return false; });
  EXPECT_LE(compared.largestError, kMostError);
  EXPECT_GT(compared.before, 20000u);
}

TEST(SlabSamples, OnesBehindAreExactBesideWideRims) {
  EXPECT_LE(compare([](std::uint32_t) { return true; }, true).largestError, kMostError);
}

TEST(SlabSamples, OnesBehindAreExact) {
  const Compared compared = compare([](std::uint32_t) { return true; });
  EXPECT_LE(compared.largestError, kMostError);
  EXPECT_GT(compared.before, 20000u);
  EXPECT_GT(compared.behind, 5000u); // farther from the triangle than the range, but not from the slab
}
