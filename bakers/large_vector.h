// Vectors of many elements: from a mebibyte on their memory is asked for in huge pages, since the first touch of
// each page costs as much as a microsecond of work or several; smaller ones ask for all of their pages at once.
// Elements that need no making are left as memory comes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace brickfield {

inline constexpr std::size_t kHugePageBytes = std::size_t{2} << 20;
inline constexpr std::size_t kMostlyHugePageBytes = kHugePageBytes / 2;  // worth a whole one
inline constexpr std::size_t kSeveralPagesBytes = std::size_t{64} << 10; // fewer are touched as fast as asked for

/// What so many bytes take of memory.
inline std::size_t largeVectorBytes(std::size_t bytes) {
  const bool isHuge = bytes >= kMostlyHugePageBytes;
  return isHuge ? (bytes + kHugePageBytes - 1) / kHugePageBytes * kHugePageBytes : bytes;
}

template <typename Element>
struct LargeAllocator {
  using value_type = Element;

  LargeAllocator() = default;
  template <typename Other>
  LargeAllocator(const LargeAllocator<Other>&) noexcept {}

  Element* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 4 / sizeof(Element)) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(Element);
    const bool isLarge = bytes >= kMostlyHugePageBytes;
    const std::size_t step = isLarge ? kHugePageBytes : std::max(alignof(Element), alignof(std::max_align_t));
    void* memory = std::aligned_alloc(step, (bytes + step - 1) / step * step);
    if (!memory) throw std::bad_alloc();
#if defined(__linux__)
    // Advice: it may be refused.
    if (isLarge) madvise(memory, (bytes + step - 1) / step * step, MADV_HUGEPAGE);
#if defined(MADV_POPULATE_WRITE)
    if (!isLarge && bytes >= kSeveralPagesBytes) {
      constexpr std::uintptr_t kPageBytes = 4096;
      const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(memory) / kPageBytes * kPageBytes;
      const std::uintptr_t end = reinterpret_cast<std::uintptr_t>(memory) + bytes;
      madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
    }
#endif
#endif
    return static_cast<Element*>(memory);
  }
  void deallocate(Element* memory, std::size_t) noexcept { std::free(memory); }

  /// Without arguments: no value for what needs none.
  template <typename Made>
  void construct(Made* place) {
    ::new (static_cast<void*>(place)) Made;
  }
  template <typename Made, typename... Arguments>
  void construct(Made* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) Made(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

/// LargeVector<float>(n) and resize(n) leave new elements with anything; assign(n, 0) fills.
template <typename Element>
using LargeVector = std::vector<Element, LargeAllocator<Element>>;

} // namespace brickfield
