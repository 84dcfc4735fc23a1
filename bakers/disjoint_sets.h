// Union-find. The root of a set is its smallest member, so the result does not depend on the order of the unions.
#pragma once

#include <cstdint>
#include <numeric>
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

} // namespace brickfield
