// Items are visited once each, however they are grouped.
#include "bakers/each_uneven.h"

#include <atomic>
#include <vector>

#include <gtest/gtest.h>

using namespace brickfield;

TEST(EachUneven, VisitsEachItemOnce) {
  for (const std::size_t count : {0u, 1u, 7u, 1000u})
    for (const std::size_t group : {1u, 3u, 64u}) {
      std::vector<std::atomic<int>> visits(count);
      forEachUneven(count, group, [&](std::size_t i) { ++visits[i]; });
      for (const std::atomic<int>& visit : visits) EXPECT_EQ(visit, 1) << count << " by " << group;
    }
}
