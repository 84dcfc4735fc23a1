// Union-find. The root of a set is its smallest member, so the result does not depend on the order of the unions.
#pragma once

#include <atomic>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace brickfield {

class DisjointSets {
public:
  explicit DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

  /// Halves the path that it walks.
  std::uint32_t rootOf(std::uint32_t member) {
    while (parents_[member] != member) {
      parents_[member] = parents_[parents_[member]];
      member = parents_[member];
    }
    return member;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = rootOf(a), b = rootOf(b);
    if (a < b) parents_[b] = a;
    if (b < a) parents_[a] = b;
  }

private:
  std::vector<std::uint32_t> parents_;
};

/// The same for many threads at once (Anderson and Woll 1991).
class SharedSets {
public:
  explicit SharedSets(std::size_t count) : parents_(count) {
    for (std::size_t i = 0; i < count; ++i) parents_[i].store(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
  }

  /// Of the unions so far; halves the path that it walks.
  std::uint32_t rootOf(std::uint32_t member) {
    while (true) {
      std::uint32_t parent = parents_[member].load(std::memory_order_relaxed);
      if (parent == member) return member;
      const std::uint32_t next = parents_[parent].load(std::memory_order_relaxed);
      // Who else has written here in the meantime has written a member nearer to the root.
      if (next != parent) parents_[member].compare_exchange_weak(parent, next, std::memory_order_relaxed);
      member = next;
    }
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = rootOf(a), b = rootOf(b);
      if (a == b) return;
      if (a > b) std::swap(a, b);
      std::uint32_t root = b; // still, or another one was faster
      if (parents_[b].compare_exchange_strong(root, a, std::memory_order_relaxed)) return;
    }
  }

private:
  std::vector<std::atomic<std::uint32_t>> parents_; ///< smaller than the member, or it
};

} // namespace brickfield
