// What is known of rims around a brick, in floats and at once, against all edges in double.
#include "bakers/near_rims.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "bakers/open_winding.h"
#include "bakers/simd_level.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

/// Squares that stand apart in a lattice: 64 loops, some of them near, most of them far.
MeshCase lattice(float side = 0.06f) {
  MeshCase squares;
  for (int i = 0; i < 64; ++i) {
    const glm::vec3 corner = 0.2f * glm::vec3(i % 4, i / 4 % 4, i / 16) + glm::vec3(0, 0, 0.013f * (i % 5));
    squares.addQuad(corner, corner + glm::vec3(side, 0, 0), corner + glm::vec3(side, side, 0.01f),
                    corner + glm::vec3(0, side, 0.02f));
  }
  return squares;
}

double offWhole(double turns) { return std::abs(turns - std::round(turns)); }

glm::dvec3 inBall(glm::dvec3 direction, double radius) {
  return direction / std::max(glm::length(direction), 1.0) * radius;
}

struct Seen {
  int known = 0, sharp = 0, beside = 0;
  int evenBySum = 0; ///< balls in which the sum of all edges' slopes is the better bound
};

/// Holds numbers, slopes and turns in balls against exact ones.
Seen look(const TriangleSoup& soup, double halfEdge, double ballRadius) {
  const OpenWinding winding(soup, allTriangles(soup));
  Seen seen;
  for (const glm::dvec3 center : randomPoints(120, halfEdge, 61)) {
    const std::optional<NearRims> near = winding.nearRims(center, ballRadius);
    for (const glm::dvec3 direction : randomPoints(8, 0.57, 62))
      for (const double part : {0.0, 0.02, 0.3}) {
        const glm::dvec3 place = center + inBall(direction, (1 - part) * ballRadius);
        const double exact = winding.exactlyAt(place);
        const NearlyTurns turns = winding.nearlyAt(place, *near);
        EXPECT_LE(std::abs(turns.turns - exact), turns.slack + 1e-12);
        const std::optional<WindingAround> around = near->around(place, part * ballRadius);
        if (!around) {
          ++seen.beside;
          continue;
        }
        EXPECT_LE(offWhole(around->fraction - exact), around->slack + 1e-12);
        ++seen.known;
        seen.evenBySum += around->most < glm::length(around->slope) + around->bend * part * ballRadius;
        seen.sharp += around->slack < 5e-3 && turns.slack < 5e-3;
        for (const glm::dvec3 way : randomPoints(4, 0.57, 63)) {
          const glm::dvec3 offset = inBall(way, part * ballRadius), slope = winding.rims().slopeAt(place + offset);
          const double away = glm::length(offset), number = winding.exactlyAt(place + offset);
          EXPECT_LE(offWhole(number - around->at(offset)), around->slack + 0.5 * around->bend * away * away + 1e-12);
          EXPECT_LE(glm::length(slope - around->slope), around->slopeSlack + around->bend * away + 1e-9);
          EXPECT_LE(glm::length(slope), around->steepest(away) + 1e-9);
          EXPECT_GE(offWhole(number - 0.5), around->leastFromHalf(glm::dvec3(0.0), part * ballRadius) - 1e-12);
        }
      }
  }
  return seen;
}

} // namespace

TEST(NearRims, KeepToTheirSlack) {
  const Seen ofSquares = look(lattice().soup(), 0.9, 0.08);
  EXPECT_GT(ofSquares.known, 1000);
  EXPECT_GT(ofSquares.beside, 0);
  EXPECT_GT(ofSquares.evenBySum, 50);
  EXPECT_GT(look(lattice(0.03f).soup(), 0.5, 0.02).known, 1000); // some far loops are on the ray
  for (const char* name : {"utah_teapot_1k.glb", "utah_teapot_2464.glb", "plane_holes_17k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const Seen seen = look(gatherTriangles(FileCase(name).input()), 0.7, 0.05);
    EXPECT_GT(seen.known, 1000);
    EXPECT_GT(seen.sharp, seen.known / 2);
  }
}

TEST(NearRims, KeepToTheirSlackBesideEdges) {
  const TriangleSoup soup = lattice().soup();
  const OpenWinding winding(soup, allTriangles(soup));
  int unclear = 0, known = 0;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    for (const double away : {1e-2, 1e-3, 1e-5, 1e-7})
      for (const glm::dvec3 offset : randomPoints(4, away, 64 + t)) {
        const auto corners = soup.corners(t);
        const glm::dvec3 place = glm::mix(corners[0], corners[1], 0.37) + offset;
        const std::optional<NearRims> near = winding.nearRims(place + glm::dvec3(0.01, -0.02, 0.015), 0.05);
        const NearlyTurns turns = winding.nearlyAt(place, *near);
        unclear += turns.slack == HUGE_VAL;
        known += turns.slack < 0.1;
        EXPECT_LE(std::abs(turns.turns - winding.exactlyAt(place)), turns.slack + 1e-12);
      }
  EXPECT_GT(known, 1000);
}

// Seen along the ray from such points, an edge is right behind them: floats cannot tell on which side of its strip.
TEST(NearRims, TellWhereStripsHaveNoSide) {
  const TriangleSoup soup = lattice().soup();
  const OpenWinding winding(soup, allTriangles(soup));
  int unclear = 0;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    for (const double behind : {0.01, 0.03}) {
      const auto corners = soup.corners(t);
      const glm::dvec3 on = glm::mix(corners[0], corners[1], 0.37);
      const std::optional<NearRims> near = winding.nearRims(on, 0.05);
      const glm::dvec3 place = on - behind * near->rayFrom(on).direction();
      const NearlyTurns turns = winding.nearlyAt(place, *near);
      unclear += turns.slack == HUGE_VAL;
      EXPECT_LE(std::abs(turns.turns - winding.exactlyAt(place)), turns.slack + 1e-12);
    }
  EXPECT_GT(unclear, 100);
}

TEST(NearRims, AreTheSameWithAndWithoutAvx2) {
  const TriangleSoup soup = lattice().soup();
  const OpenWinding winding(soup, allTriangles(soup));
  for (const glm::dvec3 center : randomPoints(100, 0.7, 65)) {
    const std::optional<NearRims> near = winding.nearRims(center, 0.1);
    const NearlyTurns turns = near->turnsAt(center);
    const std::optional<WindingAround> around = near->around(center, 0.02);
    limitSimd(SimdLevel::Portable);
    EXPECT_EQ(near->turnsAt(center).turns, turns.turns);
    EXPECT_EQ(near->turnsAt(center).slack, turns.slack);
    const std::optional<WindingAround> narrow = near->around(center, 0.02);
    limitSimd(SimdLevel::Avx512);
    ASSERT_EQ(narrow.has_value(), around.has_value());
    if (!around) continue;
    EXPECT_EQ(narrow->fraction, around->fraction);
    EXPECT_EQ(narrow->slope, around->slope);
    EXPECT_EQ(narrow->bend, around->bend);
    EXPECT_EQ(narrow->slack, around->slack);
  }
}
