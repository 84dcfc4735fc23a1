// Closed meshes are certain, holes are not, sheets have no inside.
#include "bakers/sign_census.h"

#include <gtest/gtest.h>

#include "tests/bake/bakers/mesh_cases.h"

namespace brickfield {
namespace {

using namespace test;

SignCensus censusOf(const MeshCase& mesh, SignMethod sign = SignMethod::Auto) {
  BakeSettings settings;
  settings.resolution = 64, settings.sign = sign;
  return takeSignCensus(mesh.input(), settings, bakeField(mesh.input(), settings).field);
}

TEST(SignCensus, ClosedMeshIsCertain) {
  MeshCase ball;
  ball.addSphere({0, 0, 0}, 1, 24, 48);
  const SignCensus census = censusOf(ball);
  EXPECT_GT(census.samples, 10000u);
  EXPECT_NEAR(census.byClosed, 1, 1e-9);
  EXPECT_EQ(census.meanSureness, 1);
  EXPECT_EQ(census.leastSureness, 1);
  EXPECT_EQ(census.doubtful, 0);
  EXPECT_EQ(census.overruled, 0);
}

TEST(SignCensus, HolesMakeItLessSure) {
  const auto withoutRings = [](int rings) {
    MeshCase ball;
    ball.addSphere({0, 0, 0}, 1, 24, 48, rings);
    return censusOf(ball);
  };
  const SignCensus small = withoutRings(2), large = withoutRings(6);
  for (const SignCensus& census : {small, large}) {
    EXPECT_NEAR(census.byOpen, 1, 1e-9);
    EXPECT_LT(census.leastSureness, 0.9);
  }
  EXPECT_GT(small.meanSureness, 0.9);
  EXPECT_LT(large.meanSureness, small.meanSureness);
  EXPECT_GT(large.doubtful, small.doubtful);
}

TEST(SignCensus, SheetsHaveNoInside) {
  MeshCase quad;
  quad.addQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  EXPECT_NEAR(censusOf(quad).bySheets, 1, 1e-9);
  quad.addBox({2, -1, -1}, {4, 1, 1});
  const SignCensus both = censusOf(quad);
  EXPECT_GT(both.bySheets, 0.05);
  EXPECT_GT(both.byClosed, 0.5);
  EXPECT_EQ(both.byOpen, 0);
}

} // namespace
} // namespace brickfield
