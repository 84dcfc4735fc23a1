// The floor of an update, and what it says of a device.
#include "app/bench_floor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace brickfield {
namespace {

using ::testing::HasSubstr;

FieldTimes timesOf(std::uint32_t keyTiles, std::uint32_t valueTiles, std::uint32_t triangles, std::uint32_t objects) {
  FieldTimes times;
  times.tiles = {keyTiles, valueTiles, valueTiles};
  times.drawn = triangles;
  times.sdfObjects = objects;
  times.milliseconds = 1;
  return times;
}

TEST(FieldFloorTest, CountsEachDatumOnce) {
  const FieldFloor meshes = floorOf(timesOf(2, 3, 10, 0));
  EXPECT_EQ(meshes.bytes, 10 * 64 + 2 * 512 * 4 + 3 * 512 * (2 + 4));
  EXPECT_EQ(meshes.operations, 3 * 512 * 173.0);
  const FieldFloor objects = floorOf(timesOf(0, 3, 0, 7));
  EXPECT_EQ(objects.bytes, 7 * 144 + 3 * 512 * (2 + 4));
  EXPECT_EQ(objects.operations, 3 * 512 * 40.0);
  const FieldFloor nothing = floorOf(timesOf(0, 0, 0, 0));
  EXPECT_EQ(nothing.bytes + nothing.operations, 0);
}

TEST(FieldFloorTest, RatesAreTheDevicesUnlessTheUserSays) {
  FieldBenchRequest request;
  EXPECT_EQ(*ratesOf(request, "NVIDIA H200/PCIe/SSE2").bytes, 4.8e12);
  EXPECT_EQ(*ratesOf(request, "NVIDIA H200/PCIe/SSE2").operations, 67e12);
  EXPECT_FALSE(ratesOf(request, "llvmpipe").bytes);
  request.bandwidthGigabytes = 20;
  EXPECT_EQ(*ratesOf(request, "llvmpipe").bytes, 20e9);
  EXPECT_EQ(*ratesOf(request, "NVIDIA H200").bytes, 20e9);
  EXPECT_FALSE(floorMilliseconds({1, 1}, ratesOf(request, "llvmpipe")));
}

TEST(FieldFloorTest, TimeIsThatOfTheSlower) {
  EXPECT_DOUBLE_EQ(*floorMilliseconds({1e9, 1e9}, {1e12, 1e13}), 1.0);
  EXPECT_DOUBLE_EQ(*floorMilliseconds({1e9, 1e9}, {1e13, 1e12}), 1.0);
}

TEST(FieldFloorTest, TextSaysHowFarAboveOrThatItIsNotKnown) {
  const FieldTimes times = timesOf(0, 1000, 0, 10); // 3.07 MB, 0.0205 G operations
  EXPECT_THAT(floorText(times, {}), HasSubstr("not known"));
  EXPECT_THAT(floorText(times, {3.07344e9, 67e12}), HasSubstr("takes 1.0 times that"));
  EXPECT_TRUE(floorJson(times, {}).at("ms").is_null());
  EXPECT_NEAR(floorJson(times, {3.07344e9, 67e12}).at("times_over").get<double>(), 1, 1e-9);
}

} // namespace
} // namespace brickfield
