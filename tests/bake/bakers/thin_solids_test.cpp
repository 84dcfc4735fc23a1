// Closed solids thinner than a voxel in whole bakes: nothing of them is lost, and what is drawn instead is as thick as
// a slab, evenly on both sides.
#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr float kVoxel = 1.0f / 16; // 2 m at 32 voxels
constexpr float kSmoothVoxels = 1.755f, kMostGrowthVoxels = 0.5625f;
// As for slabs: a middle between two samples bends the sides by up to 0.21 voxel, the 8-bit code by 0.016 over a slope
// of 0.36; the thickness that growth starts from is up to a seventh too small, which moves a side by half of that.
constexpr float kKinkVoxels = 0.255f;
float tolerance(float thicknessVoxels) { return kVoxel * (kKinkVoxels + 0.5f * thicknessVoxels / 7); }

BakeSettings settingsOf(int resolution) {
  BakeSettings settings;
  settings.resolution = resolution;
  return settings;
}

/// A plate of 2 m whose lower side lies at slope * x.
MeshCase plate(float slope, float thickness) {
  MeshCase result;
  result.addBox({-1, 0, -1}, {1, thickness, 1});
  for (glm::vec3& p : result.primitive().positions) p.y += slope * p.x;
  return result;
}

/// Height at which a ray down (or up) at (x, z) meets the finest level; nothing where it passes.
std::optional<float> heightAt(const BrickField& field, float x, float z, bool fromAbove) {
  const float start = fromAbove ? 10.0f : -10.0f;
  const auto t = traceField(field, 0, {x, start, z}, {0, fromAbove ? -1 : 1, 0}, 0, 20);
  return t ? std::optional(fromAbove ? 10 - *t : *t - 10) : std::nullopt;
}

} // namespace

TEST(ThinSolids, PlatesHaveNoHolesAndStayInPlace) {
  for (const float voxels : {0.02f, 0.3f, 0.8f})
    for (const float slope : {0.0f, 0.1f, 0.37f}) {
      SCOPED_TRACE(::testing::Message() << voxels << " voxels, slope " << slope);
      const float thickness = voxels * kVoxel;
      const BrickField field = bakeField(plate(slope, thickness).input(), settingsOf(32)).field;
      EXPECT_EQ(validateField(field), "");
      const float across = std::sqrt(1 + slope * slope), tilted = voxels / across;
      const float growth = std::min(kMostGrowthVoxels, 0.5f * (kSmoothVoxels - tilted)) * across * kVoxel;
      for (int i = 0; i < 400; ++i) {
        const float x = -0.85f + 0.00425f * static_cast<float>(i), z = 0.85f * std::sin(17.0f * x);
        const auto above = heightAt(field, x, z, true), below = heightAt(field, x, z, false);
        ASSERT_TRUE(above && below) << "a hole at " << x << ", " << z;
        EXPECT_NEAR(*above, slope * x + thickness + growth, across * tolerance(voxels)) << x;
        EXPECT_NEAR(*below, slope * x - growth, across * tolerance(voxels)) << x;
      }
    }
}

// A ramp that runs out to nothing: its last voxel and a half are thinner than a voxel.
TEST(ThinSolids, WedgeKeepsItsTip) {
  MeshCase wedge;
  const glm::vec3 a(-1, 0, -1), b(1, 0, -1), c(-1, 1.2f, -1), a1(-1, 0, 1), b1(1, 0, 1), c1(-1, 1.2f, 1);
  wedge.addTriangle(a, c, b), wedge.addTriangle(a1, b1, c1);
  wedge.addQuad(a, b, b1, a1), wedge.addQuad(a, a1, c1, c), wedge.addQuad(b, c, c1, b1);
  const BrickField field = bakeField(wedge.input(), settingsOf(32)).field;
  ASSERT_GT(field.thinParts.perTenThousand, 0);
  for (int i = 0; i < 200; ++i) {
    const float z = -0.9f + 0.009f * static_cast<float>(i);
    const auto tip = traceField(field, 0, {10, 0.2f * kVoxel, z}, {-1, 0, 0}, 0, 20);
    ASSERT_TRUE(tip);
    // Half of what is drawn at least, across the tip; rounded by trilinear reading.
    EXPECT_NEAR(10 - *tip, 1.0f, 0.9f * kVoxel) << z;
  }
}

// Of walls between a voxel and sqrt(3) voxels, samples before one side would be nearer to the other.
TEST(ThinSolids, WallsBesideThemDoNotRipple) {
  for (const float slope : {0.1f, 0.37f, 1.0f}) {
    MeshCase scene = plate(0, 0.1f * kVoxel);
    scene.addBox({-1, 0.5f, -1}, {1, 0.5f + 1.3f * kVoxel * std::sqrt(1 + slope * slope), 1});
    for (glm::vec3& p : scene.primitive().positions) p.y += slope * (p.x + 0.3f * p.z);
    const BrickField field = bakeField(scene.input(), settingsOf(32)).field;
    const float voxel = field.levels[0].voxelSizeObject, across = std::sqrt(1 + 1.09f * slope * slope);
    float least = HUGE_VALF, most = -HUGE_VALF;
    for (int i = 0; i < 400; ++i) {
      const float x = -0.7f + 0.0035f * static_cast<float>(i), z = 0.7f * std::sin(17.0f * x);
      const auto top = heightAt(field, x, z, true);
      ASSERT_TRUE(top);
      const float height = (*top - slope * (x + 0.3f * z)) / (across * voxel);
      least = std::min(least, height), most = std::max(most, height);
    }
    // A middle 0.65 voxel deep would bend the side by 0.1 and more. The 8-bit code is 0.016, and thickness, which
    // halvings find for each sample anew, is off by up to a seventh of what it is less than the limit.
    EXPECT_LT(most - least, 0.08f) << slope;
  }
}

TEST(ThinSolids, ThickPartsBesideThemStayWhereTheyAre) {
  MeshCase scene;
  scene.addBox({-1, -1, -1}, {1, -0.2f, 1});
  scene.addBox({-1, 0.5f, -1}, {1, 0.5f + 0.3f * kVoxel, 1});
  const BrickField field = bakeField(scene.input(), settingsOf(32)).field;
  for (int i = 0; i < 100; ++i) {
    const float x = -0.8f + 0.016f * static_cast<float>(i);
    const auto top = traceField(field, 0, {x, 0.3f, 0.37f * x}, {0, -1, 0}, 0, 20);
    ASSERT_TRUE(top);
    EXPECT_NEAR(0.3f - *top, -0.2f, 0.02f * kVoxel) << x;
  }
}

TEST(ThinSolids, EmptyCellsStayClearOfWhatIsDrawn) {
  const MeshCase mesh = plate(0.37f, 0.3f * kVoxel);
  BakeSettings settings = settingsOf(64);
  const BrickField field = bakeField(mesh.input(), settings).field;
  const TriangleSoup soup = mesh.soup();
  const BrickLevel& level = field.levels[0];
  std::size_t empty = 0;
  for (const glm::dvec3 point : randomPoints(20000, 1, 7)) {
    const glm::dvec3 object = point / soup.unitsPerMetre + soup.centerObject;
    const glm::ivec3 brick((glm::vec3(object) - field.originObject) / (level.voxelSizeObject * kBrickCells));
    if (glm::any(glm::lessThan(brick, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(brick, level.brickCounts)))
      continue;
    const IndirectionCell cell{level.indirection[level.cellIndex(brick)]};
    if (!cell.isEmpty()) continue;
    ++empty;
    const double voxels = bruteDistance(soup, point) / soup.unitsPerMetre / level.voxelSizeObject;
    ASSERT_GE(voxels - static_cast<double>(kMostGrowthVoxels), cell.boundVoxels());
  }
  EXPECT_GT(empty, 1000u);
}

TEST(ThinSolids, OtherSignMethodsKeepTheExactDistance) {
  BakeSettings settings = settingsOf(32);
  settings.sign = SignMethod::Winding;
  const BrickField field = bakeField(plate(0, 0.3f * kVoxel).input(), settings).field;
  EXPECT_GT(field.thinParts.resolution, 0);
  EXPECT_NEAR(sampleDistance(field, 0, {0.1f, 0.3f * kVoxel + 2 * kVoxel, 0.2f}), 2 * kVoxel, 0.05f * kVoxel);
}

TEST(ThinSolids, BallStaysWhereItIs) {
  MeshCase ball;
  ball.addSphere({0, 0, 0}, 1, 24, 48);
  const BrickField alone = bakeField(ball.input(), settingsOf(32)).field;
  for (const float x : {-0.5f, 0.0f, 0.31f}) {
    const auto top = heightAt(alone, x, 0.0f, true);
    ASSERT_TRUE(top);
    EXPECT_NEAR(*top, std::sqrt(1 - x * x), 0.15f * kVoxel) << x; // the mesh's own chords are 0.07 voxel deep
  }
}
