// Hands out contiguous ranges of numbers: slots of a pool, rows of a table. First fit; neighbours that are given back
// grow together.
#pragma once

#include <cstdint>
#include <map>

namespace brickfield {

class RangeAllocator {
public:
  /// First number of `count` free ones; extends `end()` where no gap fits. count 0 gives 0 and takes nothing.
  /// error Failure, and nothing is taken: numbers beyond 32 bits
  std::uint32_t allocate(std::uint32_t count);
  /// Gives back what allocate handed out with the same count.
  /// error     Failure, and nothing changes: any of it is free already
  /// proved by tests/unit/resident/range_allocator_test.cpp
  void release(std::uint32_t first, std::uint32_t count);
  /// One past the largest number ever handed out and not given back at the end.
  std::uint32_t end() const { return end_; }
  std::uint32_t used() const { return used_; }

private:
  std::map<std::uint32_t, std::uint32_t> gaps_; // first -> count
  std::uint32_t end_ = 0;
  std::uint32_t used_ = 0;
};

} // namespace brickfield
