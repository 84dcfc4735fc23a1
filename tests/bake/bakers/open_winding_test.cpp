// Winding numbers of open triangles by rays and rims, against all solid angles in double.
#include "bakers/open_winding.h"

#include <gtest/gtest.h>

#include "bakers/simd_level.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

struct Compared {
  int withSlack = 0; ///< more than rounding
  double mostExactError = 0;
};

/// Holds both ways of asking against the truth.
Compared compare(const TriangleSoup& soup, const std::vector<glm::dvec3>& points) {
  const OpenWinding winding(soup, allTriangles(soup));
  EXPECT_FALSE(winding.rims().areMany());
  Compared result;
  for (const glm::dvec3 point : points) {
    const double truth = bruteWinding(soup, point);
    const NearlyTurns nearly = winding.nearlyAt(point);
    EXPECT_LE(std::abs(nearly.turns - truth), nearly.slack + 1e-9);
    result.withSlack += nearly.slack > 1e-6;
    EXPECT_LE(std::abs(winding.roughlyAt(point) - truth), 0.02);
    result.mostExactError = std::max(result.mostExactError, std::abs(winding.exactlyAt(point) - truth));
  }
  return result;
}

/// Points beside the edges of open triangles, where winding numbers change fastest.
std::vector<glm::dvec3> pointsBesideEdges(const TriangleSoup& soup, int count, double away) {
  std::vector<glm::dvec3> points = randomPoints(count, away, 51);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto corners = soup.corners(static_cast<std::uint32_t>(i * 7919 % soup.triangles.size()));
    points[i] += glm::mix(corners[i % 3], corners[(i + 1) % 3], 0.1 + 0.8 * static_cast<double>(i % 17) / 17);
  }
  return points;
}

} // namespace

TEST(OpenWinding, IsTheSumOfAllSolidAngles) {
  for (const char* name :
       {"utah_teapot_1k.glb", "utah_teapot_2464.glb", "stanford_bunny_69k.glb", "plane_holes_17k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const TriangleSoup soup = gatherTriangles(FileCase(name).input());
    EXPECT_LT(compare(soup, randomPoints(150, 1.2, 52)).mostExactError, 1e-9);
    EXPECT_LT(compare(soup, pointsBesideEdges(soup, 150, 3e-3)).mostExactError, 1e-9);
  }
}

// The rims of squares that stand apart: far loops, loops on the ray and points between the strips of neighbours.
TEST(OpenWinding, FarLoopsKeepToTheirSlack) {
  MeshCase squares;
  for (int i = 0; i < 64; ++i) {
    const glm::vec3 corner = 0.2f * glm::vec3(i % 4, i / 4 % 4, i / 16) + glm::vec3(0, 0, 0.013f * (i % 5));
    squares.addQuad(corner, corner + glm::vec3(0.06f, 0, 0), corner + glm::vec3(0.06f, 0.06f, 0.01f),
                    corner + glm::vec3(0, 0.06f, 0.02f));
  }
  const TriangleSoup soup = squares.soup();
  for (const double halfEdge : {0.7, 1.5, 5.0}) {
    const Compared compared = compare(soup, randomPoints(1000, halfEdge, 53));
    EXPECT_LT(compared.mostExactError, 1e-9);
    EXPECT_GT(compared.withSlack, 900);
  }
}

// A spiral's rim winds around many points more than once: its edges add up to whole turns.
TEST(OpenWinding, CountsWholeTurnsOfTheRims) {
  MeshCase spiral;
  const auto at = [](int i, float radius) {
    const float angle = 0.35f * static_cast<float>(i);
    return glm::vec3(radius * std::cos(angle), radius * std::sin(angle), 0.004f * static_cast<float>(i));
  };
  for (int i = 0; i < 80; ++i) spiral.addQuad(at(i, 0.02f), at(i, 1), at(i + 1, 1), at(i + 1, 0.02f));
  const TriangleSoup soup = spiral.soup();
  EXPECT_LT(compare(soup, randomPoints(400, 0.9, 54)).mostExactError, 1e-9);
  const OpenWinding winding(soup, allTriangles(soup));
  EXPECT_GT(winding.exactlyAt(soup.soupFromObject({0.3, 0.2, -0.05})) -
                winding.exactlyAt(soup.soupFromObject({0.3, 0.2, 0.37})),
            3.0);
}

TEST(OpenWinding, AsksSumsWhereRimsAreMany) {
  MeshCase torn;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 corner(0.1f * static_cast<float>(i % 20), 0.1f * static_cast<float>(i / 20), 0.013f * (i % 5));
    torn.addTriangle(corner, corner + glm::vec3(0.06f, 0, 0), corner + glm::vec3(0.06f, 0.06f, 0.01f));
  }
  const TriangleSoup soup = torn.soup();
  const OpenWinding winding(soup, allTriangles(soup));
  ASSERT_TRUE(winding.rims().areMany());
  for (const glm::dvec3 point : randomPoints(200, 0.8, 55)) {
    const double truth = bruteWinding(soup, point);
    const NearlyTurns nearly = winding.nearlyAt(point);
    EXPECT_LE(std::abs(nearly.turns - truth), nearly.slack);
    EXPECT_LE(std::abs(winding.exactlyAt(point) - truth), std::abs(truth - 0.5) < 1e-3 ? 1e-9 : 0.015);
  }
}

TEST(OpenWinding, IsTheSameWithAndWithoutAvx2) {
  BRICKFIELD_NEEDS_DATA("utah_teapot_1k.glb");
  const TriangleSoup soup = gatherTriangles(FileCase("utah_teapot_1k.glb").input());
  const OpenWinding winding(soup, allTriangles(soup));
  for (const glm::dvec3 point : randomPoints(100, 1, 56)) {
    const NearlyTurns nearly = winding.nearlyAt(point);
    const double exact = winding.exactlyAt(point);
    limitSimd(SimdLevel::Portable);
    EXPECT_EQ(winding.nearlyAt(point).turns, nearly.turns);
    EXPECT_EQ(winding.exactlyAt(point), exact);
    limitSimd(SimdLevel::Avx512);
  }
}
