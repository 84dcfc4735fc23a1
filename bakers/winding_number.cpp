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
#include <cmath>
#include <numbers>

namespace brickfield {

namespace {

// A cluster is far beyond this many radii of the ball around its box: what Barill et al. advise for three terms.
constexpr float kFarRadii = 2.0f;
constexpr float kNowhere = 1e12f; // its cube is finite in float: an absent cluster's zeros stay zeros

// The ten products of three coordinates of r.
constexpr std::array<std::array<std::size_t, 3>, 10> kMonomials = {
    {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 1}, {0, 1, 2}, {0, 2, 2}, {1, 1, 1}, {1, 1, 2}, {1, 2, 2}, {2, 2, 2}}};

std::size_t monomialOf(glm::length_t i, glm::length_t j, glm::length_t k) {
  std::array<std::size_t, 3> sorted = {static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                                       static_cast<std::size_t>(k)};
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(std::find(kMonomials.begin(), kMonomials.end(), sorted) - kMonomials.begin());
}

/// Eight solid angles, or rather their tangents' two sides: tan(angle / 2) = numerator / denominator.
float solidAngles(const HierarchyLeaf& leaf, glm::vec3 point) {
  Float8 numerators, denominators;
  const Vector4 p = broadcast(point);
  for (std::size_t h = 0; h < 2; ++h) {
    const Vector4 ab = leaf.ab.half(h), ac = leaf.ac.half(h), normal = leaf.normal.half(h);
    const Vector4 a = leaf.a.half(h) - p;
    const Vector4 b{a.x + ab.x, a.y + ab.y, a.z + ab.z}, c{a.x + ac.x, a.y + ac.y, a.z + ac.z};
    Float4 lengthA = dot(a, a), lengthB = dot(b, b), lengthC = dot(c, c);
    for (std::size_t i = 0; i < 4; ++i)
      lengthA[i] = std::sqrt(lengthA[i]), lengthB[i] = std::sqrt(lengthB[i]), lengthC[i] = std::sqrt(lengthC[i]);
    // The triple product a.(b x c) as height times area: close to the plane it keeps its sign that way.
    numerators.halves[h] = dot(a, normal) * dot(cross(ab, ac), normal);
    denominators.halves[h] =
        lengthA * lengthB * lengthC + dot(a, b) * lengthC + dot(b, c) * lengthA + dot(c, a) * lengthB;
  }
  float sum = 0;
  for (std::size_t i = 0; i < leaf.count; ++i) sum += std::atan2(numerators.lane(i), denominators.lane(i));
  return 2.0f * sum;
}

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
  dipoles_.resize(hierarchy.nodes().size());
  gather(hierarchy.root());
}

WindingNumber::Cluster WindingNumber::gather(HierarchyChild child) {
  Cluster sum;
  if (child.isLeaf()) {
    const HierarchyLeaf& leaf = hierarchy_->leaves()[child.index()];
    for (std::size_t i = 0; i < leaf.count; ++i) sum.add(hierarchy_->soup().corners(leaf.triangles[i]));
    return sum;
  }
  const HierarchyNode& node = hierarchy_->nodes()[child.index()];
  for (std::size_t i = 0; i < kHierarchyWidth; ++i) {
    dipoles_[child.index()].center.setLane(i, glm::vec3(kNowhere));
    if (node.children[i].isNone()) continue;
    Cluster part = gather(node.children[i]);
    sum.add(part);
    part.centre();
    setLane(dipoles_[child.index()], i, part);
  }
  return sum;
}

void WindingNumber::setLane(Dipoles& dipoles, std::size_t lane, const Cluster& cluster) {
  const glm::vec3 center(cluster.weightedCentroid);
  const glm::vec3 toCorner = glm::max(cluster.bounds.max - center, center - cluster.bounds.min);
  dipoles.center.setLane(lane, center);
  dipoles.areaNormal.setLane(lane, glm::vec3(cluster.areaNormal));
  dipoles.radiusSquared.setLane(lane, glm::dot(toCorner, toCorner));
  const glm::dmat3& m = cluster.first;
  dipoles.spread.setLane(lane, {m[0][0], m[1][1], m[2][2]});
  dipoles.shear.setLane(lane, {m[0][1] + m[1][0], m[1][2] + m[2][1], m[2][0] + m[0][2]});
  std::array<double, kMonomials.size()> cubics{};
  glm::dvec3 trace(0.0);
  for (glm::length_t i = 0; i < 3; ++i)
    for (glm::length_t j = 0; j < 3; ++j) {
      for (glm::length_t k = 0; k < 3; ++k)
        cubics[monomialOf(i, j, k)] += cluster.second[static_cast<std::size_t>(i)][j][k];
      trace[j] += 2.0 * cluster.second[static_cast<std::size_t>(i)][i][j];
      trace[i] += cluster.second[static_cast<std::size_t>(i)][j][j];
    }
  for (std::size_t i = 0; i < cubics.size(); ++i) dipoles.cubics[i].setLane(lane, static_cast<float>(cubics[i]));
  dipoles.cubicTrace.setLane(lane, glm::vec3(trace));
}

Float4 WindingNumber::farSolidAngles(const Dipoles& dipoles, std::size_t half, const Vector4& r, Float4 rSquared) {
  const Vector4 spread = dipoles.spread.half(half), shear = dipoles.shear.half(half);
  const Float4 xx = r.x * r.x, yy = r.y * r.y, zz = r.z * r.z;
  const Float4 quadratic = dot(spread, {xx, yy, zz}) + dot(shear, {r.x * r.y, r.y * r.z, r.z * r.x});
  const auto c = [&](std::size_t i) { return dipoles.cubics[i].halves[half]; }; // in the order of kMonomials
  const Float4 cubic = r.x * (c(0) * xx + c(3) * yy + c(5) * zz + r.y * (c(1) * r.x + c(4) * r.z) + c(2) * r.x * r.z) +
                       r.y * (c(6) * yy + c(8) * zz + c(7) * r.y * r.z) + c(9) * zz * r.z;
  const Float4 oneOverRSquared = broadcast(1.0f) / rSquared;
  Float4 oneOverR;
  for (std::size_t i = 0; i < 4; ++i) oneOverR[i] = std::sqrt(oneOverRSquared[i]);
  const Float4 third =
      broadcast(7.5f) * cubic * oneOverRSquared - broadcast(1.5f) * dot(dipoles.cubicTrace.half(half), r);
  const Float4 second = spread.x + spread.y + spread.z + (third - broadcast(3.0f) * quadratic) * oneOverRSquared;
  return (dot(dipoles.areaNormal.half(half), r) + second) * (oneOverRSquared * oneOverR);
}

float WindingNumber::at(glm::dvec3 point) const {
  const glm::vec3 p(point);
  const Vector4 p4 = broadcast(p);
  std::array<HierarchyChild, 64 * kHierarchyWidth> stack;
  std::size_t size = 0;
  stack[size++] = hierarchy_->root();
  double sum = 0;
  while (size > 0) {
    const HierarchyChild top = stack[--size];
    if (top.isLeaf()) {
      sum += static_cast<double>(solidAngles(hierarchy_->leaves()[top.index()], p));
      continue;
    }
    const Dipoles& dipoles = dipoles_[top.index()];
    const HierarchyNode& node = hierarchy_->nodes()[top.index()];
    for (std::size_t h = 0; h < 2; ++h) {
      const Vector4 r = dipoles.center.half(h) - p4;
      const Float4 rSquared = dot(r, r);
      const Float4 nearSquared = broadcast(kFarRadii * kFarRadii) * dipoles.radiusSquared.halves[h];
      bool anyFar = false;
      for (std::size_t i = 0; i < 4; ++i) anyFar |= rSquared[i] > nearSquared[i];
      const Float4 far = anyFar ? farSolidAngles(dipoles, h, r, rSquared) : broadcast(0.0f);
      for (std::size_t i = 0; i < 4; ++i) {
        const HierarchyChild child = node.children[4 * h + i];
        if (rSquared[i] > nearSquared[i])
          sum += static_cast<double>(far[i]);
        else if (!child.isNone())
          stack[size++] = child;
      }
    }
  }
  return static_cast<float>(sum / (4.0 * std::numbers::pi));
}

} // namespace brickfield
