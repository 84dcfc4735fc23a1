// Counting sort on all threads: blocks of items count their values, then each puts its items where those of lower
// values and of blocks before it leave room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

namespace brickfield {

/// Calls put(item, place) once for items 0 to count - 1, from several threads, with places from 0 on by their values;
/// items of one value stay in their order.
///
/// count     less than 2^32
/// valueOf   of an item, less than valueCount; is asked twice
/// returns   a value: its first place; and count at the end
/// proved by tests/bake/bakers/stable_deal_test.cpp
template <typename ValueOf, typename Put>
std::vector<std::uint32_t> dealStably(std::size_t count, std::size_t valueCount, const ValueOf& valueOf,
                                      const Put& put) {
  constexpr std::size_t kItemsAtATime = 1u << 14;
  const std::size_t blocks = (count + kItemsAtATime - 1) / kItemsAtATime;
  std::vector<std::vector<std::uint32_t>> places(blocks); // of a block, by value
  const auto forEachOf = [&](std::size_t block, const auto& visit) {
    const std::size_t end = std::min(count, (block + 1) * kItemsAtATime);
    for (std::size_t item = block * kItemsAtATime; item < end; ++item) visit(item, places[block][valueOf(item)]);
  };
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    places[block].assign(valueCount, 0);
    forEachOf(block, [](std::size_t, std::uint32_t& ofValue) { ++ofValue; });
  });
  std::vector<std::uint32_t> firstPlaces(valueCount + 1);
  std::uint32_t next = 0;
  for (std::size_t value = 0; value < valueCount; ++value) {
    firstPlaces[value] = next;
    for (std::vector<std::uint32_t>& ofBlock : places) next += std::exchange(ofBlock[value], next);
  }
  firstPlaces[valueCount] = next;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    forEachOf(block, [&](std::size_t item, std::uint32_t& place) { put(item, place++); });
  });
  return firstPlaces;
}

} // namespace brickfield
