// All 256 signs of a cell: every crossed edge in one loop, loops along faces, outside on the left; faces read alike
// from both sides.
#include "field/cube_loops.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

glm::dvec3 cornerPoint(std::size_t corner) {
  return {static_cast<double>(corner & 1), static_cast<double>(corner >> 1 & 1), static_cast<double>(corner >> 2)};
}
glm::dvec3 middleOf(int edge) {
  const auto [low, high] = cornersOfEdge(edge);
  return 0.5 * (cornerPoint(low) + cornerPoint(high));
}
/// Faces that hold an edge: axis, and 3 more for the upper side.
std::set<int> facesOf(int edge) {
  const glm::dvec3 middle = middleOf(edge);
  std::set<int> faces;
  for (int axis = 0; axis < 3; ++axis) {
    if (middle[axis] == 0) faces.insert(axis);
    if (middle[axis] == 1) faces.insert(axis + 3);
  }
  return faces;
}
bool shareFace(int a, int b) {
  const std::set<int> of = facesOf(b);
  const std::set<int> from = facesOf(a);
  return std::any_of(from.begin(), from.end(), [&](int face) { return of.contains(face); });
}
bool isCrossed(const VoxelCorners& corners, int edge) {
  const auto [low, high] = cornersOfEdge(edge);
  return (corners[low] < 0) != (corners[high] < 0);
}
/// Random magnitudes, so that faces with two readings are read both ways.
VoxelCorners cornersOf(int signs, Random& random) {
  VoxelCorners corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = (signs >> i & 1 ? -1.0 : 1.0) * random.between(0.01f, 1.0f);
  return corners;
}

TEST(CubeLoops, EdgesAreThoseOfACube) {
  std::set<std::pair<std::size_t, std::size_t>> edges;
  for (int edge = 0; edge < kCubeEdges; ++edge) {
    const auto [low, high] = cornersOfEdge(edge);
    EXPECT_EQ(high - low, std::size_t{1} << edge / 4);
    EXPECT_EQ(facesOf(edge).size(), 2u);
    edges.emplace(low, high);
  }
  EXPECT_EQ(edges.size(), 12u);
}

TEST(CubeLoops, HoldEveryCrossedEdgeOnceAndRunAlongFaces) {
  Random random(1);
  for (int signs = 0; signs < 256; ++signs)
    for (int round = 0; round < 20; ++round) {
      const VoxelCorners corners = cornersOf(signs, random);
      const CubeLoops loops = findCubeLoops(corners);
      std::multiset<int> seen;
      std::size_t begin = 0;
      for (std::size_t loop = 0; loop < loops.count; ++loop) {
        const std::size_t length = loops.lengths[loop];
        ASSERT_GE(length, 3u);
        for (std::size_t i = 0; i < length; ++i) {
          const int edge = loops.edges[begin + i], next = loops.edges[begin + (i + 1) % length];
          seen.insert(edge);
          EXPECT_TRUE(shareFace(edge, next)) << signs;
          if (length == 4) {
            EXPECT_FALSE(shareFace(edge, loops.edges[begin + (i + 2) % 4])) << signs;
          }
        }
        begin += length;
      }
      for (int edge = 0; edge < kCubeEdges; ++edge)
        EXPECT_EQ(seen.count(edge), isCrossed(corners, edge) ? 1u : 0u) << signs;
    }
}

TEST(CubeLoops, TurnCounterClockwiseSeenFromOutside) {
  for (std::size_t corner = 0; corner < 8; ++corner) {
    VoxelCorners corners;
    corners.fill(1.0);
    corners[corner] = -1.0;
    for (const double side : {1.0, -1.0}) {
      for (double& value : corners) value *= side;
      const CubeLoops loops = findCubeLoops(corners);
      ASSERT_EQ(loops.count, 1u);
      ASSERT_EQ(loops.lengths[0], 3);
      const glm::dvec3 a = middleOf(loops.edges[0]), b = middleOf(loops.edges[1]), c = middleOf(loops.edges[2]);
      EXPECT_GT(side * glm::dot(glm::cross(b - a, c - a), a - cornerPoint(corner)), 0.0) << corner;
      for (double& value : corners) value *= side;
    }
  }
}

/// Steps of the loops within a face, as pairs of edges' middles.
std::multiset<std::array<double, 6>> stepsIn(const VoxelCorners& corners, int face, glm::dvec3 offset, bool isTurned) {
  std::multiset<std::array<double, 6>> steps;
  const CubeLoops loops = findCubeLoops(corners);
  std::size_t begin = 0;
  for (std::size_t loop = 0; loop < loops.count; ++loop) {
    const std::size_t length = loops.lengths[loop];
    for (std::size_t i = 0; i < length; ++i) {
      const int from = loops.edges[begin + i], to = loops.edges[begin + (i + 1) % length];
      if (!facesOf(from).contains(face) || !facesOf(to).contains(face)) continue;
      const glm::dvec3 a = middleOf(isTurned ? to : from) + offset, b = middleOf(isTurned ? from : to) + offset;
      steps.insert({a.x, a.y, a.z, b.x, b.y, b.z});
    }
    begin += length;
  }
  return steps;
}

TEST(CubeLoops, NeighboursWalkTheirCommonFaceAgainstEachOther) {
  Random random(2);
  for (int round = 0; round < 20000; ++round) {
    const int axis = round % 3;
    VoxelCorners below = cornersOf(static_cast<int>(random.bits() & 0xff), random);
    VoxelCorners above = cornersOf(static_cast<int>(random.bits() & 0xff), random);
    for (std::size_t i = 0; i < 8; ++i)
      if (i >> axis & 1) above[i & ~(std::size_t{1} << axis)] = below[i];
    glm::dvec3 offset(0.0);
    offset[axis] = 1;
    EXPECT_EQ(stepsIn(below, axis + 3, glm::dvec3(0.0), false), stepsIn(above, axis, offset, true));
  }
}

TEST(CubeLoops, FaceWithTwoReadingsFollowsItsSaddle) {
  // Corners 0 and 3 of the face z = 0 inside; all others outside.
  const auto loopCount = [](double inside) {
    VoxelCorners corners;
    corners.fill(1.0);
    corners[0] = corners[3] = -inside;
    return findCubeLoops(corners).count;
  };
  EXPECT_EQ(loopCount(0.9), 2u) << "the face's saddle lies outside: two corners by themselves";
  EXPECT_EQ(loopCount(1.1), 1u) << "the saddle lies inside: they hang together";
}

} // namespace
} // namespace brickfield
