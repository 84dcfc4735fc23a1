// What rims say of winding numbers, against sums over all triangles.
#include "bakers/rims.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "bakers/inside_test.h"
#include "bakers/sample_signs.h"
#include "bakers/simd_level.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr const char* kOpenMeshes[] = {"utah_teapot_1k.glb", "utah_teapot_2464.glb", "stanford_bunny_69k.glb",
                                       "plane_holes_17k.glb"};

double offWhole(double turns) { return std::abs(turns - std::round(turns)); }

/// Many squares that stand apart: each edge is a rim.
MeshCase tornSquares(int perSide) {
  MeshCase squares;
  for (int j = 0; j < perSide; ++j)
    for (int i = 0; i < perSide; ++i) {
      const glm::vec3 corner(0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j),
                             0.013f * static_cast<float>(i * j % 5));
      squares.addTriangle(corner, corner + glm::vec3(0.06f, 0, 0), corner + glm::vec3(0.06f, 0.06f, 0.01f));
    }
  return squares;
}

} // namespace

TEST(Rims, ClosedMeshesHaveNone) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  const TriangleSoup soup = gatherTriangles(box.input());
  const Rims rims(soup, allTriangles(soup));
  EXPECT_EQ(rims.edgeCount(), 0u);
  EXPECT_LT(offWhole(rims.fractionAt({0.1, 0.2, 0.3})), 1e-12);
}

TEST(Rims, TellTheWindingNumberButForWholeTurns) {
  for (const char* name : kOpenMeshes) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const TriangleSoup soup = gatherTriangles(FileCase(name).input());
    const Rims rims(soup, allTriangles(soup));
    EXPECT_GT(rims.edgeCount(), 0u);
    double most = 0;
    for (const glm::dvec3 point : randomPoints(100, 0.7, 31))
      most = std::max(most, offWhole(rims.fractionAt(point) - bruteWinding(soup, point)));
    EXPECT_LT(most, 1e-9);
  }
}

TEST(Rims, SlopeIsThatOfTheWindingNumber) {
  constexpr double kStep = 1e-5;
  for (const bool many : {false, true}) {
    const MeshCase squares = tornSquares(many ? 30 : 8);
    const TriangleSoup soup = gatherTriangles(squares.input());
    const Rims rims(soup, allTriangles(soup));
    EXPECT_EQ(rims.areMany(), many);
    for (const glm::dvec3 point : randomPoints(50, 0.7, 32)) {
      glm::dvec3 slope;
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        glm::dvec3 offset(0.0);
        offset[axis] = kStep;
        const double change = rims.fractionAt(point + offset) - rims.fractionAt(point - offset);
        slope[axis] = (change - std::round(change)) / (2 * kStep);
      }
      const double exact = glm::length(slope);
      EXPECT_NEAR(glm::length(rims.slopeAt(point)), exact, (many ? 0.1 : 1e-4) * exact + 1e-4);
      EXPECT_LT(glm::length(rims.slopeAt(point) - slope), (many ? 0.2 : 1e-4) * exact + 1e-4);
      const WindingAround both = rims.fractionAndSlopeAt(point);
      EXPECT_EQ(both.fraction, rims.fractionAt(point));
      EXPECT_LT(glm::length(both.slope - slope), 1e-4 * exact + 1e-4);
    }
  }
}

TEST(Rims, NothingInABallChangesMore) {
  for (const bool many : {false, true}) {
    const MeshCase squares = tornSquares(many ? 30 : 3);
    const TriangleSoup soup = gatherTriangles(squares.input());
    const Rims rims(soup, allTriangles(soup));
    int known = 0;
    for (const glm::dvec3 center : randomPoints(300, 1.2, 33))
      for (const double radius : {0.01, 0.05, 0.2}) {
        const double most = rims.mostChange(center, radius);
        if (most > 0.4) continue;
        ++known;
        for (const glm::dvec3 offset : randomPoints(20, 0.57, 34)) {
          const double length = std::max(glm::length(offset), 1e-3), reach = std::min(length, 1.0) * radius;
          EXPECT_LE(offWhole(rims.fractionAt(center + offset / length * reach) - rims.fractionAt(center)), most);
        }
      }
    EXPECT_GT(known, 100);
  }
}

TEST(Rims, NumbersAndSlopesKeepToWhatIsKnownAround) {
  const MeshCase squares = tornSquares(8);
  const TriangleSoup soup = gatherTriangles(squares.input());
  const Rims rims(soup, allTriangles(soup));
  ASSERT_FALSE(rims.areMany());
  int known = 0, withFarLoops = 0, withNearLoops = 0, steady = 0;
  for (const glm::dvec3 center : randomPoints(400, 1.2, 36))
    for (const double radius : {0.01, 0.05, 0.2}) {
      const std::optional<WindingAround> around = rims.around(center, radius);
      if (!around || around->slack > 0.2) continue;
      ++known;
      withFarLoops += around->slack > 1e-4;
      withNearLoops += around->bend > 0;
      steady += around->leastFromHalf(glm::dvec3(0.0), radius) > 0;
      for (const glm::dvec3 direction : randomPoints(10, 0.57, 37)) {
        const glm::dvec3 offset = direction / std::max(glm::length(direction), 1.0) * radius;
        const double away = glm::length(offset), fraction = rims.fractionAt(center + offset);
        EXPECT_LE(offWhole(fraction - around->at(offset)), around->slack + 0.5 * around->bend * away * away);
        EXPECT_LE(glm::length(rims.slopeAt(center + offset) - around->slope),
                  around->slopeSlack + around->bend * away + 1e-9);
        EXPECT_LE(glm::length(rims.slopeAt(center + offset)), around->steepest(away) + 1e-9);
        EXPECT_GE(std::abs(fraction - 0.5), around->leastFromHalf(glm::dvec3(0.0), radius));
        EXPECT_GE(std::abs(fraction - 0.5), around->leastFromHalf(offset, 0.0));
      }
    }
  EXPECT_GT(known, 200);
  EXPECT_GT(std::min({withFarLoops, withNearLoops, steady}), 50);
}

namespace {

/// A point's distance to the membrane by brute force, in double by all edges; nothing where it is not clearly the one
/// that rims alone tell of, whole turns aside.
std::optional<double> distanceToMembrane(const InsideTest& test, const Rims& rims, glm::dvec3 point) {
  const double distance = test.membraneDistance(point, HUGE_VAL);
  const WindingAround here = rims.fractionAndSlopeAt(point);
  const double byRims = std::abs(here.fraction - 0.5) / glm::length(here.slope);
  return distance < HUGE_VAL && std::abs(distance - byRims) < 1e-6 * byRims ? std::optional(distance) : std::nullopt;
}

} // namespace

// In a small ball the point that is nearest to the membrane lies down the slope. A limit of a little more than its
// distance takes it in, so the ball is not far; a limit of a little less does not.
TEST(Rims, BallsAreFarFromMembranesUpToTheNearestOfTheirPoints) {
  MeshCase bowl; // one loop: nothing is left to slack
  bowl.addSphere({0, 0, 0}, 1, 24, 48, 12);
  const TriangleSoup soup = bowl.soup();
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const InsideTest test(soup, analyseTopology(soup), hierarchy, SignMethod::Winding, "case");
  const Rims rims(soup, allTriangles(soup));
  int balls = 0;
  for (const glm::dvec3 center : randomPoints(3000, 0.8, 38)) {
    const std::optional<double> ofCenter = distanceToMembrane(test, rims, center);
    if (!ofCenter) continue;
    const WindingAround here = rims.fractionAndSlopeAt(center);
    const double radius = 2e-3 * std::min(*ofCenter, 0.1);
    const glm::dvec3 down = (here.fraction < 0.5 ? 1.0 : -1.0) * radius * glm::normalize(here.slope);
    const std::optional<double> nearest = distanceToMembrane(test, rims, center + down);
    const double off = std::abs(here.fraction - 0.5);
    if (!nearest || off < 0.02 || off > 0.44) continue;
    for (const bool isInFloats : {false, true}) {
      const std::optional<WindingAround> around =
          isInFloats ? test.nearRims(center, 0.1)->around(center, radius) : rims.around(center, radius);
      if (!around) continue;
      ++balls;
      for (const glm::dvec3 offset : {glm::dvec3(0.0), down}) {
        const double ofBall = offset == down ? 0.0 : radius;
        EXPECT_FALSE(isFarFromMembranes(*around, offset, ofBall, 1.01 * *nearest));
        EXPECT_TRUE(isFarFromMembranes(*around, offset, ofBall, 0.98 * *nearest));
      }
    }
  }
  EXPECT_GT(balls, 1000);
}

TEST(Rims, AreTheSameWithAndWithoutAvx2) {
  const MeshCase squares = tornSquares(30);
  const TriangleSoup soup = gatherTriangles(squares.input());
  const Rims rims(soup, allTriangles(soup));
  for (const glm::dvec3 point : randomPoints(50, 0.7, 35)) {
    const double fraction = rims.fractionAt(point), change = rims.mostChange(point, 0.01);
    const glm::dvec3 slope = rims.slopeAt(point), slopeOfBoth = rims.fractionAndSlopeAt(point).slope;
    limitSimd(SimdLevel::Portable);
    EXPECT_EQ(rims.fractionAt(point), fraction);
    EXPECT_EQ(rims.mostChange(point, 0.01), change);
    EXPECT_EQ(rims.slopeAt(point), slope);
    EXPECT_EQ(rims.fractionAndSlopeAt(point).slope, slopeOfBoth);
    limitSimd(SimdLevel::Avx512);
  }
}

TEST(SampleSigns, AreThoseOfEachSample) {
  for (const char* name : {"utah_teapot_1k.glb", "plane_holes_17k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const TriangleSoup soup = gatherTriangles(FileCase(name).input());
    const MeshTopology topology = analyseTopology(soup);
    const MeshHierarchy hierarchy(soup, allTriangles(soup));
    const InsideTest test(soup, topology, hierarchy, SignMethod::Winding, "case");
    const MeshDistance distance(hierarchy);
    SampleGrid grid{-0.75 * glm::dvec3(soup.reach), 1.5 * soup.reach / (8 * kBrickCells), glm::ivec3(8)};
    const std::vector<std::uint8_t> steady = findSteadyCells(grid, test);
    EXPECT_GT(std::count(steady.begin(), steady.end(), 1), 50);
    EXPECT_GT(std::count(steady.begin(), steady.end(), 0), 0);
    for (std::size_t cell = 0; cell < grid.cellCount(); ++cell) {
      if (steady[cell]) continue;
      const glm::ivec3 brick = grid.brickOfCell(cell);
      std::array<float, kBrickSampleCount> distances;
      for (std::size_t i = 0; i < distances.size(); ++i)
        distances[i] =
            static_cast<float>(distance.nearest(grid.sample(brick, sampleOfIndex(i))).distance / grid.voxelSize);
      const SampleSigns signs = askSamples(grid, brick, test, distances.data());
      int wrong = 0;
      for (std::size_t i = 0; i < distances.size(); ++i)
        if (distances[i] > 1e-4f) wrong += signs[i] != test.isInside(grid.sample(brick, sampleOfIndex(i)));
      EXPECT_EQ(wrong, 0) << cell;
    }
  }
}
