// Whole bakes of open solids: holes are closed by a smooth membrane instead of a jump of the sign.
#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "field/brick_layout.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

/// The lower half of a unit sphere, faces outwards, open above. Half a turn is seen from the disk that spans its rim,
/// so the membrane is that disk at y = 0.
BrickField bowl(int resolution, SignMethod sign = SignMethod::Auto) {
  MeshCase mesh;
  mesh.addSphere({0, 0, 0}, 1, 64, 128, 32);
  BakeSettings settings;
  settings.resolution = resolution;
  settings.sign = sign;
  return bakeField(mesh.input(), settings).field;
}

} // namespace

TEST(BakeOpen, BowlIsClosedByTheDiskThatSpansItsRim) {
  for (const SignMethod sign : {SignMethod::Auto, SignMethod::Winding}) {
    const BrickField field = bowl(128, sign);
    EXPECT_EQ(validateField(field), "");
    const float voxel = field.levels[0].voxelSizeObject;
    float worst = 0;
    for (int i = 0; i < 400; ++i) { // a spiral over the disk, up to four voxels from the rim
      const float radius = 0.93f * std::sqrt(static_cast<float>(i) / 400), angle = 2.4f * static_cast<float>(i);
      const glm::vec3 above(radius * std::cos(angle), 3, radius * std::sin(angle));
      const auto hit = traceField(field, 0, above, {0, -1, 0}, 0, 6);
      ASSERT_TRUE(hit);
      worst = std::max(worst, std::abs(3 - *hit));
      const glm::vec3 normal = fieldNormal(field, 0, {above.x, 3 - *hit, above.z});
      EXPECT_GT(normal.y, 0.8f) << radius;
    }
    // The winding number is right within 0.01; its slope across the disk is at least 1/(2 rim radius) a metre.
    EXPECT_LT(worst, 0.02f + voxel);
    EXPECT_LT(sampleDistance(field, 0, {0.1f, -0.3f, 0}), 0);
    EXPECT_GT(sampleDistance(field, 0, {0.1f, 0.05f, 0}), 0);
  }
}

TEST(BakeOpen, NeighbouringSamplesNeverJump) {
  const BrickField field = bowl(96);
  const BrickLevel& level = field.levels[0];
  float largest = 0;
  for (std::uint32_t brick = 0; brick < level.brickCount(); ++brick)
    for (int i = 0; i < kBrickSampleCount; ++i) {
      const glm::ivec3 sample(i % 8, i / 8 % 8, i / 64);
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 next = sample;
        if (++next[axis] == kBrickSamples) continue;
        largest =
            std::max(largest, std::abs(storedDistance(level, brick, sample) - storedDistance(level, brick, next)));
      }
    }
  // A distance changes by at most a voxel a voxel. The membrane's is an estimate, off where its slope changes near the
  // rim.
  EXPECT_LT(largest, 1.6f);
}

TEST(BakeOpen, EmptyCellsLeadOverNoMembrane) {
  const BrickField field = bowl(128);
  const BrickLevel& level = field.levels[0];
  for (std::size_t cell = 0; cell < level.indirection.size(); ++cell) {
    const IndirectionCell content{level.indirection[cell]};
    if (!content.isEmpty()) continue;
    const auto x = static_cast<std::size_t>(level.brickCounts.x), y = static_cast<std::size_t>(level.brickCounts.y);
    const glm::vec3 low = field.originObject + level.voxelSizeObject * static_cast<float>(kBrickCells) *
                                                   glm::vec3(cell % x, cell / x % y, cell / (x * y));
    const glm::vec3 high = low + level.voxelSizeObject * static_cast<float>(kBrickCells);
    const glm::vec3 nearestToAxis = glm::clamp(glm::vec3(0), low, high);
    if (glm::length(glm::vec2(nearestToAxis.x, nearestToAxis.z)) > 0.9f) continue; // not above or below the disk
    EXPECT_TRUE(low.y > 0 || high.y < 0);
    const bool isInBowl = high.y < 0 && glm::length(0.5f * (low + high)) < 1;
    EXPECT_EQ(content.isInside(), isInBowl);
    const float toDisk = std::max(low.y, -high.y) / level.voxelSizeObject;
    EXPECT_LE(content.boundVoxels(), toDisk + 2.5f); // the disk is found to within the winding number's error
  }
}

TEST(BakeOpen, BricksAgreeInTheSamplesThatTheyShare) {
  for (const char* name : {"utah_teapot_1k.glb", "suzanne.glb", "stanford_bunny_69k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    BakeSettings settings;
    settings.resolution = 48;
    settings.attributes = false;
    const BrickField field = bakeField(FileCase(name).input(), settings).field;
    const BrickLevel& level = field.levels[0];
    std::size_t shared = 0, differ = 0;
    glm::ivec3 brick;
    for (brick.z = 0; brick.z < level.brickCounts.z; ++brick.z)
      for (brick.y = 0; brick.y < level.brickCounts.y; ++brick.y)
        for (brick.x = 0; brick.x + 1 < level.brickCounts.x; ++brick.x) {
          const IndirectionCell here{level.indirection[level.cellIndex(brick)]};
          const IndirectionCell there{level.indirection[level.cellIndex(brick + glm::ivec3(1, 0, 0))]};
          for (int i = 0; i < 64; ++i) {
            if (here.isEmpty() || there.isEmpty()) continue;
            const float left = storedDistance(level, here.brickIndex(), {7, i % 8, i / 8});
            const float right = storedDistance(level, there.brickIndex(), {0, i % 8, i / 8});
            ++shared;
            differ += (left < 0) != (right < 0) || std::abs(left - right) > 0.07f; // two codes
          }
        }
    EXPECT_GT(shared, 1000u);
    EXPECT_EQ(differ, 0u) << name;
  }
}
