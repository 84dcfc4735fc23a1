// Against std::stable_sort.
#include <numeric>

#include <gtest/gtest.h>

#include "bakers/stable_deal.h"

namespace brickfield::test {

TEST(StableDeal, IsAStableSort) {
  for (const std::size_t count : {0, 1, 1000, 100000}) { // of none, one and several blocks
    constexpr std::size_t kValues = 37;
    const auto valueOf = [](std::size_t item) { return item * 2654435761u % 1009 % kValues; };
    std::vector<std::size_t> expected(count), dealt(count);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::size_t a, std::size_t b) { return valueOf(a) < valueOf(b); });
    const std::vector<std::uint32_t> first =
        dealStably(count, kValues, valueOf, [&](std::size_t item, std::uint32_t place) { dealt[place] = item; });
    EXPECT_EQ(dealt, expected);
    ASSERT_EQ(first.size(), kValues + 1);
    EXPECT_EQ(first.back(), count);
    for (std::size_t value = 0; value < kValues; ++value)
      for (std::size_t place = first[value]; place < first[value + 1]; ++place) ASSERT_EQ(valueOf(dealt[place]), value);
  }
}

} // namespace brickfield::test
