// Counts of a field built by hand: one brick beside one empty cell.
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

TEST(ParseSlice, ReadsAxisAndPosition) {
  const SlicePlane plane = parseSlice("--slice", "y:-0.5");
  EXPECT_EQ(plane.axis, 1);
  EXPECT_EQ(plane.positionObject, -0.5f);
  for (const char* text : {"", "x", "q:1", "x:", "x:nan", "xy:1", "x:1:2", ":1"})
    EXPECT_THROW(parseSlice("--slice", text), BadInput) << text;
}

} // namespace
} // namespace brickfield
