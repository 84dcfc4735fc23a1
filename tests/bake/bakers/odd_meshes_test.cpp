// What the baker makes of meshes that are no clean solids. The table in src/README.md says the same in words.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "field/iso_surface.h"
#include "tests/bake/bakers/mesh_cases.h"
#include "tests/support/manifold_check.h"

namespace brickfield {
namespace {

using namespace test;

constexpr glm::vec3 kOne(1), kHalf(0.5f);

struct Side {
  glm::vec3 point;
  bool isInside;
};

/// Bakes with 16 bits and expects the sides on every level.
BakeResult expectSides(const MeshCase& mesh, std::initializer_list<Side> sides, SignMethod sign = SignMethod::Auto) {
  BakeSettings settings;
  settings.resolution = 64, settings.bits = 16, settings.sign = sign;
  const BakeResult result = bakeField(mesh.input(), settings);
  for (std::size_t level = 0; level < result.field.levels.size(); ++level)
    for (const Side& side : sides)
      EXPECT_EQ(sampleDistance(result.field, level, side.point) < 0, side.isInside)
          << fmt::format("level {} at {},{},{}", level, side.point.x, side.point.y, side.point.z);
  return result;
}

/// Holes through it and parts of it, by the surface of its finest level.
ManifoldCheck surfaceOf(const BakeResult& result) {
  return checkManifold(extractIsoSurface(result.field, 0, 0).indices);
}

/// The same triangles once more, turned over.
void addTurned(MeshCase& mesh) {
  const std::vector<glm::vec3> corners = mesh.primitive().positions;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) mesh.addTriangle(corners[i], corners[i + 2], corners[i + 1]);
}

/// Frames of turned triangles are rounded the other way: by a step of the code.
void expectSameToACode(const BrickLevel& level, const BrickLevel& other) {
  ASSERT_EQ(level.brickCount(), other.brickCount());
  for (std::uint32_t brick = 0; brick < level.brickCount(); ++brick)
    for (int i = 0; i < kBrickSampleCount; ++i) {
      const glm::ivec3 sample(i % 8, i / 8 % 8, i / 64);
      ASSERT_NEAR(storedDistance(level, brick, sample), storedDistance(other, brick, sample),
                  1.01f * level.rangeVoxels / 32767);
    }
}

TEST(OddMeshes, NestedThatFaceOutwardsAreOneSolid) {
  MeshCase nest;
  nest.addBox(-kOne, kOne), nest.addBox(-kHalf, kHalf);
  const BakeResult result = expectSides(nest, {{{0, 0, 0}, true}, {{0.75f, 0, 0}, true}, {{1.02f, 0, 0}, false}});
  EXPECT_EQ(result.stats.sign, "winding of closed surfaces");
  EXPECT_EQ(surfaceOf(result).components, 1u);
}

TEST(OddMeshes, NestedThatFacesInwardsIsACavity) {
  MeshCase hollow;
  hollow.addBox(-kOne, kOne), hollow.addBox(-kHalf, kHalf, true);
  const BakeResult result = expectSides(hollow, {{{0, 0, 0}, false}, {{0.75f, 0, 0}, true}, {{1.02f, 0, 0}, false}});
  EXPECT_EQ(surfaceOf(result).components, 2u);
}

TEST(OddMeshes, NestedByParityIsACavityEitherWay) {
  MeshCase nest;
  nest.addBox(-kOne, kOne), nest.addBox(-kHalf, kHalf);
  expectSides(nest, {{{0.03f, 0.02f, 0.01f}, false}, {{0.75f, 0.02f, 0.01f}, true}}, SignMethod::Parity);
}

TEST(OddMeshes, InsideOutIsTheSameSolid) {
  MeshCase turned;
  turned.addBox(-kOne, kOne, true);
  const BakeResult result = expectSides(turned, {{{0, 0, 0}, true}, {{1.02f, 0, 0}, false}});
  MeshCase plain;
  plain.addBox(-kOne, kOne);
  expectSameToACode(result.field.levels[0], expectSides(plain, {}).field.levels[0]);
}

TEST(OddMeshes, SelfIntersectingIsTheUnion) {
  MeshCase cross;
  cross.addBox({-1, -0.3f, -0.3f}, {1, 0.3f, 0.3f});
  cross.addBox({-0.3f, -1, -0.3f}, {0.3f, 1, 0.3f});
  const BakeResult result =
      expectSides(cross, {{{0, 0, 0}, true}, {{0.9f, 0, 0}, true}, {{0, 0.9f, 0}, true}, {{0.6f, 0.6f, 0}, false}});
  const ManifoldCheck surface = surfaceOf(result);
  EXPECT_EQ(surface.components, 1u);
  EXPECT_EQ(surface.eulerCharacteristic(), 2);
}

TEST(OddMeshes, SelfIntersectingOfBothKindsIsWrappedAtAll) {
  // Where a part that faces inwards overlaps one that faces outwards, nothing is wrapped: an overlap of +1 and -1.
  MeshCase cross;
  cross.addBox({-1, -0.3f, -0.3f}, {1, 0.3f, 0.3f});
  cross.addBox({-0.3f, -1, -0.3f}, {0.3f, 1, 0.3f}, true);
  expectSides(cross, {{{0.02f, 0.01f, 0.03f}, false}, {{0.9f, 0, 0}, true}, {{0, 0.9f, 0}, true}});
}

TEST(OddMeshes, SurfaceThatCrossesItselfIsSolidWhereItWrapsAnything) {
  // A prism over a bow tie: one half is wrapped +1 times, the other -1 times.
  MeshCase tie;
  const glm::vec2 outline[4] = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}};
  for (int i = 0; i < 4; ++i) {
    const glm::vec2 a = outline[i], b = outline[(i + 1) % 4];
    tie.addQuad({a, -0.5f}, {b, -0.5f}, {b, 0.5f}, {a, 0.5f});
  }
  tie.addQuad({outline[0], 0.5f}, {outline[1], 0.5f}, {outline[2], 0.5f}, {outline[3], 0.5f});
  tie.addQuad({outline[3], -0.5f}, {outline[2], -0.5f}, {outline[1], -0.5f}, {outline[0], -0.5f});
  expectSides(tie, {{{0.7f, 0.05f, 0}, true}, {{-0.7f, 0.05f, 0}, true}, {{0.05f, 0.7f, 0}, false}});
}

TEST(OddMeshes, FlatIsASheetBehindItsFront) {
  MeshCase quad; // faces +z
  quad.addQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  const BakeResult result = expectSides(quad, {{{0, 0, 0.04f}, false}, {{0, 0, -0.02f}, true}});
  EXPECT_EQ(result.stats.sign, "two-sided");
  EXPECT_EQ(result.stats.sheetTriangles, 2u);
  EXPECT_EQ(surfaceOf(result).eulerCharacteristic(), 2) << "a slab without holes";
}

TEST(OddMeshes, FlatOfTwoLayersIsASheetAboutThem) {
  MeshCase pair;
  pair.addQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  addTurned(pair);
  const BakeResult result = expectSides(pair, {{{0, 0, 0.01f}, true}, {{0, 0, -0.01f}, true}, {{0, 0, 0.2f}, false}});
  EXPECT_EQ(result.stats.sign, "two-sided");
  EXPECT_EQ(surfaceOf(result).eulerCharacteristic(), 2);
}

TEST(OddMeshes, FlatOfTwoLayersWithOtherDiagonalsIsASolidDrawnThicker) {
  MeshCase pair;
  pair.addQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  pair.addQuad({-1, 1, 0}, {1, 1, 0}, {1, -1, 0}, {-1, -1, 0});
  const BakeResult result = expectSides(pair, {{{0, 0, 0.01f}, true}, {{0, 0, -0.01f}, true}, {{0, 0, 0.2f}, false}});
  EXPECT_EQ(result.stats.sign, "winding of closed surfaces");
  EXPECT_EQ(result.field.thinParts.perTenThousand, ThinParts::kWhole);
  EXPECT_EQ(surfaceOf(result).eulerCharacteristic(), 2);
}

TEST(OddMeshes, SingleTriangleIsASheet) {
  MeshCase triangle;
  triangle.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const BakeResult result = expectSides(triangle, {{{0.2f, 0.2f, -0.01f}, true}, {{0.9f, 0.9f, 0}, false}});
  EXPECT_EQ(result.stats.openEdges, 3u);
  const ManifoldCheck surface = surfaceOf(result);
  EXPECT_EQ(surface.components, 1u);
  EXPECT_EQ(surface.eulerCharacteristic(), 2);
}

TEST(OddMeshes, DuplicatedIsTheSameSolid) {
  MeshCase twice, once;
  once.addBox(-kOne, kOne);
  for (int i = 0; i < 2; ++i) twice.addBox(-kOne, kOne);
  const BakeResult result = expectSides(twice, {{{0, 0, 0}, true}, {{1.02f, 0, 0}, false}});
  EXPECT_EQ(result.field.levels[0].distances, expectSides(once, {}).field.levels[0].distances);
  EXPECT_GT(result.stats.nonManifoldEdges, 0u);
  EXPECT_EQ(result.stats.openEdges, 0u);
}

TEST(OddMeshes, DuplicatedAndTurnedIsASheet) {
  // Front and back cancel out everywhere: nothing is wrapped, and both sides are seen.
  MeshCase both;
  both.addBox(-kOne, kOne);
  addTurned(both);
  const BakeResult result = expectSides(both, {{{0, 0, 0}, false}, {{1, 0.1f, 0.1f}, true}, {{1.2f, 0, 0}, false}});
  EXPECT_EQ(result.stats.sign, "two-sided");
  EXPECT_EQ(surfaceOf(result).components, 2u) << "an outer and an inner skin";
}

TEST(OddMeshes, DegenerateTrianglesCountForNothing) {
  MeshCase box, plain;
  plain.addBox(-kOne, kOne);
  box.addBox(-kOne, kOne);
  box.addTriangle({0, 0, 0}, {0, 0, 0}, {3, 0, 0});
  box.addTriangle({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
  const BakeResult result = expectSides(box, {{{0, 0, 0}, true}, {{1.02f, 0, 0}, false}});
  EXPECT_EQ(result.stats.degenerateTriangles, 2u);
  expectSameToACode(result.field.levels[0], expectSides(plain, {}).field.levels[0]);
}

TEST(OddMeshes, NothingButDegenerateTrianglesIsRefused) {
  MeshCase line;
  line.addTriangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  try {
    bakeField(line.input("node 1 \"Line\""), {});
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("node 1 \"Line\""));
  }
}

TEST(OddMeshes, FaceTurnedTheWrongWayLeavesTheSolid) {
  // One of a ball's triangles faces inwards: its edges are non-manifold, and the component no longer closes.
  MeshCase ball;
  ball.addSphere({0, 0, 0}, 1, 24, 48);
  std::swap(ball.primitive().indices[300], ball.primitive().indices[301]);
  const BakeResult result = expectSides(ball, {{{0, 0, 0}, true}, {{0.9f, 0, 0}, true}, {{1.1f, 0, 0}, false}});
  EXPECT_EQ(result.stats.nonManifoldEdges, 3u);
  EXPECT_EQ(surfaceOf(result).eulerCharacteristic(), 2);
}

TEST(OddMeshes, HoleInABallIsClosed) {
  MeshCase ball;
  ball.addSphere({0, 0, 0}, 1, 24, 48, 2); // without its cap of 15 degrees
  const BakeResult result = expectSides(ball, {{{0, 0, 0}, true}, {{0, 0.9f, 0}, true}, {{0, 1.05f, 0}, false}});
  EXPECT_EQ(result.stats.sign, "winding of open surfaces");
  EXPECT_EQ(surfaceOf(result).eulerCharacteristic(), 2);
}

} // namespace
} // namespace brickfield
