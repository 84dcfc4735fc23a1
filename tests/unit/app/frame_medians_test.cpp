// Medians over frames whose passes differ.
#include "app/frame_medians.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {
namespace {

TEST(FrameMediansTest, TakesTheMiddleOfEachPassAndOfSums) {
  FrameMedians medians;
  medians.add({{"a", 1, 0}, {"b", 9, 0}, {"part of b", 100, 1}});
  medians.add({{"a", 2, 0}, {"b", 5, 0}});
  medians.add({{"a", 30, 0}, {"b", 1, 0}, {"late", 4, 0}});
  const std::vector<PassTime> passes = medians.passes();
  ASSERT_EQ(passes.size(), 3u);
  EXPECT_EQ(passes[0].name, "a");
  EXPECT_EQ(passes[0].milliseconds, 2);
  EXPECT_EQ(passes[1].milliseconds, 5);
  EXPECT_EQ(passes[2].name, "late");
  EXPECT_EQ(medians.sumMilliseconds(), 10); // of 10, 7 and 35
  EXPECT_THROW(medians.add({}), Failure);
  EXPECT_EQ(medianOf({}), 0);
}

TEST(FrameMediansTest, WarmUpDrawsTwoFramesAndATenthOfASecond) {
  const Stopwatch stopwatch;
  int drawn = 0;
  EXPECT_EQ(warmUp([&](int frame) { EXPECT_EQ(frame, drawn++); }), drawn);
  EXPECT_TRUE(drawn == 1000 || stopwatch.milliseconds() >= 100) << drawn;
  EXPECT_GE(drawn, 2);
}

} // namespace
} // namespace brickfield
