// The grid over a surface and the encoding of bricks.
#include "field/brick_layout.h"

#include <array>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

TEST(LayoutGrid, CubeOf128) {
  const GridLayout layout = layoutGrid({glm::vec3(0), glm::vec3(1.28f)}, 128, 3);
  ASSERT_EQ(layout.levels.size(), 3u);
  EXPECT_EQ(layout.originObject, layout.boundsObject.min);
  EXPECT_FLOAT_EQ(layout.originObject.x, -0.01f);
  EXPECT_FLOAT_EQ(layout.boundsObject.max.z, 1.29f);
  EXPECT_EQ(layout.levels[0].brickCounts, glm::ivec3(19)); // 130 cells
  EXPECT_EQ(layout.levels[1].brickCounts, glm::ivec3(10)); // 65
  EXPECT_EQ(layout.levels[2].brickCounts, glm::ivec3(5));  // 33
}

TEST(LayoutGrid, CoversAnyBoxByItsVoxels) {
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    Box box;
    const float size = std::exp2(random.between(-10, 10));
    const glm::vec3 center = 50 * size * glm::vec3(random.unit(), random.unit(), random.unit());
    box.extend(center);
    box.extend(center + size * glm::vec3(random.unit(), i % 5 == 0 ? 0.0f : random.unit(), 1.0f));
    const int resolution = 8 + static_cast<int>(random.bits() % 500), mips = 1 + static_cast<int>(random.bits() % 4);
    const GridLayout layout = layoutGrid(box, resolution, mips);
    ASSERT_GE(layout.levels.size(), 1u);
    ASSERT_LE(layout.levels.size(), static_cast<std::size_t>(mips));
    const float h = layout.levels[0].voxelSizeObject;
    for (std::size_t l = 0; l < layout.levels.size(); ++l) {
      const LevelLayout& level = layout.levels[l];
      ASSERT_EQ(level.voxelSizeObject, std::ldexp(h, static_cast<int>(l)));
      for (int axis = 0; axis < 3; ++axis) {
        const double cells =
            (double(box.max[axis]) - box.min[axis]) / level.voxelSizeObject + 2.0 * h / level.voxelSizeObject;
        ASSERT_GE(7 * level.brickCounts[axis], cells - 2e-2) << resolution << " " << l; // covers
        ASSERT_LT(7 * (level.brickCounts[axis] - 1), cells + 2e-2);                     // and wastes no brick
      }
    }
    const glm::ivec3 coarsest = layout.levels.back().brickCounts;
    // A level that was left out would have had less than seven cells.
    if (layout.levels.size() < static_cast<std::size_t>(mips)) {
      ASSERT_LE(std::max({coarsest.x, coarsest.y, coarsest.z}), 2);
    }
  }
}

TEST(LayoutGrid, LeavesOutLevelsOfLessThanABrick) {
  const Box box{glm::vec3(0), glm::vec3(8)};
  EXPECT_EQ(layoutGrid(box, 8, 4).levels.size(), 1u);  // 10 cells, then 5
  EXPECT_EQ(layoutGrid(box, 12, 4).levels.size(), 2u); // 14, 7, then 4
  EXPECT_EQ(layoutGrid(box, 1024, 8).levels.size(), 8u);
}

TEST(LayoutGrid, RefusesWhatCannotBeLaidOut) {
  const Box unit{glm::vec3(0), glm::vec3(1)};
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  EXPECT_THROW(layoutGrid(unit, 7, 1), BadInput);
  EXPECT_THROW(layoutGrid(unit, 1025, 1), BadInput);
  EXPECT_THROW(layoutGrid(unit, 64, 0), BadInput);
  EXPECT_THROW(layoutGrid(unit, 64, 9), BadInput);
  EXPECT_THROW(layoutGrid({}, 64, 1), BadInput);
  EXPECT_THROW(layoutGrid({glm::vec3(1), glm::vec3(1)}, 64, 1), BadInput) << "a point";
  EXPECT_THROW(layoutGrid({glm::vec3(0), glm::vec3(infinity)}, 64, 1), BadInput);
  EXPECT_THROW(layoutGrid({glm::vec3(nan), glm::vec3(1)}, 64, 1), BadInput);
  EXPECT_THROW(layoutGrid({glm::vec3(-3e38f), glm::vec3(3e38f)}, 64, 1), BadInput) << "the extent overflows";
  EXPECT_THROW(layoutGrid({glm::vec3(1e6f), glm::vec3(1e6f + 1)}, 128, 1), BadInput)
      << "voxels of 8 mm in floats of 6 cm";
  EXPECT_NO_THROW(layoutGrid({glm::vec3(100), glm::vec3(101)}, 128, 1));
}

TEST(DistanceFormatOfBits, KnowsTwo) {
  EXPECT_EQ(distanceFormatOfBits(8), DistanceFormat::R8Snorm);
  EXPECT_EQ(distanceFormatOfBits(16), DistanceFormat::R16Snorm);
  EXPECT_THROW(distanceFormatOfBits(12), BadInput);
}

TEST(BrickBound, IsConservativeAndStoresWhatIsNear) {
  EXPECT_TRUE(isBrickStored(brickBoundVoxels(0)));
  EXPECT_TRUE(isBrickStored(brickBoundVoxels(7.06f)));
  EXPECT_FALSE(isBrickStored(brickBoundVoxels(7.08f)));
  EXPECT_FALSE(isBrickStored(brickBoundVoxels(-7.08f)));
  EXPECT_LE(brickBoundVoxels(20), 20 - 3.5f * std::sqrt(3.0f));
  EXPECT_GT(brickBoundVoxels(20), 20 - 3.5f * std::sqrt(3.0f) - 0.02f);
}

TEST(RangeVoxelsWithoutClamp, IsWholeAndAtLeastFour) {
  EXPECT_EQ(rangeVoxelsWithoutClamp(0), 4);
  EXPECT_EQ(rangeVoxelsWithoutClamp(4.01f), 5);
  EXPECT_EQ(rangeVoxelsWithoutClamp(117), 117);
}

TEST(AppendBrick, StoresWhatStoredDistanceReads) {
  for (const auto format : {DistanceFormat::R8Snorm, DistanceFormat::R16Snorm}) {
    BrickLevel level = makeLevel({0.5f, {2, 3, 4}}, format);
    EXPECT_EQ(level.indirection.size(), 24u);
    std::array<float, kBrickSampleCount> distances;
    for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = (static_cast<float>(i) - 200.0f) / 256.0f;
    appendBrick(level, {0, 0, 0}, distances);
    for (float& d : distances) d = -d;
    appendBrick(level, {1, 2, 3}, distances);
    EXPECT_EQ(level.brickCount(), 2u);
    EXPECT_EQ(IndirectionCell{level.indirection[1 + 2 * (2 + 3 * 3)]}.brickIndex(), 1u);
    EXPECT_TRUE(IndirectionCell{level.indirection[1]}.isEmpty());
    const float code = codeVoxels(level);
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          const float voxels = (static_cast<float>(x + 8 * y + 64 * z) - 200.0f) / 128.0f; // voxels of half a metre
          ASSERT_NEAR(storedDistance(level, 0, {x, y, z}), voxels, code);
          ASSERT_NEAR(storedDistance(level, 1, {x, y, z}), -voxels, code);
        }
  }
}

TEST(AppendBrick, StoresTheCodeOfEachDistance) {
  constexpr float kVoxelSize = 0.3f;
  for (const auto format : {DistanceFormat::R8Snorm, DistanceFormat::R16Snorm})
    for (const float scale : {1e-6f, 0.01f, 1.0f, 4.2f}) {
      BrickLevel level = makeLevel({kVoxelSize, {1, 1, 1}}, format);
      std::array<float, kBrickSampleCount> distances;
      Random random(7);
      for (float& distance : distances) distance = scale * kVoxelSize * random.between(-1, 1);
      distances[0] = std::nanf(""), distances[1] = HUGE_VALF, distances[2] = -HUGE_VALF, distances[3] = -0.0f;
      distances[4] = 0.5f / 127 * 4 * kVoxelSize, distances[5] = -distances[4];
      appendBrick(level, {0, 0, 0}, distances);
      for (std::size_t i = 0; i < distances.size(); ++i) {
        const std::int32_t code = encodeDistance(distances[i] / kVoxelSize, level.rangeVoxels, format);
        const std::size_t bytes = bytesPerSample(format);
        for (std::size_t b = 0; b < bytes; ++b)
          ASSERT_EQ(static_cast<int>(level.distances[bytes * i + b]), (code >> (8 * b)) & 0xff) << i;
      }
    }
}

} // namespace
} // namespace brickfield
