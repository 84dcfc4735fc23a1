// The baker's distance against brute force in long double: random soups with slivers and giants, real meshes, limits,
// ties.
#include "bakers/mesh_distance.h"

#include <gtest/gtest.h>

#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

// Double rounding of coordinates around 1 is 1e-16; the longest chain of operations loses less than four digits.
constexpr double kTolerance = 1e-12;

MeshCase randomSoup(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1), size(-3, 0);
  MeshCase result;
  for (int i = 0; i < count; ++i) {
    const auto direction = [&] { return glm::vec3(place(random), place(random), place(random)); };
    const float edge = std::pow(10.0f, size(random)); // a thousandth of the soup to all of it
    const glm::vec3 a = direction(), b = a + edge * direction();
    glm::vec3 c = a + edge * direction();
    if (i % 4 == 0) c = glm::mix(a, b, 0.7f) + 1e-5f * edge * direction(); // a sliver
    result.addTriangle(a, b, c);
  }
  return result;
}

void compareWithBruteForce(const TriangleSoup& soup, const std::vector<glm::dvec3>& points) {
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const MeshDistance distance(hierarchy);
  for (const glm::dvec3 point : points) {
    const ClosestTriangle closest = distance.closest(point);
    ASSERT_NEAR(closest.distance, bruteDistance(soup, point), kTolerance);
    ASSERT_NE(closest.triangle, kNoTriangle);
    EXPECT_NEAR(bruteDistance(point, soup.corners(closest.triangle)), closest.distance, kTolerance);
    EXPECT_NEAR(glm::length(closest.on.point - point), closest.distance, kTolerance);
    const auto [a, b, c] = soup.corners(closest.triangle);
    const glm::dvec3 byWeights = a + closest.on.barycentric.x * (b - a) + closest.on.barycentric.y * (c - a);
    EXPECT_NEAR(glm::length(byWeights - closest.on.point), 0, kTolerance);
  }
}

} // namespace

TEST(MeshDistance, RandomSoupsAgreeWithBruteForce) {
  for (const int count : {1, 2, 7, 9, 100, 3000}) {
    const TriangleSoup soup = randomSoup(count, static_cast<std::uint32_t>(count)).soup();
    compareWithBruteForce(soup, randomPoints(300, 1.5, 1));
    compareWithBruteForce(soup, pointsNearSurface(soup, 300, 1e-3, 2));
  }
}

TEST(MeshDistance, FarPointsAgreeWithBruteForce) {
  const TriangleSoup soup = randomSoup(500, 3).soup();
  for (const glm::dvec3 point : randomPoints(100, 1000, 4)) {
    const MeshHierarchy hierarchy(soup, allTriangles(soup));
    EXPECT_NEAR(MeshDistance(hierarchy).closest(point).distance, bruteDistance(soup, point), 1e-9);
  }
}

TEST(MeshDistance, RealMeshesAgreeWithBruteForce) {
  for (const char* name : {"stanford_dragon_11k.glb", "utah_teapot_6k.glb", "avocado.glb", "tree_leaf_cards.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    const TriangleSoup soup = gatherTriangles(file.input());
    compareWithBruteForce(soup, randomPoints(100, 1, 5));
    compareWithBruteForce(soup, pointsNearSurface(soup, 200, 1e-3, 6));
  }
}

TEST(MeshDistance, HintsChangeNothing) {
  const TriangleSoup soup = randomSoup(400, 7).soup();
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const MeshDistance distance(hierarchy);
  std::uint32_t hint = 0;
  for (const glm::dvec3 point : randomPoints(400, 1.2, 8)) {
    const ClosestTriangle without = distance.closest(point), with = distance.closest(point, HUGE_VAL, hint);
    EXPECT_EQ(without.distance, with.distance);
    EXPECT_EQ(without.triangle, with.triangle);
    hint = (hint + 17) % 400;
  }
}

TEST(MeshDistance, TiesGoToTheLowestTriangle) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  const TriangleSoup soup = box.soup();
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  for (const std::uint32_t hint : {kNoTriangle, 0u, 5u, 11u}) {
    // The middle of a box is as far from all faces; each face's diagonal is shared by its two triangles.
    EXPECT_EQ(MeshDistance(hierarchy).closest(glm::dvec3(0), HUGE_VAL, hint).triangle, 0u);
  }
}

TEST(MeshDistance, LimitFindsWhatLiesAtItAndNothingBeyond) {
  MeshCase quad;
  quad.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  const TriangleSoup soup = quad.soup();
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const glm::dvec3 point(0.1, 0.25, 0.2);
  EXPECT_NE(MeshDistance(hierarchy).closest(point, 0.25).triangle, kNoTriangle);
  const ClosestTriangle beyond = MeshDistance(hierarchy).closest(point, 0.2499999);
  EXPECT_EQ(beyond.triangle, kNoTriangle);
  EXPECT_EQ(beyond.distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(MeshDistance(hierarchy).closest(point, 0.2499999, 0).triangle, kNoTriangle);
}

TEST(MeshDistance, FeatureSaysWhereTheClosestPointLies) {
  const std::array<glm::dvec3, 3> corners = {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)};
  const auto featureAt = [&](double x, double y) { return closestPointOnTriangle({x, y, 0.3}, corners).feature; };
  EXPECT_EQ(featureAt(0.2, 0.2), TriangleFeature::Inside);
  EXPECT_EQ(featureAt(-1, -1), TriangleFeature::Corner0);
  EXPECT_EQ(featureAt(3, 0.5), TriangleFeature::Corner1);
  EXPECT_EQ(featureAt(0.5, 3), TriangleFeature::Corner2);
  EXPECT_EQ(featureAt(0.5, -1), TriangleFeature::Edge0);
  EXPECT_EQ(featureAt(1, 1), TriangleFeature::Edge1);
  EXPECT_EQ(featureAt(-1, 0.5), TriangleFeature::Edge2);
}
