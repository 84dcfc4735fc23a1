// Parts thinner than a voxel: plates, tubes and shells of known thickness, alone and inside of others.
#include "bakers/thin_parts.h"

#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "field/bricks_file.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr double kSampling = 0.01; // 4096 places

ThinParts thinPartsOf(const MeshCase& mesh, int resolution, SignMethod sign = SignMethod::Auto) {
  BakeSettings settings;
  settings.resolution = resolution;
  settings.mips = 1;
  settings.attributes = false;
  settings.sign = sign;
  return bakeField(mesh.input(), settings).field.thinParts;
}

double share(const ThinParts& thin) { return static_cast<double>(thin.perTenThousand) / ThinParts::kWhole; }

/// 2 m wide: at 32 voxels a voxel is 1/16 m.
MeshCase plate(float thickness) {
  MeshCase result;
  result.addBox({-1, 0, -1}, {1, thickness, 1});
  return result;
}

} // namespace

TEST(ThinParts, ThickSolidsHaveNone) {
  MeshCase ball;
  ball.addSphere({0, 0, 0}, 1, 24, 48);
  MeshCase box;
  box.addBox({-1, -1, -1}, {1, 1, 1});
  for (const MeshCase* mesh : {&ball, &box}) {
    EXPECT_EQ(thinPartsOf(*mesh, 32).perTenThousand, 0);
    EXPECT_EQ(thinPartsOf(*mesh, 32).resolution, 0);
  }
  EXPECT_EQ(thinPartsOf(plate(1.1f / 16), 32), ThinParts{});
}

TEST(ThinParts, PlateIsThinOnItsLargeFaces) {
  for (const float voxels : {0.9f, 0.5f, 0.1f, 0.01f, 0.001f}) {
    const float thickness = voxels / 16;
    const ThinParts thin = thinPartsOf(plate(thickness), 32);
    EXPECT_NEAR(share(thin), 8 / (8 + 8 * thickness), kSampling) << voxels;
    // Thickness is found by steps of sqrt(2), down to 1/128 voxel.
    EXPECT_GE(thin.resolution, 32 / std::max(voxels, 1 / 128.0f)) << voxels;
    EXPECT_LE(thin.resolution, 32 / std::max(voxels, 1 / 128.0f) * 1.42f + 1) << voxels;
  }
}

TEST(ThinParts, ResolutionThatWouldDoDoes) {
  const ThinParts thin = thinPartsOf(plate(0.3f / 16), 32);
  ASSERT_GT(thin.resolution, 0);
  EXPECT_EQ(thinPartsOf(plate(0.3f / 16), thin.resolution).resolution, 0);
}

TEST(ThinParts, AreFoundWhicheverWayTheMeshFaces) {
  MeshCase turned;
  turned.addBox({-1, 0, -1}, {1, 0.5f / 16, 1}, true);
  EXPECT_NEAR(share(thinPartsOf(turned, 32)), 1, 0.05);
  EXPECT_NEAR(share(thinPartsOf(plate(0.5f / 16), 32, SignMethod::Pseudonormal)), 1, 0.05);
}

TEST(ThinParts, WallsOfAHollowBallAreThinAndItsRoomIsNot) {
  const auto shell = [](float inner) {
    MeshCase result;
    result.addSphere({0, 0, 0}, 1, 48, 96);
    MeshCase cavity;
    cavity.addSphere({0, 0, 0}, inner, 48, 96);
    auto& indices = cavity.primitive().indices;
    for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]); // faces inwards
    result.scene.meshes[0].primitives.push_back(cavity.primitive());
    return result;
  };
  EXPECT_NEAR(share(thinPartsOf(shell(1 - 0.5f / 16), 32)), 1, kSampling);
  EXPECT_EQ(thinPartsOf(shell(0.8f), 32).perTenThousand, 0);
}

// A plate half sunk into a thick box is not lost, though its own sides are near.
TEST(ThinParts, WhatASolidHoldsIsNotThin) {
  MeshCase scene;
  scene.addBox({-1, -1, -1}, {1, 1, 1});
  scene.addBox({-0.5f, 0.98f, -0.5f}, {0.5f, 1.02f, 0.5f});
  EXPECT_LT(share(thinPartsOf(scene, 32)), 0.01);
}

TEST(ThinParts, ShareIsThatOfTheWholeMesh) {
  MeshCase scene; // a thick box of 24 square metres and a thin plate of 8
  scene.addBox({-1, -1, -1}, {1, 1, 1});
  scene.addBox({-1, 1.5f, -1}, {1, 1.5f + 0.5f / 16, 1});
  EXPECT_NEAR(share(thinPartsOf(scene, 40)), 0.25, kSampling);
}

TEST(ThinParts, SheetsDoNotCount) {
  MeshCase quad;
  quad.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  EXPECT_EQ(thinPartsOf(quad, 32), ThinParts{});
  quad.addQuad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}); // the same from behind: closed by its edges
  EXPECT_EQ(thinPartsOf(quad, 32), ThinParts{});
  EXPECT_EQ(thinPartsOf(plate(0.5f / 16), 32, SignMethod::TwoSided), ThinParts{});
}

TEST(ThinParts, AreKeptInFiles) {
  BakeSettings settings;
  settings.resolution = 32;
  const BrickField field = bakeField(plate(0.5f / 16).input(), settings).field;
  ASSERT_NE(field.thinParts, ThinParts{});
  EXPECT_EQ(decodeBricks(encodeBricks(field), "plate").thinParts, field.thinParts);
  BrickField wrong = field;
  wrong.thinParts.perTenThousand = ThinParts::kWhole + 1;
  EXPECT_NE(validateField(wrong).find("thin parts of 10001 ten-thousandths"), std::string::npos);
}
