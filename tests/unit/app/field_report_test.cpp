// Counts and cuts of a field built by hand: one brick beside one empty cell.
#include "app/field_report.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {
namespace {

/// Two cells along x. The first is a brick whose distance is x - 3 voxels; the second lies wholly outside.
BrickField planeField() {
  BrickField field;
  field.boundsObject = {{0, 0, 0}, {1.4f, 0.7f, 0.7f}};
  BrickLevel level;
  level.voxelSizeObject = 0.1f;
  level.brickCounts = {2, 1, 1};
  level.rangeVoxels = 4;
  level.indirection = {IndirectionCell::brick(0).bits, IndirectionCell::empty(false, 4.0f).bits};
  for (int i = 0; i < kBrickSampleCount; ++i)
    level.distances.push_back(static_cast<std::byte>(
        encodeDistance(static_cast<float>(i % kBrickSamples) - 3.0f, level.rangeVoxels, DistanceFormat::R8Snorm)));
  field.levels.push_back(level);
  return field;
}

TEST(ReportLevels, CountsCellsAndBytes) {
  const std::vector<LevelReport> reports = reportLevels(planeField());
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].cells, 2u);
  EXPECT_EQ(reports[0].bricks, 1u);
  EXPECT_EQ(reports[0].emptyOutside, 1u);
  EXPECT_EQ(reports[0].emptyInside, 0u);
  EXPECT_DOUBLE_EQ(reports[0].emptyShare(), 0.5);
  EXPECT_EQ(reports[0].bytes, 512u + 2 * 4);
  EXPECT_EQ(reports[0].bits, 8);
  EXPECT_FALSE(reports[0].hasAttributes);
}

TEST(SliceField, ShowsInsideSurfaceAndOutsideWhereTheyAre) {
  const RgbImage image = sliceField(planeField(), {2, 0.35f}); // across z: right is x, up is y
  ASSERT_EQ(image.size, glm::uvec2(512, 256));
  const auto at = [&](float metres) { return image.at(static_cast<std::uint32_t>(metres / 1.4f * 512), 128); };
  EXPECT_GT(at(0.15f).z, at(0.15f).x); // inside is blue
  EXPECT_EQ(at(0.301f), glm::vec3(0)); // the surface at three voxels is black
  EXPECT_GT(at(0.45f).x, at(0.45f).z); // outside is orange
}

TEST(SliceField, HasTheLaterAxisUpwards) {
  const RgbImage image = sliceField(planeField(), {1, 0.35f}); // across y: right is z, up is x
  ASSERT_EQ(image.size, glm::uvec2(256, 512));
  const glm::vec3 bottom = image.at(128, 511 - 55), top = image.at(128, 511 - 165);
  EXPECT_GT(bottom.z, bottom.x); // x = 0.15: inside
  EXPECT_GT(top.x, top.z);       // x = 0.45: outside
}

TEST(SliceField, RefusesAPlaneBesideTheField) {
  EXPECT_THROW(sliceField(planeField(), {0, 1.5f}), BadInput);
  EXPECT_THROW(sliceField(planeField(), {1, -0.1f}), BadInput);
}

TEST(ParseSlice, ReadsAxisAndPosition) {
  const SlicePlane plane = parseSlice("--slice", "y:-0.5");
  EXPECT_EQ(plane.axis, 1);
  EXPECT_EQ(plane.positionObject, -0.5f);
  for (const char* text : {"", "x", "q:1", "x:", "x:nan", "xy:1", "x:1:2", ":1"})
    EXPECT_THROW(parseSlice("--slice", text), BadInput) << text;
}

} // namespace
} // namespace brickfield
