// Solid angles by Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983.
//
// The expansion. A piece of area n at x adds n.(x-p) / |x-p|^3. With r = center - p and d = x - center, in powers of d:
//   n.r / r^3
//   n.d / r^3 - 3 (n.r)(d.r) / r^5
//   15/2 (n.r)(d.r)^2 / r^7 - 3/2 [2 (n.d)(d.r) + (n.r)(d.d)] / r^5
// Sums of n, n d' and n d d' over a cluster replace its pieces. On a curved patch the second and the third line are of
// the same size and opposite sign: the second alone makes matters worse than the first.
#include "bakers/winding_number.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include <tbb/parallel_for.h>

#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

constexpr float kNothingIsFar = 1e15f; // its square is finite in float
constexpr int kParallelDepth = 2;      // nodes above it gather their children on all threads
constexpr float kNowhere = 1e12f;      // its cube is finite in float: an absent cluster's zeros stay zeros

// The ten products of three coordinates of r.
constexpr std::array<std::array<std::size_t, 3>, 10> kMonomials = {
    {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 1}, {0, 1, 2}, {0, 2, 2}, {1, 1, 1}, {1, 1, 2}, {1, 2, 2}, {2, 2, 2}}};

/// Which of them is r_i r_j r_k.
constexpr auto kMonomialOf = [] {
  std::array<std::array<std::array<std::size_t, 3>, 3>, 3> monomialOf{};
  for (std::size_t m = 0; m < kMonomials.size(); ++m)
    for (std::size_t order = 0; order < 6; ++order) {
      const std::size_t i = order % 3, j = (i + 1 + order / 3) % 3, k = 3 - i - j;
      monomialOf[kMonomials[m][i]][kMonomials[m][j]][kMonomials[m][k]] = m;
    }
  return monomialOf;
}();

#define BRICKFIELD_SIMD_FILE "bakers/winding_walk.inl"
#include "bakers/each_simd.inl"

} // namespace

/// Sums over the triangles of a subtree, about zero.
struct WindingNumber::Cluster {
  double area = 0;
  glm::dvec3 areaNormal{0.0};
  glm::dvec3 weightedCentroid{0.0};
  glm::dmat3 first{0.0};                                                               ///< [j][i]: n_i x_j
  std::array<glm::dmat3, 3> second{glm::dmat3(0.0), glm::dmat3(0.0), glm::dmat3(0.0)}; ///< [i]: n_i x x'
  Box bounds;

  void add(const std::array<glm::dvec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 n = 0.5 * glm::cross(b - a, c - a), centroid = (a + b + c) / 3.0;
    // Mean of x x' over a triangle.
    const glm::dmat3 square = (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
                               9.0 * glm::outerProduct(centroid, centroid)) /
                              12.0;
    area += glm::length(n);
    areaNormal += n;
    weightedCentroid += glm::length(n) * centroid;
    first += glm::outerProduct(n, centroid);
    for (glm::length_t i = 0; i < 3; ++i) second[static_cast<std::size_t>(i)] += n[i] * square;
    for (const glm::dvec3& corner : corners) bounds.extend(glm::vec3(corner));
  }
  void add(const Cluster& part) {
    area += part.area;
    areaNormal += part.areaNormal;
    weightedCentroid += part.weightedCentroid;
    first += part.first;
    for (std::size_t i = 0; i < 3; ++i) second[i] += part.second[i];
    bounds.extend(part.bounds);
  }
  /// Moves the moments from zero to the centre.
  void centre() {
    const glm::dvec3 c = weightedCentroid / area;
    for (glm::length_t i = 0; i < 3; ++i) {
      const glm::dvec3 firstOfAxis(first[0][i], first[1][i], first[2][i]);
      second[static_cast<std::size_t>(i)] += areaNormal[i] * glm::outerProduct(c, c) -
                                             glm::outerProduct(firstOfAxis, c) - glm::outerProduct(c, firstOfAxis);
    }
    first -= glm::outerProduct(areaNormal, c);
    weightedCentroid = c;
  }
};

WindingNumber::WindingNumber(const MeshHierarchy& hierarchy) : hierarchy_(&hierarchy) {
  moments_.resize(hierarchy.nodes().size());
  gather(hierarchy.root(), 0);
}

WindingNumber::Cluster WindingNumber::gather(HierarchyChild child, int depth) {
  Cluster sum;
  if (child.isLeaf()) {
    const HierarchyLeaf& leaf = hierarchy_->leaves()[child.index()];
    for (std::size_t i = 0; i < leaf.count(); ++i) sum.add(hierarchy_->soup().corners(leaf.triangles[i]));
    return sum;
  }
  const HierarchyNode& node = hierarchy_->nodes()[child.index()];
  std::array<Cluster, kHierarchyWidth> parts;
  const auto gatherPart = [&](std::size_t i) {
    if (!node.children[i].isNone()) parts[i] = gather(node.children[i], depth + 1);
  };
  if (depth < kParallelDepth)
    tbb::parallel_for(std::size_t{0}, kHierarchyWidth, gatherPart);
  else
    for (std::size_t i = 0; i < kHierarchyWidth; ++i) gatherPart(i);
  for (std::size_t i = 0; i < kHierarchyWidth; ++i) {
    moments_[child.index()].center.setLane(i, glm::vec3(kNowhere));
    if (node.children[i].isNone()) continue;
    sum.add(parts[i]);
    parts[i].centre();
    setLane(moments_[child.index()], i, parts[i]);
  }
  return sum;
}

void WindingNumber::setLane(WindingMoments& moments, std::size_t lane, const Cluster& cluster) {
  const glm::vec3 center(cluster.weightedCentroid);
  const glm::vec3 toCorner = glm::max(cluster.bounds.max - center, center - cluster.bounds.min);
  moments.center.setLane(lane, center);
  moments.areaNormal.setLane(lane, glm::vec3(cluster.areaNormal));
  moments.radiusSquared.setLane(lane, glm::dot(toCorner, toCorner));
  const glm::dmat3& m = cluster.first;
  moments.spread.setLane(lane, {m[0][0], m[1][1], m[2][2]});
  moments.shear.setLane(lane, {m[0][1] + m[1][0], m[1][2] + m[2][1], m[2][0] + m[0][2]});
  std::array<double, kMonomials.size()> cubics{};
  glm::dvec3 trace(0.0);
  for (glm::length_t i = 0; i < 3; ++i)
    for (glm::length_t j = 0; j < 3; ++j) {
      const auto& products = kMonomialOf[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      for (glm::length_t k = 0; k < 3; ++k)
        cubics[products[static_cast<std::size_t>(k)]] += cluster.second[static_cast<std::size_t>(i)][j][k];
      trace[j] += 2.0 * cluster.second[static_cast<std::size_t>(i)][i][j];
      trace[i] += cluster.second[static_cast<std::size_t>(i)][j][j];
    }
  for (std::size_t i = 0; i < cubics.size(); ++i) moments.cubics[i].setLane(lane, static_cast<float>(cubics[i]));
  moments.cubicTrace.setLane(lane, glm::vec3(trace));
}

float WindingNumber::at(glm::dvec3 point) const { return turns(point, kFarRadii); }

float WindingNumber::exactlyAt(glm::dvec3 point) const { return turns(point, kNothingIsFar); }

float WindingNumber::turns(glm::dvec3 point, float farRadii) const {
  const glm::vec3 p(point);
  const double whole = 4.0 * std::numbers::pi;
  return static_cast<float>(BRICKFIELD_BEST_SIMD(solidAngle(*hierarchy_, moments_.data(), p, farRadii)) / whole);
}

} // namespace brickfield
