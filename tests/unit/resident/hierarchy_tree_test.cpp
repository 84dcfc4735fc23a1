// The tree names every item once, keeps its promises of depth and order, and is worth its name.
#include "resident/hierarchy_tree.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {
namespace {

using shared::HIERARCHY_LEAF;

Box boxAt(glm::vec3 center, float size = 0.01f) { return {center - size, center + size}; }

std::vector<Box> randomBoxes(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-1, 1);
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) boxes.push_back(boxAt({place(random), place(random), place(random)}));
  return boxes;
}

struct Walked {
  std::uint32_t levels = 0;
  std::vector<int> timesNamed;
};

Walked walk(const HierarchyTree& tree, const HierarchyLimits& limits) {
  Walked result;
  result.timesNamed.assign(tree.order.size(), 0);
  std::function<void(std::uint32_t, std::uint32_t)> visit = [&](std::uint32_t word, std::uint32_t levels) {
    result.levels = std::max(result.levels, levels);
    if (word & HIERARCHY_LEAF) {
      const std::uint32_t first = word & shared::HIERARCHY_FIRST_MASK;
      const std::uint32_t count = (word >> shared::HIERARCHY_COUNT_SHIFT & 3u) + 1;
      EXPECT_LE(count, limits.leafItems);
      for (std::uint32_t i = first; i < first + count; ++i) ++result.timesNamed.at(tree.order.at(i));
      return;
    }
    for (const std::uint32_t child : {tree.nodes.at(word).left, tree.nodes.at(word).right}) {
      EXPECT_GT(child, word) << "leaves are above all nodes";
      visit(child, levels + 1);
    }
  };
  if (tree.root != shared::HIERARCHY_NONE) visit(tree.root, 0);
  return result;
}

void expectSound(const HierarchyTree& tree, std::size_t items, const HierarchyLimits& limits = {}) {
  ASSERT_EQ(tree.order.size(), items);
  const Walked walked = walk(tree, limits);
  EXPECT_LE(walked.levels, limits.levels);
  EXPECT_EQ(walked.timesNamed, std::vector<int>(items, 1));
  if (tree.nodes.empty()) return;
  // Heights, from the lowest: a node's children are of lower ones, and one of the next lower.
  std::vector<std::uint32_t> heightOf(tree.nodes.size());
  std::uint32_t counted = 0;
  for (std::uint32_t height = 0; height < tree.heights(); ++height)
    for (std::uint32_t node = tree.heightBegin(height); node < tree.heightEnds[height]; ++node, ++counted)
      heightOf[node] = height;
  EXPECT_EQ(counted, tree.nodes.size());
  for (std::uint32_t node = 0; node < tree.nodes.size(); ++node) {
    std::uint32_t expected = 0;
    for (const std::uint32_t child : {tree.nodes[node].left, tree.nodes[node].right})
      if (!(child & HIERARCHY_LEAF)) expected = std::max(expected, heightOf[child] + 1);
    EXPECT_EQ(heightOf[node], expected) << node;
  }
  EXPECT_EQ(tree.root, 0u);
}

TEST(HierarchyTree, NamesEveryItemOnce) {
  for (const int count : {1, 2, 3, 4, 5, 9, 100, 5000})
    expectSound(buildHierarchyTree(randomBoxes(count)), static_cast<std::size_t>(count));
}

TEST(HierarchyTree, OfNothingIsNothing) {
  const HierarchyTree tree = buildHierarchyTree(std::vector<Box>());
  EXPECT_EQ(tree.root, shared::HIERARCHY_NONE);
  EXPECT_TRUE(tree.nodes.empty());
}

TEST(HierarchyTree, KeepsItemsThatAreNoBoxes) {
  std::vector<Box> boxes = randomBoxes(20);
  boxes[3] = {};
  boxes[7].max.y = std::numeric_limits<float>::quiet_NaN();
  boxes[8].min.x = -std::numeric_limits<float>::infinity();
  expectSound(buildHierarchyTree(boxes), boxes.size());
}

TEST(HierarchyTree, ItemsInOnePlaceAreHalved) {
  const HierarchyTree tree = buildHierarchyTree(std::vector<Box>(1000, boxAt({1, 2, 3})));
  expectSound(tree, 1000);
  EXPECT_EQ(walk(tree, {}).levels, 8u); // 1000 / 4 leaves of four
}

// Every item is as far from zero as all before it together: the heuristic peels off one or two at a time.
TEST(HierarchyTree, LevelsAreLimitedWhereTheHeuristicPeels) {
  std::vector<Box> boxes;
  for (int i = 0; i < 120; ++i) boxes.push_back(boxAt({std::ldexp(1.0f, i - 60), 0, 0}, std::ldexp(1.0f, i - 65)));
  EXPECT_GT(walk(buildHierarchyTree(boxes), {}).levels, 10u);
  for (const HierarchyLimits limits : {HierarchyLimits{4, 5}, HierarchyLimits{4, 7}, HierarchyLimits{1, 7}})
    expectSound(buildHierarchyTree(boxes, limits), boxes.size(), limits);
}

TEST(HierarchyTree, MoreThanTheLevelsHoldIsRefused) {
  EXPECT_NO_THROW(buildHierarchyTree(randomBoxes(64), {4, 4}));
  EXPECT_THROW(buildHierarchyTree(randomBoxes(65), {4, 4}), BadInput);
}

TEST(HierarchyTree, TopHasOneItemALeaf) { expectSound(buildHierarchyTree(randomBoxes(300), {1, 20}), 300, {1, 20}); }

/// What a random ray pays, by the heuristic's own measure.
double costOf(const HierarchyTree& tree, const std::vector<Box>& boxes) {
  const auto area = [](const Box& box) {
    const glm::vec3 e = box.extent();
    return double{e.x} * e.y + double{e.y} * e.z + double{e.z} * e.x;
  };
  double cost = 0;
  std::function<Box(std::uint32_t)> visit = [&](std::uint32_t word) {
    Box box;
    if (word & HIERARCHY_LEAF) {
      const std::uint32_t first = word & shared::HIERARCHY_FIRST_MASK;
      const std::uint32_t count = (word >> shared::HIERARCHY_COUNT_SHIFT & 3u) + 1;
      for (std::uint32_t i = first; i < first + count; ++i) box.extend(boxes[tree.order[i]]);
      cost += area(box) * count;
    } else {
      box = visit(tree.nodes[word].left);
      box.extend(visit(tree.nodes[word].right));
      cost += area(box);
    }
    return box;
  };
  const Box whole = visit(tree.root);
  return cost / area(whole);
}

// A dense cluster in a sparse cloud: halving cuts through it, the heuristic around it.
TEST(HierarchyTree, CostsLessThanHalving) {
  std::vector<Box> boxes = randomBoxes(300);
  for (const Box& box : randomBoxes(5000)) boxes.push_back(boxAt(box.center() * 0.02f + 0.5f, 0.0002f));
  // With exactly as many levels as needed there is never one to spare, and everything is halved.
  const double halved = costOf(buildHierarchyTree(boxes, {4, 11}), boxes);
  EXPECT_LT(costOf(buildHierarchyTree(boxes), boxes), 0.8 * halved);
}

} // namespace
} // namespace brickfield
