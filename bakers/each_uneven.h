// Loops over items of very different cost: threads take small groups of them one after another, so that none waits long
// for the last. TBB's own choice of groups halves what is left, which leaves dear items side by side to one thread.
#pragma once

#include <cstddef>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

namespace brickfield {

/// Calls visit(0) to visit(count - 1) on all threads of the arena.
///
/// group      items that are taken together at most: so many that they cost several microseconds
/// proved by  tests/bake/bakers/each_uneven_test.cpp
template <typename Visit>
void forEachUneven(std::size_t count, std::size_t group, const Visit& visit) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, group),
      [&](const tbb::blocked_range<std::size_t>& items) {
        for (std::size_t i = items.begin(); i != items.end(); ++i) visit(i);
      },
      tbb::simple_partitioner());
}

} // namespace brickfield
