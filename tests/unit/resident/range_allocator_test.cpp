// Ranges handed out and given back, by hand and against a plain array of flags.
#include "resident/range_allocator.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield::test {
namespace {

TEST(RangeAllocator, HandsOutConsecutiveNumbersFirst) {
  RangeAllocator ranges;
  EXPECT_EQ(ranges.allocate(3), 0u);
  EXPECT_EQ(ranges.allocate(4), 3u);
  EXPECT_EQ(ranges.allocate(1), 7u);
  EXPECT_EQ(ranges.end(), 8u);
  EXPECT_EQ(ranges.used(), 8u);
}

TEST(RangeAllocator, CountOfZeroTakesAndGivesNothing) {
  RangeAllocator ranges;
  ranges.allocate(2);
  EXPECT_EQ(ranges.allocate(0), 0u);
  ranges.release(77, 0);
  EXPECT_EQ(ranges.end(), 2u);
  EXPECT_EQ(ranges.used(), 2u);
}

TEST(RangeAllocator, FirstGapThatFitsIsTaken) {
  RangeAllocator ranges;
  for (const std::uint32_t count : {2u, 1u, 5u, 1u, 4u, 1u}) ranges.allocate(count); // at 0, 2, 3, 8, 9, 13
  ranges.release(0, 2);
  ranges.release(3, 5);
  ranges.release(9, 4);
  EXPECT_EQ(ranges.allocate(4), 3u); // not the exact fit at 9
  EXPECT_EQ(ranges.allocate(4), 9u);
  EXPECT_EQ(ranges.allocate(1), 0u);
  EXPECT_EQ(ranges.allocate(1), 1u);
  EXPECT_EQ(ranges.allocate(1), 7u); // what the four left of five
  EXPECT_EQ(ranges.allocate(1), 14u);
}

TEST(RangeAllocator, NeighboursGivenBackGrowTogether) {
  // The middle last, the middle first: joined from both sides, or from one and then the other.
  for (const std::vector<std::uint32_t>& order :
       {std::vector<std::uint32_t>{0, 2, 1}, {1, 0, 2}, {2, 1, 0}, {0, 1, 2}}) {
    RangeAllocator ranges;
    for (int i = 0; i < 4; ++i) ranges.allocate(2);
    for (const std::uint32_t block : order) ranges.release(2 * block, 2);
    EXPECT_EQ(ranges.end(), 8u);
    EXPECT_EQ(ranges.used(), 2u);
    EXPECT_EQ(ranges.allocate(6), 0u);
  }
}

TEST(RangeAllocator, EndShrinksOverAllThatIsFreeThere) {
  RangeAllocator ranges;
  for (int i = 0; i < 3; ++i) ranges.allocate(10);
  ranges.release(10, 10);
  EXPECT_EQ(ranges.end(), 30u);
  ranges.release(20, 10);
  EXPECT_EQ(ranges.end(), 10u);
  EXPECT_EQ(ranges.allocate(25), 10u);
}

TEST(RangeAllocator, RangeGivenBackTwiceIsRefusedAndChangesNothing) {
  RangeAllocator ranges;
  for (int i = 0; i < 4; ++i) ranges.allocate(4);
  ranges.release(4, 4);
  EXPECT_THROW(ranges.release(4, 4), Failure);
  EXPECT_THROW(ranges.release(6, 2), Failure) << "inside a gap";
  EXPECT_THROW(ranges.release(2, 4), Failure) << "reaches into a gap";
  EXPECT_THROW(ranges.release(0, 12), Failure) << "around a gap";
  ranges.release(0, 4);
  EXPECT_THROW(ranges.release(4, 4), Failure) << "its gap has grown together with the one below";
  ranges.release(12, 4);
  EXPECT_THROW(ranges.release(12, 4), Failure) << "beyond the end since it shrank";
  EXPECT_THROW(ranges.release(8, 5), Failure) << "reaches beyond the end";
  EXPECT_EQ(ranges.used(), 4u);
  EXPECT_EQ(ranges.end(), 12u);
}

TEST(RangeAllocator, MoreThan32BitsAreRefusedAndNotCounted) {
  RangeAllocator ranges;
  ranges.allocate(0xfffffff0u);
  EXPECT_THROW(ranges.allocate(0x10u), Failure);
  EXPECT_EQ(ranges.used(), 0xfffffff0u);
  EXPECT_EQ(ranges.allocate(0xfu), 0xfffffff0u);
}

TEST(RangeAllocator, RandomUseMatchesAnArrayOfFlags) {
  std::mt19937 random(5);
  RangeAllocator ranges;
  std::vector<bool> taken(4096, false);
  struct Range {
    std::uint32_t first, count;
  };
  std::vector<Range> held;
  const auto firstFit = [&](std::uint32_t count) {
    std::uint32_t run = 0;
    for (std::uint32_t i = 0;; ++i) {
      run = taken[i] ? 0 : run + 1;
      if (run == count) return i + 1 - count;
    }
  };
  for (int step = 0; step < 3000; ++step) {
    if (held.size() < 20 || random() % 2) {
      const std::uint32_t count = 1 + random() % 40;
      if (held.size() > 60) continue;
      const std::uint32_t expected = firstFit(count);
      ASSERT_EQ(ranges.allocate(count), expected) << "step " << step;
      for (std::uint32_t i = 0; i < count; ++i) taken[expected + i] = true;
      held.push_back({expected, count});
    } else {
      const std::size_t pick = random() % held.size();
      ranges.release(held[pick].first, held[pick].count);
      for (std::uint32_t i = 0; i < held[pick].count; ++i) taken[held[pick].first + i] = false;
      held.erase(held.begin() + static_cast<std::ptrdiff_t>(pick));
    }
    std::uint32_t used = 0, end = 0;
    for (std::uint32_t i = 0; i < taken.size(); ++i)
      if (taken[i]) ++used, end = i + 1;
    ASSERT_EQ(ranges.used(), used) << "step " << step;
    ASSERT_EQ(ranges.end(), end) << "step " << step;
  }
}

} // namespace
} // namespace brickfield::test
