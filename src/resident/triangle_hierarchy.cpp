// Lays trees out in buffers and says in which order their bounds are to be fitted.
#include "resident/triangle_hierarchy.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

using shared::HierarchyNode;
using shared::RefitRow;

// Heights with no more nodes than this are left to one work group a tree, which takes them in turn: a dispatch and its
// barrier cost more than a few rounds of one group.
constexpr std::uint32_t kListNodes = 4 * shared::REFIT_GROUP;

/// A node whose boxes hold nothing, until they are fitted.
HierarchyNode makeNode(std::uint32_t left, std::uint32_t right) {
  const glm::vec4 nothing(1, -1, 1, -1);
  return {nothing, nothing, nothing, {left, right, 0, 0}};
}

std::uint32_t placedWord(std::uint32_t word, std::uint32_t firstNode, std::uint32_t firstOrder) {
  if (word == shared::HIERARCHY_NONE) return word;
  return word + (word & shared::HIERARCHY_LEAF ? firstOrder : firstNode);
}

RefitRow makeRow(std::uint32_t first, std::uint32_t count) { return {{first, count, 0, 0}}; }

/// The first height that is left to one work group.
std::uint32_t firstListHeight(const HierarchyTree& tree) {
  std::uint32_t height = 0;
  while (height < tree.heights() && tree.heightEnds[height] - tree.heightBegin(height) > kListNodes) ++height;
  return height;
}

} // namespace

TriangleHierarchy::TriangleHierarchy(std::span<const HierarchyTree> trees, std::span<const HierarchyInstance> instances)
    : trees_(trees.begin(), trees.end()) {
  std::uint64_t nodeCount = instances.size(), orderCount = 0;
  for (const HierarchyInstance& instance : instances) {
    nodeCount += trees[instance.tree].nodes.size();
    orderCount += trees[instance.tree].order.size();
  }
  if (orderCount > shared::HIERARCHY_FIRST_MASK || instances.size() >> shared::HIERARCHY_TOP_LEVELS)
    throw BadInput("triangle hierarchy", "",
                   fmt::format("{} triangles of {} instances are too many", orderCount, instances.size()));
  std::vector<HierarchyNode> nodes(instances.size(), makeNode(shared::HIERARCHY_NONE, shared::HIERARCHY_NONE));
  std::vector<std::uint32_t> order;
  nodes.reserve(nodeCount);
  order.reserve(orderCount);
  for (const HierarchyInstance& instance : instances) {
    const HierarchyTree& tree = trees[instance.tree];
    const auto firstNode = static_cast<std::uint32_t>(nodes.size());
    const auto firstOrder = static_cast<std::uint32_t>(order.size());
    instances_.push_back({instance.tree, firstNode, placedWord(tree.root, firstNode, firstOrder)});
    for (const HierarchyTree::Node& node : tree.nodes)
      nodes.push_back(
          makeNode(placedWord(node.left, firstNode, firstOrder), placedWord(node.right, firstNode, firstOrder)));
    for (const std::uint32_t triangle : tree.order) order.push_back(instance.firstTriangle + triangle);
  }
  for (HierarchyTree& tree : trees_) tree.order = {}, tree.nodes = {};
  triangleCount_ = static_cast<std::uint32_t>(orderCount);
  nodes_ = Buffer("hierarchy_nodes", nodes);
  order_ = Buffer("hierarchy_order", order, 0);
  refit_ = Buffer("hierarchy_refit", 0);
}

void TriangleHierarchy::update(std::span<const Box> boxesAnchored, std::span<const std::uint32_t> moved) {
  if (boxesAnchored.size() != instances_.size())
    throw Failure(
        fmt::format("triangle hierarchy: {} boxes for {} instances", boxesAnchored.size(), instances_.size()));
  schedule_ = {};
  const auto isSameBox = [](const Box& one, const Box& other) { return one.min == other.min && one.max == other.max; };
  if (moved.empty() && std::equal(boxes_.begin(), boxes_.end(), boxesAnchored.begin(), boxesAnchored.end(), isSameBox))
    return;
  boxes_.assign(boxesAnchored.begin(), boxesAnchored.end());
  std::vector<RefitRow> rows, topRows;
  scheduleInstances(moved, rows);
  buildTop(boxesAnchored, topRows);
  schedule_.top = {static_cast<std::uint32_t>(rows.size()), topRows.empty() ? 0u : 1u};
  if (!topRows.empty()) {
    rows.push_back(makeRow(static_cast<std::uint32_t>(rows.size()) + 1, static_cast<std::uint32_t>(topRows.size())));
    rows.insert(rows.end(), topRows.begin(), topRows.end());
  }
  refit_.growTo(rows.size() * sizeof(RefitRow));
  refit_.upload(0, rows);
}

void TriangleHierarchy::scheduleInstances(std::span<const std::uint32_t> moved, std::vector<RefitRow>& rows) {
  std::uint32_t heights = 0;
  for (const std::uint32_t instance : moved) {
    if (instance >= instances_.size()) throw Failure(fmt::format("triangle hierarchy: no instance {}", instance));
    heights = std::max(heights, firstListHeight(trees_[instances_[instance].tree]));
  }
  for (std::uint32_t height = 0; height < heights; ++height) {
    const auto firstRow = static_cast<std::uint32_t>(rows.size());
    for (const std::uint32_t instance : moved) {
      const Placed& placed = instances_[instance];
      const HierarchyTree& tree = trees_[placed.tree];
      if (height >= firstListHeight(tree)) continue;
      for (std::uint32_t node = tree.heightBegin(height); node < tree.heightEnds[height]; node += shared::REFIT_GROUP)
        rows.push_back(makeRow(placed.firstNode + node, std::min(shared::REFIT_GROUP, tree.heightEnds[height] - node)));
    }
    schedule_.heights.push_back({firstRow, static_cast<std::uint32_t>(rows.size()) - firstRow});
  }
  std::vector<RefitRow> lists, listed;
  for (const std::uint32_t instance : moved) {
    const Placed& placed = instances_[instance];
    const HierarchyTree& tree = trees_[placed.tree];
    if (tree.heights() == 0) continue;
    schedule_.nodeCount += tree.heightEnds[0];
    const std::uint32_t first = firstListHeight(tree);
    if (first == tree.heights()) continue;
    lists.push_back(makeRow(static_cast<std::uint32_t>(listed.size()), tree.heights() - first));
    for (std::uint32_t height = first; height < tree.heights(); ++height)
      listed.push_back(
          makeRow(placed.firstNode + tree.heightBegin(height), tree.heightEnds[height] - tree.heightBegin(height)));
  }
  const auto firstList = static_cast<std::uint32_t>(rows.size());
  for (RefitRow& list : lists) list.nodes.x += firstList + static_cast<std::uint32_t>(lists.size());
  schedule_.lists = {firstList, static_cast<std::uint32_t>(lists.size())};
  rows.insert(rows.end(), lists.begin(), lists.end());
  rows.insert(rows.end(), listed.begin(), listed.end());
}

void TriangleHierarchy::buildTop(std::span<const Box> boxesAnchored, std::vector<RefitRow>& topRows) {
  std::vector<Box> boxes;
  std::vector<std::uint32_t> roots;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (boxesAnchored[i].isEmpty() || instances_[i].root == shared::HIERARCHY_NONE) continue;
    boxes.push_back(boxesAnchored[i]);
    roots.push_back(instances_[i].root);
  }
  const HierarchyTree top = buildHierarchyTree(boxes, {1, shared::HIERARCHY_TOP_LEVELS});
  const auto wordOf = [&](std::uint32_t word) {
    return word & shared::HIERARCHY_LEAF ? roots[top.order[word & shared::HIERARCHY_FIRST_MASK]] : word;
  };
  root_ = boxes.empty() ? shared::HIERARCHY_NONE : wordOf(top.root);
  std::vector<HierarchyNode> nodes;
  for (const HierarchyTree::Node& node : top.nodes) nodes.push_back(makeNode(wordOf(node.left), wordOf(node.right)));
  nodes_.upload(0, nodes);
  schedule_.nodeCount += nodes.size();
  for (std::uint32_t height = 0; height < top.heights(); ++height)
    topRows.push_back(makeRow(top.heightBegin(height), top.heightEnds[height] - top.heightBegin(height)));
}

void TriangleHierarchy::bind(Program& program, const Buffer& triangles) const {
  nodes_.bindStorage(shared::kHierarchyNodeBinding);
  order_.bindStorage(shared::kHierarchyOrderBinding);
  triangles.bindStorage(shared::kHierarchyTriangleBinding);
  program.set("hierarchyRoot", root_);
}

void TriangleHierarchy::bindRefit(const Buffer& triangles) const {
  nodes_.bindStorage(shared::kHierarchyNodeBinding);
  order_.bindStorage(shared::kHierarchyOrderBinding);
  triangles.bindStorage(shared::kHierarchyTriangleBinding);
  refit_.bindStorage(shared::kHierarchyRefitBinding);
}

} // namespace brickfield
