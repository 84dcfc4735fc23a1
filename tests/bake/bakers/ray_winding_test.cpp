// Crossings of one ray against all solid angles in double, and where rays hit edges, corners and planes.
#include "bakers/ray_winding.h"

#include <gtest/gtest.h>

#include "bakers/mesh_topology.h"
#include "bakers/simd_level.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

int countWrong(const TriangleSoup& soup, const std::vector<glm::dvec3>& points) {
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const RayWinding winding(hierarchy);
  int wrong = 0;
  for (const glm::dvec3 point : points) wrong += std::abs(winding.at(point) - bruteWinding(soup, point)) > 1e-6;
  return wrong;
}

/// Cubes of a side of 1 in two layers of 2 x 2, each a whole box: rays run in walls, through edges and corners.
MeshCase eightCubes() {
  MeshCase cubes;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 low(i & 1, i >> 1 & 1, i >> 2);
    cubes.addBox(low, low + 1.0f, i == 3);
  }
  return cubes;
}

} // namespace

TEST(RayWinding, IsTheSumOfAllSolidAngles) {
  for (const char* name : {"torus_5k.glb", "stanford_bunny_closed.glb", "stanford_dragon_11k.glb", "blub_fish.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const TriangleSoup soup = gatherTriangles(FileCase(name).input());
    ASSERT_TRUE(analyseTopology(soup).isClosed()) << name;
    EXPECT_EQ(countWrong(soup, randomPoints(200, 1.1, 41)), 0) << name;
    EXPECT_EQ(countWrong(soup, pointsNearSurface(soup, 300, 1e-3, 42)), 0) << name;
  }
}

TEST(RayWinding, CountsEachWallOnce) {
  const TriangleSoup soup = eightCubes().soup();
  std::vector<glm::dvec3> points;
  for (int z = -1; z <= 9; ++z)
    for (int y = -1; y <= 9; ++y)
      for (int x = -1; x <= 9; ++x) {
        const glm::ivec3 quarters(x, y, z);
        if (glm::any(glm::equal(quarters, glm::ivec3(0))) || glm::any(glm::equal(quarters, glm::ivec3(4))) ||
            glm::any(glm::equal(quarters, glm::ivec3(8))))
          continue; // in the plane of a wall: many are on it
        points.push_back(soup.soupFromObject(glm::dvec3(quarters) / 4.0));
      }
  ASSERT_EQ(points.size(), 512u);
  EXPECT_EQ(countWrong(soup, points), 0);
}

// Rays from these points run through the cubes' corners, to the last bit.
TEST(RayWinding, CountsCornersOnce) {
  const TriangleSoup soup = eightCubes().soup();
  std::vector<glm::dvec3> points;
  for (int corner = 0; corner < 27; ++corner)
    for (glm::length_t along = 0; along < 3; ++along)
      for (const double height : {-0.625, -0.375, 0.375, 0.625}) {
        glm::dvec3 point = soup.soupFromObject(glm::dvec3(corner % 3, corner / 3 % 3, corner / 9));
        point[along] -= height;
        point[(along + 1) % 3] -= std::abs(height) * double{RayWinding::kColumnShear};
        point[(along + 2) % 3] -= std::abs(height) * double{RayWinding::kRowShear};
        points.push_back(point);
      }
  EXPECT_EQ(countWrong(soup, points), 0);
}

TEST(RayWinding, PointsInThePlaneOfAWallAreToldApart) {
  MeshCase mesh; // turned by 45 degrees, so that the planes' coordinates are rounded
  mesh.addBox({-1, -1, -1}, {1, 1, 1});
  for (glm::vec3& p : mesh.primitive().positions) p = {0.70710678f * (p.x - p.y), 0.70710678f * (p.x + p.y), p.z};
  const TriangleSoup soup = mesh.soup();
  std::vector<glm::dvec3> points;
  for (int i = 1; i < 40; ++i)
    for (const double z : {-1.5, -1.0, 1.0, 1.5})
      points.push_back(soup.soupFromObject({0.0353553 * i, 1.4142136 - 0.0353553 * i, 1.0001 * z}));
  EXPECT_EQ(countWrong(soup, points), 0);
}

// Boxes with corners on a lattice share planes, edges and corners; points are on the lattice too, in planes of walls.
TEST(RayWinding, CountsBoxesOnALattice) {
  std::mt19937 random(44);
  const auto at = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  int asked = 0, wrong = 0;
  for (int mesh = 0; mesh < 60; ++mesh) {
    MeshCase boxes;
    std::vector<Box> bounds;
    std::vector<int> turns;
    for (int i = 0; i < 1 + mesh % 24; ++i) {
      const glm::vec3 low(at(9), at(9), at(9));
      bounds.push_back({low, low + glm::vec3(1 + at(4), 1 + at(4), 1 + at(4))});
      turns.push_back(at(4) == 0 ? -1 : 1);
      boxes.addBox(bounds.back().min, bounds.back().max, turns.back() < 0);
    }
    const TriangleSoup soup = boxes.soup();
    const MeshHierarchy hierarchy(soup, allTriangles(soup));
    const RayWinding winding(hierarchy);
    for (int k = 0; k < 500; ++k) {
      const glm::vec3 point = glm::vec3(at(28), at(28), at(28)) / 2.0f - 0.5f;
      int expected = 0;
      bool isOnWall = false;
      for (std::size_t i = 0; i < bounds.size(); ++i) {
        const glm::vec3 within = glm::min(point - bounds[i].min, bounds[i].max - point);
        const float least = std::min({within.x, within.y, within.z});
        isOnWall |= least == 0;
        expected += least > 0 ? turns[i] : 0;
      }
      if (isOnWall) continue;
      ++asked;
      wrong += winding.at(soup.soupFromObject(point)) != expected;
    }
  }
  EXPECT_GT(asked, 20000);
  EXPECT_EQ(wrong, 0);
}

TEST(RayWinding, CountsTurnsEitherWay) {
  MeshCase boxes;
  for (const bool isInverted : {true, false, true, true}) boxes.addBox({-1, -1, -1}, {1, 1, 1}, isInverted);
  boxes.addBox({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, true);
  const TriangleSoup soup = boxes.soup();
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const RayWinding winding(hierarchy);
  EXPECT_EQ(winding.at(soup.soupFromObject({0.1, 0.2, 0.3})), -3);
  EXPECT_EQ(winding.at(soup.soupFromObject({0.1, -0.7, 0.3})), -2);
  EXPECT_EQ(winding.at(soup.soupFromObject({0.1, -1.7, 0.3})), 0);
}

TEST(RayWinding, IsTheSameWithAndWithoutAvx2) {
  const TriangleSoup soup = eightCubes().soup();
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const RayWinding winding(hierarchy);
  for (const glm::dvec3 point : randomPoints(300, 1.1, 43)) {
    const int turns = winding.at(point);
    limitSimd(SimdLevel::Portable);
    EXPECT_EQ(winding.at(point), turns);
    limitSimd(SimdLevel::Avx512);
  }
}
