// Sets united by many threads at once are those of one thread.
#include "bakers/disjoint_sets.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

namespace brickfield {
namespace {

TEST(SharedSets, AreThoseOfOneThread) {
  constexpr std::uint32_t kCount = 200000;
  std::mt19937 random(1);
  // Long chains, which many threads walk at once, and pairs that join them here and there; some members stay alone.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::uint32_t i = 0; i + 1 < kCount; ++i)
    if (random() % 50 != 0) pairs.emplace_back(i + 1, i);
  for (int i = 0; i < 1000; ++i) pairs.emplace_back(random() % kCount, random() % kCount);
  std::shuffle(pairs.begin(), pairs.end(), random);
  DisjointSets expected(kCount);
  for (const auto& [a, b] : pairs) expected.unite(a, b);
  for (int round = 0; round < 10; ++round) {
    SharedSets sets(kCount);
    tbb::parallel_for(std::size_t{0}, pairs.size(),
                      [&](std::size_t i) { sets.unite(pairs[i].first, pairs[i].second); });
    std::size_t roots = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(sets.rootOf(i), expected.rootOf(i)) << i;
      roots += sets.rootOf(i) == i;
    }
    EXPECT_GT(roots, 1000u);
  }
}

} // namespace
} // namespace brickfield
