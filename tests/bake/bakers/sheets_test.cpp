// Which triangles count as sheets.
#include "bakers/sheets.h"

#include <gtest/gtest.h>

#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

SolidsAndSheets split(const TriangleSoup& soup, double voxelMetres, bool isCutOut = false, bool isDoubleSided = false) {
  SheetRequest request;
  request.voxelSize = voxelMetres * soup.unitsPerMetre;
  request.halfThickness = 0.5 * request.voxelSize;
  request.isCutOut.assign(soup.triangles.size(), isCutOut);
  request.isDoubleSided.assign(soup.triangles.size(), isDoubleSided);
  return findSheets(soup, analyseTopology(soup), request);
}

} // namespace

TEST(Sheets, ClosedMeshHasNone) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  const SolidsAndSheets result = split(box.soup(), 2.0 / 64);
  EXPECT_EQ(result.solid.size(), 12u);
  EXPECT_EQ(result.sheets.size(), 0u);
}

TEST(Sheets, QuadIsOne) {
  MeshCase quad;
  quad.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  const SolidsAndSheets result = split(quad.soup(), 2.0 / 64);
  EXPECT_EQ(result.solid.size(), 0u);
  EXPECT_EQ(result.sheets.size(), 2u);
}

TEST(Sheets, QuadOfTwoFacingSidesIsOneOfTwoTriangles) {
  MeshCase quad;
  quad.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  quad.addQuad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});
  const SolidsAndSheets result = split(quad.soup(), 2.0 / 64);
  EXPECT_EQ(result.solid.size(), 0u);
  EXPECT_EQ(result.sheets.size(), 2u);
}

TEST(Sheets, WallBetweenTwoSolidsIsNone) {
  MeshCase boxes; // they share a face: a flat pair inside a solid
  boxes.addBox({-1, -1, -1}, {0, 1, 1});
  boxes.addBox({0, -1, -1}, {1, 1, 1});
  const SolidsAndSheets result = split(boxes.soup(), 2.0 / 64);
  EXPECT_EQ(result.sheets.size(), 0u);
  EXPECT_EQ(result.solid.size(), 20u);
}

TEST(Sheets, FloorBesideABoxIsOneAndTheBoxIsNone) {
  MeshCase scene;
  scene.addBox({-1, 0.5, -1}, {1, 2.5, 1});
  scene.addQuad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5});
  const SolidsAndSheets result = split(scene.soup(), 10.0 / 128);
  EXPECT_EQ(result.solid.size(), 12u);
  EXPECT_EQ(result.sheets, (std::vector<std::uint32_t>{12, 13}));
}

TEST(Sheets, ValleyOfTerrainIsNotFilled) {
  MeshCase terrain; // half a pipe, seen from above: its axis lies before the faces
  constexpr int kStrips = 24;
  const auto rim = [](int i, float z) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / kStrips;
    return glm::vec3(-std::cos(angle), -std::sin(angle), z);
  };
  for (int i = 0; i < kStrips; ++i) terrain.addQuad(rim(i, -2), rim(i, 2), rim(i + 1, 2), rim(i + 1, -2));
  const SolidsAndSheets result = split(terrain.soup(), 4.0 / 128);
  EXPECT_EQ(result.solid.size(), 0u);
  EXPECT_EQ(result.sheets.size(), 2u * kStrips);
}

TEST(Sheets, CutOutCardsAreWithoutALook) {
  MeshCase bowl;
  bowl.addSphere({0, 0, 0}, 1, 16, 32, 8);
  EXPECT_EQ(split(bowl.soup(), 2.0 / 64).sheets.size(), 0u);
  EXPECT_EQ(split(bowl.soup(), 2.0 / 64, true).solid.size(), 0u);
}

TEST(Sheets, HouseStaysSolidOnAGroundThatIsOneAsAWhole) {
  MeshCase house; // walls and roof without a floor, on a ground plane that reaches beyond them and closes them
  house.addBox({-1, 0, -1}, {1, 2, 1});
  auto& indices = house.primitive().indices;
  indices.erase(indices.begin() + 12, indices.begin() + 18);     // the face at y = 0
  house.addQuad({-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}); // faces down
  const SolidsAndSheets result = split(house.soup(), 8.0 / 128);
  EXPECT_EQ(result.sheets, (std::vector<std::uint32_t>{10, 11}));
  EXPECT_EQ(result.solid.size(), 10u);
}

TEST(Sheets, BoxWithoutLidIsOneWhereBothSidesShow) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  auto& indices = box.primitive().indices;
  indices.erase(indices.begin() + 18, indices.begin() + 24); // the face at y = 1
  EXPECT_EQ(split(box.soup(), 2.0 / 128, false, true).sheets.size(), 10u);
  EXPECT_EQ(split(box.soup(), 2.0 / 128, false, false).solid.size(), 10u);
}

TEST(Sheets, RoomOfWallsIsOneAsAWhole) {
  MeshCase room; // ceiling and three walls that face away from it: within, the winding number passes one half
  room.addBox({-3, 0, -3}, {3, 2.7f, 3});
  auto& indices = room.primitive().indices;
  indices.erase(indices.begin() + 30, indices.end());        // the face at z = 3
  indices.erase(indices.begin() + 12, indices.begin() + 18); // the floor
  const TriangleSoup soup = room.soup();
  EXPECT_GT(bruteWinding(soup, soup.soupFromObject({0, 1.5, -1})), 0.5);
  EXPECT_EQ(split(soup, 6.0 / 128, false, true).sheets.size(), 8u);
}

TEST(Sheets, ShellThatNearlyClosesIsSolidAllOver) {
  MeshCase ball; // without its cap: a hole of 22 degrees from the pole
  ball.addSphere({0, 0, 0}, 1, 16, 32, 2);
  EXPECT_EQ(split(ball.soup(), 2.0 / 128, false, true).sheets.size(), 0u);
}

TEST(Sheets, SheetThatAnotherOneHidAtFirstIsFound) {
  MeshCase pair; // a small quad high above a floor that faces down: between them there is almost a whole turn, at first
  pair.addQuad({-0.25f, 4, -0.25f}, {-0.25f, 4, 0.25f}, {0.25f, 4, 0.25f}, {0.25f, 4, -0.25f});
  pair.addQuad({-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20});
  const TriangleSoup soup = pair.soup();
  EXPECT_GT(bruteWinding(soup, soup.soupFromObject({0, 3.8, 0})), 0.6);
  const SolidsAndSheets result = split(soup, 40.0 / 128);
  EXPECT_EQ(result.solid.size(), 0u);
  EXPECT_EQ(result.sheets.size(), 4u);
}

TEST(Sheets, BunnyWithHolesKeepsItsSkin) {
  BRICKFIELD_NEEDS_DATA("stanford_bunny_69k.glb");
  const FileCase file("stanford_bunny_69k.glb");
  const SolidsAndSheets result = split(gatherTriangles(file.input()), 1.0 / 128);
  EXPECT_LT(result.sheets.size(), 100u);
}
