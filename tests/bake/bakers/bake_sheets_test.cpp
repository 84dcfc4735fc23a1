// Whole bakes of sheets: the slab's thickness, seen from both sides, at every level; solids and sheets together.
#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

// Where the middle of a slab of half thickness t = 0.5625 voxel falls between two samples, a and 1 - a from them,
// trilinear reading moves its side by (a - t)(2 - 2a)/(2a - 1), at most 0.21; the 8-bit code adds 0.016, over a slope
// of at least 0.36.
constexpr float kKinkVoxels = 0.255f;
// Depth of a slab behind its front, sqrt(3) voxels and a little; its front is as exact as the 8-bit code,
// whose error falls on a slope that samples beyond the middle may halve.
constexpr float kDepthVoxels = 1.755f;
constexpr float kFrontVoxels = 0.05f;

BakeSettings settingsOf(int resolution, float thickness = 0) {
  BakeSettings settings;
  settings.resolution = resolution;
  settings.thickness = thickness;
  return settings;
}

/// Where a ray down -y and one up +y at (x, z) meet the field: height of the upper and the lower side.
glm::vec2 sidesAt(const BrickField& field, std::size_t level, float x, float z) {
  const auto down = traceField(field, level, {x, 10, z}, {0, -1, 0}, 0, 20);
  const auto up = traceField(field, level, {x, -10, z}, {0, 1, 0}, 0, 20);
  EXPECT_TRUE(down && up) << "nothing to see at " << x << ", " << z << " of level " << level;
  return {down ? 10 - *down : -99.0f, up ? *up - 10 : 99.0f};
}

/// Of two triangles: double-sided ones this large have centred slabs.
MeshCase tiltedQuad(float slope, bool doubleSided = true) {
  MeshCase quad;
  quad.material().doubleSided = doubleSided;
  const auto at = [&](float x, float z) { return glm::vec3(x, slope * x, z); };
  quad.addQuad(at(-1, -1), at(-1, 1), at(1, 1), at(1, -1));
  return quad;
}

} // namespace

TEST(BakeSheets, FlatQuadIsASlabFromBothSidesOnEveryLevel) {
  const BrickField field = bakeField(tiltedQuad(0).input(), settingsOf(64)).field;
  for (std::size_t level = 0; level < field.levels.size(); ++level) {
    const float voxel = field.levels[level].voxelSizeObject;
    for (const float x : {-0.9f, -0.33f, 0.0f, 0.517f, 0.93f}) {
      const glm::vec2 sides = sidesAt(field, level, x, 0.3f * x);
      // Half a voxel and a sixteenth to each side.
      EXPECT_NEAR(sides.x, 0.5625f * voxel, kKinkVoxels * voxel);
      EXPECT_NEAR(sides.y, -0.5625f * voxel, kKinkVoxels * voxel);
    }
  }
}

TEST(BakeSheets, TiltedQuadsHaveNoHoles) {
  for (const float slope : {0.1f, 0.37f, 1.0f}) {
    const BrickField field = bakeField(tiltedQuad(slope).input(), settingsOf(48)).field;
    for (int i = 0; i < 500; ++i) {
      const float x = -0.95f + 0.0038f * static_cast<float>(i), z = std::sin(17.0f * x) * 0.9f;
      for (std::size_t level = 0; level < 2; ++level) {
        const glm::vec2 sides = sidesAt(field, level, x, z);
        // The slab is cut across by the ray.
        const float half = 0.5625f * field.levels[level].voxelSizeObject * std::sqrt(1 + slope * slope);
        const float across = kKinkVoxels * field.levels[level].voxelSizeObject * std::sqrt(1 + slope * slope);
        EXPECT_NEAR(sides.x, slope * x + half, across);
        EXPECT_NEAR(sides.y, slope * x - half, across);
      }
    }
  }
}

TEST(BakeSheets, SingleSidedQuadsKeepTheirFront) {
  for (const float slope : {0.0f, 0.1f, 0.37f, 1.0f}) {
    const BrickField field = bakeField(tiltedQuad(slope, false).input(), settingsOf(48)).field;
    EXPECT_EQ(validateField(field), "");
    for (int i = 0; i < 500; ++i) {
      const float x = -0.9f + 0.0036f * static_cast<float>(i), z = std::sin(17.0f * x) * 0.9f;
      for (std::size_t level = 0; level < 2; ++level) {
        const glm::vec2 sides = sidesAt(field, level, x, z);
        const float across = field.levels[level].voxelSizeObject * std::sqrt(1 + slope * slope);
        EXPECT_NEAR(sides.x, slope * x, kFrontVoxels * across);
        if (std::abs(x) > 0.5f) continue; // the rim cuts the slab across
        EXPECT_NEAR(sides.y, slope * x - kDepthVoxels * across, 0.4f * across);
      }
    }
  }
}

TEST(BakeSheets, LayersBackToBackDoNotEndEachOther) {
  MeshCase layers; // two single-sided quads, half a voxel apart, that face away from each other
  const float gap = 1.0f / 64;
  layers.addQuad({-1, gap, -1}, {-1, gap, 1}, {1, gap, 1}, {1, gap, -1});
  layers.addQuad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});
  const BakeResult result = bakeField(layers.input(), settingsOf(64));
  EXPECT_EQ(result.stats.sheetTriangles, 4u);
  for (int i = 0; i < 100; ++i) {
    const glm::vec2 sides = sidesAt(result.field, 0, -0.9f + 0.018f * static_cast<float>(i), 0.3f);
    EXPECT_GT(sides.x, gap);
    EXPECT_LT(sides.y, 0);
  }
}

TEST(BakeSheets, RoomOfDoubleSidedWallsIsEmpty) {
  MeshCase room; // ceiling and three walls that face away from it, as a house is modelled
  room.material().doubleSided = true;
  room.addBox({-3, 0, -3}, {3, 2.7f, 3});
  auto& indices = room.primitive().indices;
  indices.erase(indices.begin() + 30, indices.end());        // the face at z = 3
  indices.erase(indices.begin() + 12, indices.begin() + 18); // the floor
  const BrickField field = bakeField(room.input(), settingsOf(128)).field;
  const float voxel = field.levels[0].voxelSizeObject;
  for (const glm::vec3 point : {glm::vec3(0, 1.5f, -1), glm::vec3(0, 2.7f - 2 * voxel, -2.5f), glm::vec3(2, 2, -2)})
    EXPECT_GT(sampleDistance(field, 0, point), 0);
  const auto wall = traceField(field, 0, {0, 1.5f, -1}, {0, 0, -1}, 0, 9);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(*wall, 2, kFrontVoxels * voxel); // the slab lies outside the room
}

TEST(BakeSheets, ThicknessIsTheOneAskedFor) {
  const BrickField field = bakeField(tiltedQuad(0).input(), settingsOf(64, 0.4f)).field;
  const glm::vec2 sides = sidesAt(field, 0, 0.1f, 0.2f);
  EXPECT_NEAR(sides.x, 0.2f, 0.002f);
  EXPECT_NEAR(sides.y, -0.2f, 0.002f);
  EXPECT_NEAR(sampleDistance(field, 0, {0.1f, 0, 0.2f}), -0.125f, 0.08f); // clamped, but inside
}

TEST(BakeSheets, TwoSidedMakesAShellOfASolid) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  BakeSettings settings = settingsOf(64);
  settings.sign = SignMethod::TwoSided;
  const BakeResult result = bakeField(box.input(), settings);
  EXPECT_EQ(result.stats.sign, "two-sided");
  EXPECT_GT(sampleDistance(result.field, 0, {0, 0, 0}), 0);
  EXPECT_LT(sampleDistance(result.field, 0, {0, 1, 0}), 0);
}

TEST(BakeSheets, FloorBesideABoxKeepsBothAndNothingElse) {
  MeshCase scene;
  scene.addBox({-1, 0.5, -1}, {1, 2.5, 1});
  scene.addQuad({-5, 0, -5}, {-5, 0, 5}, {5, 0, 5}, {5, 0, -5});
  const BakeResult result = bakeField(scene.input(), settingsOf(128));
  EXPECT_EQ(result.stats.sheetTriangles, 2u);
  const float voxel = result.field.levels[0].voxelSizeObject;
  EXPECT_NEAR(sidesAt(result.field, 0, 0.3f, 0.2f).x, 2.5f, 0.05f * voxel);
  EXPECT_NEAR(sidesAt(result.field, 0, 3.1f, -4.2f).x, 0.0f, kFrontVoxels * voxel);
  // Below the floor half a turn is near everywhere: it must be open space all the same.
  for (int i = 0; i < 200; ++i) {
    const float x = -4.8f + 0.048f * static_cast<float>(i);
    EXPECT_NEAR(sidesAt(result.field, 0, x, 0.77f * x).y, -kDepthVoxels * voxel, 0.4f * voxel);
  }
  EXPECT_LT(sampleDistance(result.field, 0, {0, 1.5f, 0}), 0);
}
