// A range of triangles is split in two where bins say that it costs least, the cut moved to the next multiple of eight;
// a node takes up to eight such ranges, of which that with the largest box is split next. Since all cuts lie at
// multiples of eight, leaf i holds the triangles from place 8 i on, and threads need not agree on anything. Ranges of
// more than 64 are cut at multiples of 64: nodes are as full as leaves. Scans of many triangles are first grouped by 64
// along Hilbert's curve: a tree that walks a little slower, but takes a third of the time.
#include "bakers/mesh_hierarchy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "bakers/stable_deal.h"

namespace brickfield {

namespace {

constexpr std::size_t kWholeNode = kHierarchyWidth * kHierarchyWidth; // triangles under a node that has leaves alone
constexpr std::size_t kManyTriangles = 1u << 17; // from here on the bins cost more than they save in walks
constexpr std::uint32_t kHilbertBits = 10;       // an axis
constexpr std::size_t kBins = 16;
constexpr std::size_t kParallelRange = 4096; // smaller ones are left to one thread
constexpr std::size_t kSortedRange = 64;     // smaller ones are cut in the middle of their longest side

/// A triangle that is being sorted in.
struct Item {
  Float4 min, max; ///< the fourth lanes are not looked at
  std::uint32_t triangle;

  float center(std::size_t axis) const { return min[axis] + max[axis]; } // twice the centre
};

struct ItemBox {
  Float4 min = broadcast(HUGE_VALF), max = broadcast(-HUGE_VALF);

  void extend(Float4 low, Float4 high) { min = minimum(min, low), max = maximum(max, high); }
  float halfArea() const {
    const Float4 side = max - min;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }
};

struct Range {
  std::size_t begin = 0, end = 0;
  ItemBox box, centers; ///< of the triangles, of twice their centres

  std::size_t count() const { return end - begin; }
};

/// A node as it is built, with all below it.
struct BuiltNode {
  std::size_t childCount = 0;
  std::array<Range, kHierarchyWidth> ranges;
  std::array<std::unique_ptr<BuiltNode>, kHierarchyWidth> nodes; ///< nothing where the range is a leaf
};

struct Cut {
  float cost = HUGE_VALF;
  std::size_t axis = 0;
  std::size_t place = 0; ///< triangles before it
};

Item itemOf(const TriangleSoup& soup, std::uint32_t triangle) {
  ItemBox box;
  for (const glm::dvec3& corner : soup.corners(triangle)) {
    const glm::vec3 p(corner);
    const Float4 lanes{p.x, p.y, p.z, 0.0f};
    box.extend(lanes, lanes);
  }
  return {box.min, box.max, triangle};
}

/// Sorts items into a tree whose leaves take up to leafSize of them: triangles by eight, clusters one by one.
class RangeBuilder {
public:
  RangeBuilder(LargeVector<Item>& items, std::size_t leafSize)
      : items_(items), leafSize_(leafSize), nodeSize_(leafSize * kHierarchyWidth) {}

  /// width  most children of the root
  std::unique_ptr<BuiltNode> build(std::size_t width = kHierarchyWidth) {
    const Range all = rangeOf(0, items_.size());
    if (!isLeaf(all)) return nodeOf(all, width);
    auto node = std::make_unique<BuiltNode>(); // a lone leaf: walks always start at a node
    node->childCount = 1;
    node->ranges[0] = all;
    return node;
  }

  Range rangeOf(std::size_t begin, std::size_t end) const {
    Range range{begin, end, {}, {}};
    for (std::size_t i = begin; i < end; ++i) {
      const Float4 center = items_[i].min + items_[i].max;
      range.box.extend(items_[i].min, items_[i].max);
      range.centers.extend(center, center);
    }
    return range;
  }

  std::unique_ptr<BuiltNode> nodeOf(const Range& range, std::size_t width = kHierarchyWidth) {
    auto node = std::make_unique<BuiltNode>();
    node->ranges[0] = range;
    node->childCount = 1;
    while (node->childCount < width) {
      const std::size_t widest = widestOf(*node, range.count() > nodeSize_ ? nodeSize_ : leafSize_);
      if (widest == kHierarchyWidth) break;
      const std::size_t middle = split(node->ranges[widest]);
      const Range whole = node->ranges[widest];
      // Children stay in the order of their triangles.
      std::move_backward(node->ranges.begin() + static_cast<std::ptrdiff_t>(widest) + 1,
                         node->ranges.begin() + static_cast<std::ptrdiff_t>(node->childCount),
                         node->ranges.begin() + static_cast<std::ptrdiff_t>(node->childCount) + 1);
      node->ranges[widest] = rangeOf(whole.begin, middle);
      node->ranges[widest + 1] = rangeOf(middle, whole.end);
      ++node->childCount;
    }
    const auto descend = [&](std::size_t i) {
      if (!isLeaf(node->ranges[i])) node->nodes[i] = nodeOf(node->ranges[i]);
    };
    if (range.count() > kParallelRange)
      tbb::parallel_for(std::size_t{0}, node->childCount, descend);
    else
      for (std::size_t i = 0; i < node->childCount; ++i) descend(i);
    return node;
  }

private:
  bool isLeaf(const Range& range) const { return range.count() <= leafSize_; }

  /// Which of the ranges with more triangles than that is to be split; kHierarchyWidth: none.
  static std::size_t widestOf(const BuiltNode& node, std::size_t enough) {
    std::size_t widest = kHierarchyWidth;
    for (std::size_t i = 0; i < node.childCount; ++i)
      if (node.ranges[i].count() > enough &&
          (widest == kHierarchyWidth || weightOf(node.ranges[i]) > weightOf(node.ranges[widest])))
        widest = i;
    return widest;
  }
  static float weightOf(const Range& range) { return range.box.halfArea() * static_cast<float>(range.count()); }

  /// Sorts a range into two and returns where the second begins.
  std::size_t split(const Range& range) {
    const Cut cut = range.count() > kSortedRange ? cheapestCut(range) : middleCut(range);
    const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto end = items_.begin() + static_cast<std::ptrdiff_t>(range.end);
    const auto isBefore = [axis = cut.axis](const Item& a, const Item& b) {
      const float centerA = a.center(axis), centerB = b.center(axis);
      return centerA != centerB ? centerA < centerB : a.triangle < b.triangle;
    };
    std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(cut.place), end, isBefore);
    return range.begin + cut.place;
  }

  static std::size_t longestAxis(const Range& range) {
    const Float4 side = range.centers.max - range.centers.min;
    return side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
  }
  /// The nearest place that leaves whole nodes of whole leaves before it, or whole leaves.
  std::size_t toWholeLeaves(std::size_t place, std::size_t count) const {
    const std::size_t step = count > nodeSize_ ? nodeSize_ : leafSize_;
    return std::clamp((place + step / 2) / step * step, step, (count - 1) / step * step);
  }
  Cut middleCut(const Range& range) const {
    return {0, longestAxis(range), toWholeLeaves(range.count() / 2, range.count())};
  }

  Cut cheapestCut(const Range& range) const {
    struct Bin {
      ItemBox box;
      std::size_t count = 0;
    };
    std::array<std::array<Bin, kBins>, 3> bins;
    const Float4 side = range.centers.max - range.centers.min;
    Float4 scale;
    for (std::size_t axis = 0; axis < 4; ++axis)
      scale[axis] = side[axis] > 0 ? 0.999f * static_cast<float>(kBins) / side[axis] : 0.0f; // never past the last bin
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Float4 place = (items_[i].min + items_[i].max - range.centers.min) * scale;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Bin& bin = bins[axis][static_cast<std::size_t>(place[axis])];
        bin.box.extend(items_[i].min, items_[i].max);
        ++bin.count;
      }
    }
    Cut best = middleCut(range);
    best.cost = HUGE_VALF;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<float, kBins> costFrom{}; // of all bins from this one on
      ItemBox box;
      std::size_t count = 0;
      for (std::size_t b = kBins - 1; b > 0; --b) {
        box.extend(bins[axis][b].box.min, bins[axis][b].box.max);
        count += bins[axis][b].count;
        costFrom[b] = count > 0 ? box.halfArea() * leavesOf(count) : HUGE_VALF;
      }
      box = {}, count = 0;
      for (std::size_t b = 0; b + 1 < kBins; ++b) {
        box.extend(bins[axis][b].box.min, bins[axis][b].box.max);
        count += bins[axis][b].count;
        if (count == 0) continue;
        const float cost = box.halfArea() * leavesOf(count) + costFrom[b + 1];
        if (cost < best.cost) best = {cost, axis, toWholeLeaves(count, range.count())};
      }
    }
    return best;
  }
  float leavesOf(std::size_t count) const { return static_cast<float>((count + leafSize_ - 1) / leafSize_); }

  LargeVector<Item>& items_;
  std::size_t leafSize_, nodeSize_;
};

/// Steps of Hilbert's curve through the eight cells of a cube (Hamilton, Compact Hilbert Indices, 2006): by where the
/// curve enters it and along which axis it leaves, and by the cell, the place on the curve and how it goes through that
/// cell.
class HilbertSteps {
public:
  struct Step {
    std::uint8_t place = 0, next = 0;
  };
  constexpr HilbertSteps() {
    for (unsigned state = 0; state < kStates; ++state)
      for (unsigned cell = 0; cell < 8; ++cell) steps_[state][cell] = stepOf(state / 3, state % 3, cell);
  }
  constexpr Step at(unsigned state, unsigned cell) const { return steps_[state][cell]; }

private:
  static constexpr unsigned kStates = 24;

  static constexpr unsigned turned(unsigned bits, unsigned by) { return (bits << by | bits >> (3 - by)) & 7u; }
  static constexpr unsigned gray(unsigned i) { return i ^ i >> 1; }
  static constexpr Step stepOf(unsigned entry, unsigned axis, unsigned cell) {
    const unsigned by = (axis + 1) % 3, seen = turned(cell ^ entry, (3 - by) % 3);
    const unsigned place = seen ^ seen >> 1 ^ seen >> 2; // undoes gray
    const unsigned entryOfCell = place == 0 ? 0 : gray(2 * ((place - 1) / 2));
    const unsigned trailing = place == 0 ? 0 : static_cast<unsigned>(std::countr_one(place - (place + 1) % 2));
    const unsigned next = 3 * (entry ^ turned(entryOfCell, by)) + (axis + trailing + 1) % 3;
    return {static_cast<std::uint8_t>(place), static_cast<std::uint8_t>(next)};
  }

  std::array<std::array<Step, 8>, kStates> steps_;
};
constexpr HilbertSteps kHilbertSteps;

/// Place of one of the unit cube's 1024^3 cells on the curve.
std::uint32_t hilbertCode(std::array<std::uint32_t, 3> cell) {
  std::uint32_t code = 0;
  unsigned state = 0;
  for (std::uint32_t bit = kHilbertBits; bit-- > 0;) {
    const unsigned child = (cell[0] >> bit & 1u) | (cell[1] >> bit & 1u) << 1 | (cell[2] >> bit & 1u) << 2;
    const HilbertSteps::Step step = kHilbertSteps.at(state, child);
    code = code << 3 | step.place;
    state = step.next;
  }
  return code;
}

/// By the upper half of each, digit by digit; those that agree in it stay in their order.
void sortByCode(LargeVector<std::uint64_t>& keys) {
  constexpr std::uint32_t kDigitBits = 10, kDigits = 3 * kHilbertBits / kDigitBits;
  constexpr std::size_t kValues = std::size_t{1} << kDigitBits;
  LargeVector<std::uint64_t> sorted(keys.size());
  for (std::uint32_t digit = 0; digit < kDigits; ++digit) {
    dealStably(
        keys.size(), kValues,
        [&, shift = 32 + kDigitBits * digit](std::size_t i) { return keys[i] >> shift & (kValues - 1); },
        [&](std::size_t i, std::uint32_t place) { sorted[place] = keys[i]; });
    keys.swap(sorted);
  }
}

/// For many triangles: those of clusters of 64 along Hilbert's curve through the centres (of equal places the lower
/// triangle first); the clusters are sorted into a tree, then each into its leaves.
class ClusterBuilder {
public:
  ClusterBuilder(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles)
      : soup_(soup), triangles_(triangles), clusters_(triangles.size() / kWholeNode) {
    sortAlongCurve();
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, clusters_.size(), kParallelRange / kWholeNode),
                      [&](const auto& block) {
                        for (std::size_t c = block.begin(); c < block.end(); ++c) clusters_[c] = clusterOf(c);
                      });
  }

  /// items  get the triangles in the order of the tree
  std::unique_ptr<BuiltNode> build(LargeVector<Item>& items) {
    const std::size_t whole = kWholeNode * clusters_.size(), count = triangles_.size();
    auto root = RangeBuilder(clusters_, 1).build(count > whole ? kHierarchyWidth - 1 : kHierarchyWidth);
    items.resize(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, clusters_.size(), kParallelRange / kWholeNode),
                      [&](const auto& block) {
                        for (std::size_t i = kWholeNode * block.begin(); i < kWholeNode * block.end(); ++i)
                          items[i] = itemAt(kWholeNode * clusters_[i / kWholeNode].triangle + i % kWholeNode);
                      });
    for (std::size_t i = whole; i < count; ++i) items[i] = itemAt(i);
    expand(*root, items);
    if (count > whole) addChild(*root, root->childCount++, whole, items);
    return root;
  }

private:
  void sortAlongCurve() {
    using Block = tbb::blocked_range<std::size_t>;
    const ItemBox centers = tbb::parallel_reduce(
        Block(0, triangles_.size(), kParallelRange), ItemBox{},
        [&](const Block& block, ItemBox box) {
          for (std::size_t i = block.begin(); i < block.end(); ++i) {
            const Float4 center = centerOf(triangles_[i]);
            box.extend(center, center);
          }
          return box;
        },
        [](ItemBox a, const ItemBox& b) {
          a.extend(b.min, b.max);
          return a;
        });
    const Float4 side = centers.max - centers.min;
    const float scale =
        0.9999f * static_cast<float>(1u << kHilbertBits) / std::max({side[0], side[1], side[2], 1e-30f});
    keys_.resize(triangles_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys_.size(), kParallelRange), [&](const auto& block) {
      for (std::size_t i = block.begin(); i < block.end(); ++i) {
        const Float4 place = (centerOf(triangles_[i]) - centers.min) * broadcast(scale);
        const std::array<std::uint32_t, 3> cell = {static_cast<std::uint32_t>(place[0]),
                                                   static_cast<std::uint32_t>(place[1]),
                                                   static_cast<std::uint32_t>(place[2])};
        keys_[i] = std::uint64_t{hilbertCode(cell)} << 32 | i;
      }
    });
    sortByCode(keys_);
  }
  Float4 centerOf(std::uint32_t triangle) const {
    const Item item = itemOf(soup_, triangle);
    return item.min + item.max;
  }
  Item itemAt(std::size_t place) const { return itemOf(soup_, triangles_[keys_[place] & 0xffffffffu]); }
  Item clusterOf(std::size_t number) const {
    ItemBox box;
    for (std::size_t i = kWholeNode * number; i < kWholeNode * (number + 1); ++i) {
      const Item item = itemAt(i);
      box.extend(item.min, item.max);
    }
    return {box.min, box.max, static_cast<std::uint32_t>(number)};
  }
  static void addChild(BuiltNode& node, std::size_t i, std::size_t begin, LargeVector<Item>& items) {
    RangeBuilder builder(items, kHierarchyWidth);
    node.ranges[i] = builder.rangeOf(begin, std::min(begin + kWholeNode, items.size()));
    if (node.ranges[i].count() > kHierarchyWidth) node.nodes[i] = builder.nodeOf(node.ranges[i]);
  }
  static void expand(BuiltNode& node, LargeVector<Item>& items) {
    tbb::parallel_for(std::size_t{0}, node.childCount, [&](std::size_t i) {
      if (node.nodes[i])
        expand(*node.nodes[i], items);
      else
        addChild(node, i, kWholeNode * node.ranges[i].begin, items);
    });
  }

  const TriangleSoup& soup_;
  const std::vector<std::uint32_t>& triangles_;
  LargeVector<std::uint64_t> keys_; ///< along the curve: code, then place in triangles_
  LargeVector<Item> clusters_;      ///< their number for a triangle's
};

void setTriangle(HierarchyLeaf& leaf, std::size_t lane, const std::array<glm::dvec3, 3>& corners) {
  const glm::dvec3 ab = corners[1] - corners[0], ac = corners[2] - corners[0], bc = corners[2] - corners[1];
  const double lengthAb = glm::length(ab), lengthAc = glm::length(ac), lengthBc = glm::length(bc);
  const glm::dvec3 x = ab / lengthAb, normal = glm::normalize(glm::cross(ab, ac)), y = glm::cross(normal, x);
  leaf.a.setLane(lane, glm::vec3(corners[0]));
  leaf.alongAb.setLane(lane, glm::vec3(x));
  leaf.normal.setLane(lane, glm::vec3(normal));
  leaf.acX.setLane(lane, static_cast<float>(glm::dot(ac, x) / lengthAc));
  leaf.acY.setLane(lane, static_cast<float>(glm::dot(ac, y) / lengthAc));
  leaf.bcX.setLane(lane, static_cast<float>(glm::dot(bc, x) / lengthBc));
  leaf.bcY.setLane(lane, static_cast<float>(glm::dot(bc, y) / lengthBc));
  leaf.lengthAb.setLane(lane, static_cast<float>(lengthAb));
  leaf.lengthAc.setLane(lane, static_cast<float>(lengthAc));
  leaf.lengthBc.setLane(lane, static_cast<float>(lengthBc));
}

HierarchyLeaf leafOf(const TriangleSoup& soup, const LargeVector<Item>& items, std::size_t begin) {
  HierarchyLeaf leaf;
  const std::size_t count = std::min(kHierarchyWidth, items.size() - begin);
  for (std::size_t i = 0; i < kHierarchyWidth; ++i) leaf.triangles[i] = items[begin + std::min(i, count - 1)].triangle;
  const auto left = leaf.triangles.begin() + static_cast<std::ptrdiff_t>(count);
  std::fill(left, leaf.triangles.end(), *std::max_element(leaf.triangles.begin(), left));
  std::sort(leaf.triangles.begin(), leaf.triangles.end());
  for (std::size_t i = 0; i < kHierarchyWidth; ++i) setTriangle(leaf, i, soup.corners(leaf.triangles[i]));
  return leaf;
}

/// Copies the built tree depth first, so that what is walked together lies together.
HierarchyChild flatten(const BuiltNode& built, LargeVector<HierarchyNode>& nodes) {
  const std::size_t index = nodes.size();
  nodes.emplace_back();
  for (std::size_t i = 0; i < kHierarchyWidth; ++i) {
    const bool exists = i < built.childCount;
    const ItemBox box = exists ? built.ranges[i].box : ItemBox{};
    nodes[index].min.setLane(i, {box.min[0], box.min[1], box.min[2]});
    nodes[index].max.setLane(i, {box.max[0], box.max[1], box.max[2]});
    if (!exists) continue;
    const auto leaf = static_cast<std::uint32_t>(built.ranges[i].begin / kHierarchyWidth);
    const HierarchyChild child =
        built.nodes[i] ? flatten(*built.nodes[i], nodes) : HierarchyChild{HierarchyChild::kLeafBit | leaf};
    nodes[index].children[i] = child;
  }
  return {static_cast<std::uint32_t>(index)};
}

} // namespace

MeshHierarchy::MeshHierarchy(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles)
    : soup_(&soup), triangleCount_(triangles.size()) {
  LargeVector<Item> items;
  std::unique_ptr<BuiltNode> built;
  if (triangles.size() < kManyTriangles) {
    items.resize(triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, items.size(), kParallelRange), [&](const auto& block) {
      for (std::size_t i = block.begin(); i < block.end(); ++i) items[i] = itemOf(soup, triangles[i]);
    });
    built = RangeBuilder(items, kHierarchyWidth).build();
  } else {
    built = ClusterBuilder(soup, triangles).build(items);
  }
  leaves_.resize((triangles.size() + kHierarchyWidth - 1) / kHierarchyWidth);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves_.size(), kParallelRange / kHierarchyWidth),
                    [&](const auto& block) {
                      for (std::size_t i = block.begin(); i < block.end(); ++i)
                        leaves_[i] = leafOf(soup, items, kHierarchyWidth * i);
                    });
  flatten(*built, nodes_);
}

} // namespace brickfield
