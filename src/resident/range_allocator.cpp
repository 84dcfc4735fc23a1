// Gaps in an ordered map; a gap at the end shrinks the end instead.
#include "resident/range_allocator.h"

#include <iterator>

#include "core/error.h"

namespace brickfield {

std::uint32_t RangeAllocator::allocate(std::uint32_t count) {
  if (count == 0) return 0;
  for (auto gap = gaps_.begin(); gap != gaps_.end(); ++gap) {
    if (gap->second < count) continue;
    const std::uint32_t first = gap->first;
    const std::uint32_t left = gap->second - count;
    gaps_.erase(gap);
    if (left) gaps_.emplace(first + count, left);
    used_ += count;
    return first;
  }
  if (count > 0xffffffffu - end_) throw Failure("range allocator: more than 32 bits can number");
  const std::uint32_t first = end_;
  end_ += count;
  used_ += count;
  return first;
}

void RangeAllocator::release(std::uint32_t first, std::uint32_t count) {
  if (count == 0) return;
  // A gap that overlaps, or numbers beyond the end, were given back before, whatever they have grown together with.
  const auto above = gaps_.lower_bound(first);
  const bool overlapsAbove = above != gaps_.end() && above->first - first < count;
  const bool overlapsBelow = above != gaps_.begin() && first - std::prev(above)->first < std::prev(above)->second;
  if (first >= end_ || count > end_ - first || overlapsAbove || overlapsBelow)
    throw Failure("range allocator: a range was given back that is not handed out");
  used_ -= count;
  auto gap = gaps_.emplace(first, count).first;
  if (const auto next = std::next(gap); next != gaps_.end() && gap->first + gap->second == next->first) {
    gap->second += next->second;
    gaps_.erase(next);
  }
  if (gap != gaps_.begin()) {
    const auto before = std::prev(gap);
    if (before->first + before->second == gap->first) {
      before->second += gap->second;
      gaps_.erase(gap);
      gap = before;
    }
  }
  if (gap->first + gap->second == end_) {
    end_ = gap->first;
    gaps_.erase(gap);
  }
}

} // namespace brickfield
