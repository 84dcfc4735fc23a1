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

MeshCase tiltedQuad(float slope) {
  MeshCase quad;
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
  EXPECT_NEAR(sidesAt(result.field, 0, 3.1f, -4.2f).x, 0.5625f * voxel, kKinkVoxels * voxel);
  // Below the floor half a turn is near everywhere: it must be open space all the same.
  for (int i = 0; i < 200; ++i) {
    const float x = -4.8f + 0.048f * static_cast<float>(i);
    EXPECT_NEAR(sidesAt(result.field, 0, x, 0.77f * x).y, -0.5625f * voxel, kKinkVoxels * voxel);
  }
  EXPECT_LT(sampleDistance(result.field, 0, {0, 1.5f, 0}), 0);
}
