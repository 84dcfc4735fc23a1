// Binned surface area heuristic, top down, then a sort of the nodes by height.
#include "resident/hierarchy_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kBins = 16;
// Testing two boxes costs about as much as testing one triangle.
constexpr float kNodeCost = 1.0f;

float halfArea(const Box& box) {
  const glm::vec3 e = box.extent();
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

struct Item {
  Box box;
  glm::vec3 center{0.0f};
  std::uint32_t number = 0;
};

struct Split {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;
  std::uint32_t bin = 0; ///< the first of the right side
};

/// Maps centres of a run of items to bins along an axis.
struct Binning {
  glm::vec3 origin{0.0f};
  glm::vec3 binsPerUnit{0.0f};

  explicit Binning(std::span<const Item> items) {
    Box centers;
    for (const Item& item : items) centers.extend(item.center);
    origin = centers.min;
    for (int axis = 0; axis < 3; ++axis) {
      const float extent = centers.extent()[axis];
      binsPerUnit[axis] = extent > 0 ? static_cast<float>(kBins) / extent : 0.0f;
      if (!std::isfinite(binsPerUnit[axis])) binsPerUnit[axis] = 0.0f; // narrower than floats can divide
    }
  }
  bool isFlat(int axis) const { return binsPerUnit[axis] == 0.0f; }
  std::uint32_t binOf(const Item& item, int axis) const {
    const float bin = (item.center[axis] - origin[axis]) * binsPerUnit[axis];
    return std::min(static_cast<std::uint32_t>(std::max(bin, 0.0f)), kBins - 1);
  }
};

Split bestSplitAlong(std::span<const Item> items, const Binning& binning, int axis) {
  struct Bin {
    Box box;
    std::uint32_t count = 0;
  };
  std::array<Bin, kBins> bins;
  for (const Item& item : items) {
    Bin& bin = bins[binning.binOf(item, axis)];
    bin.box.extend(item.box);
    ++bin.count;
  }
  std::array<float, kBins> rightCosts{};
  Bin right;
  for (std::uint32_t b = kBins - 1; b > 0; --b) {
    right.box.extend(bins[b].box);
    right.count += bins[b].count;
    rightCosts[b] = halfArea(right.box) * static_cast<float>(right.count);
  }
  Split best;
  Bin left;
  for (std::uint32_t b = 1; b < kBins; ++b) {
    left.box.extend(bins[b - 1].box);
    left.count += bins[b - 1].count;
    if (left.count == 0 || left.count == items.size()) continue;
    const float cost = halfArea(left.box) * static_cast<float>(left.count) + rightCosts[b];
    if (cost < best.cost) best = {cost, axis, b};
  }
  return best;
}

class TreeBuilder {
public:
  TreeBuilder(std::span<const Box> boxes, const HierarchyLimits& limits) : limits_(limits), items_(boxes.size()) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      items_[i].number = static_cast<std::uint32_t>(i);
      if (boxes[i].isEmpty() || !isFinite(boxes[i].min) || !isFinite(boxes[i].max)) continue; // stands at zero
      items_[i].box = boxes[i];
      items_[i].center = boxes[i].center();
    }
  }

  HierarchyTree build() {
    HierarchyTree tree;
    if (items_.empty()) return tree;
    const std::uint32_t root = buildRun(0, static_cast<std::uint32_t>(items_.size()), limits_.levels);
    tree.order.reserve(items_.size());
    for (const Item& item : items_) tree.order.push_back(item.number);
    sortByHeight(tree, root);
    return tree;
  }

private:
  /// Levels of halving until a leaf takes the rest.
  std::uint32_t levelsNeeded(std::uint32_t count) const {
    const std::uint32_t leaves = ceilDivide(count, limits_.leafItems);
    return static_cast<std::uint32_t>(std::bit_width(leaves - 1));
  }

  std::uint32_t leafWord(std::uint32_t first, std::uint32_t count) const {
    return shared::HIERARCHY_LEAF | (count - 1) << shared::HIERARCHY_COUNT_SHIFT | first;
  }

  /// levels  that may stand here and below; never less than levelsNeeded(count)
  std::uint32_t buildRun(std::uint32_t first, std::uint32_t count, std::uint32_t levels) {
    if (count == 1 || levels == 0) return leafWord(first, count);
    const std::uint32_t middle = splitRun(first, count, levels);
    if (middle == first) return leafWord(first, count);
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    heights_.push_back(0);
    const std::uint32_t left = buildRun(first, middle - first, levels - 1);
    const std::uint32_t right = buildRun(middle, first + count - middle, levels - 1);
    nodes_[node] = {left, right};
    for (const std::uint32_t child : {left, right})
      if (!(child & shared::HIERARCHY_LEAF)) heights_[node] = std::max(heights_[node], heights_[child] + 1);
    return node;
  }

  /// Reorders the run; returns the first item of the right side, or `first` where a leaf is cheaper.
  std::uint32_t splitRun(std::uint32_t first, std::uint32_t count, std::uint32_t levels) {
    const std::span<Item> items(&items_[first], count);
    const Binning binning(items);
    // A side may keep all items but one, and then needs as many levels as all: one must be to spare.
    if (levelsNeeded(count) < levels) {
      Split best;
      for (int axis = 0; axis < 3; ++axis) {
        if (binning.isFlat(axis)) continue;
        const Split split = bestSplitAlong(items, binning, axis);
        if (split.cost < best.cost) best = split;
      }
      if (best.axis >= 0) {
        Box whole;
        for (const Item& item : items) whole.extend(item.box);
        const float leafCost = halfArea(whole) * (static_cast<float>(count) - kNodeCost);
        if (count <= limits_.leafItems && leafCost <= best.cost) return first;
        const auto middle = std::stable_partition(
            items.begin(), items.end(), [&](const Item& item) { return binning.binOf(item, best.axis) < best.bin; });
        return first + static_cast<std::uint32_t>(middle - items.begin());
      }
    }
    if (count <= limits_.leafItems) return first;
    return first + halve(items, binning);
  }

  /// By the middle item along the longest side of the centres.
  static std::uint32_t halve(std::span<Item> items, const Binning& binning) {
    int axis = -1;
    for (int other = 0; other < 3; ++other)
      if (!binning.isFlat(other) && (axis < 0 || binning.binsPerUnit[other] < binning.binsPerUnit[axis])) axis = other;
    const auto half = static_cast<std::uint32_t>(items.size() / 2);
    if (axis < 0) return half;
    std::nth_element(items.begin(), items.begin() + half, items.end(), [axis](const Item& one, const Item& other) {
      if (one.center[axis] != other.center[axis]) return one.center[axis] < other.center[axis];
      return one.number < other.number;
    });
    return half;
  }

  void sortByHeight(HierarchyTree& tree, std::uint32_t root) const {
    std::vector<std::uint32_t> byHeight(nodes_.size()), placeOf(nodes_.size());
    std::iota(byHeight.begin(), byHeight.end(), 0u);
    std::stable_sort(byHeight.begin(), byHeight.end(),
                     [this](std::uint32_t one, std::uint32_t other) { return heights_[one] > heights_[other]; });
    for (std::uint32_t place = 0; place < byHeight.size(); ++place) placeOf[byHeight[place]] = place;
    const auto renamed = [&](std::uint32_t word) { return word & shared::HIERARCHY_LEAF ? word : placeOf[word]; };
    tree.root = renamed(root);
    tree.nodes.reserve(nodes_.size());
    for (const std::uint32_t node : byHeight)
      tree.nodes.push_back({renamed(nodes_[node].left), renamed(nodes_[node].right)});
    if (nodes_.empty()) return;
    tree.heightEnds.assign(heights_[byHeight.front()] + 1, 0);
    for (std::uint32_t place = 0; place < byHeight.size(); ++place)
      tree.heightEnds[heights_[byHeight[place]]] = place + 1;
  }

  HierarchyLimits limits_;
  std::vector<Item> items_;
  std::vector<HierarchyTree::Node> nodes_; ///< as they were made
  std::vector<std::uint32_t> heights_;
};

} // namespace

HierarchyTree buildHierarchyTree(std::span<const Box> boxes, const HierarchyLimits& limits) {
  const std::uint64_t most =
      std::min<std::uint64_t>(std::uint64_t{limits.leafItems} << limits.levels, shared::HIERARCHY_FIRST_MASK);
  if (boxes.size() > most)
    throw BadInput("triangle hierarchy", "", fmt::format("{} items, at most {} are possible", boxes.size(), most));
  return TreeBuilder(boxes, limits).build();
}

HierarchyTree buildHierarchyTree(std::span<const TriangleCorners> triangles) {
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const glm::vec3 corner : {triangles[i].a, triangles[i].b, triangles[i].c}) boxes[i].extend(corner);
  return buildHierarchyTree(boxes);
}

HierarchyTree buildHierarchyTree(const Mesh& mesh) {
  std::vector<TriangleCorners> triangles;
  for (const Primitive& primitive : mesh.primitives)
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
      triangles.push_back({primitive.positions[primitive.indices[i]], primitive.positions[primitive.indices[i + 1]],
                           primitive.positions[primitive.indices[i + 2]]});
  return buildHierarchyTree(triangles);
}

} // namespace brickfield
