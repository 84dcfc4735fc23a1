// Solid angles of the fan's triangles by Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983. They are
// arguments of complex numbers; the product of those has the sum for its argument, up to whole turns, and one arc
// tangent does for all.
#include "bakers/rims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

/// What walks over rim edges find.
struct FanSums {
  std::array<double, 4> real, imaginary; ///< lane by lane
};
struct FieldSums {
  glm::dvec3 slope{0.0}; ///< times 4 pi
  double inverseSquares = 0, inverseCubes = 0;
};

namespace portable {
#include "bakers/rim_walk.inl"
}
#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2")
namespace avx2 {
#include "bakers/rim_walk.inl"
}
#pragma GCC pop_options
#endif

constexpr double kFourPi = 4.0 * std::numbers::pi;
// By how much t x r / r^3 changes a unit of way, times r^3: |t x v - 3 (t x r)(r.v)| for unit vectors is at most 2
// along r and 1 across it.
constexpr double kFieldChange = 2.2360680;
constexpr double kSlackTurns = 1e-9; // over rounding
constexpr std::size_t kBundleQuads = 16;
constexpr double kFarRadii = 3; // of a bundle: beyond, it counts as one edge where there are many

double fractionOf(const FanSums& sums) {
  double real = 1, imaginary = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double product = real * sums.real[i] - imaginary * sums.imaginary[i];
    imaginary = real * sums.imaginary[i] + imaginary * sums.real[i];
    real = product;
  }
  const double turns = std::atan2(imaginary, real) / (2.0 * std::numbers::pi);
  return turns < 0 ? turns + 1.0 : turns;
}

/// Where a to b counts as often as it is walked more often than b to a.
struct DirectedEdge {
  std::uint32_t low, high;
  int balance;
};

std::vector<DirectedEdge> unbalancedEdges(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = soup.triangles[t][k], to = soup.triangles[t][(k + 1) % 3];
      edges.push_back(from < to ? DirectedEdge{from, to, 1} : DirectedEdge{to, from, -1});
    }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  std::vector<DirectedEdge> unbalanced;
  for (std::size_t i = 0; i < edges.size();) {
    DirectedEdge sum{edges[i].low, edges[i].high, 0};
    for (; i < edges.size() && edges[i].low == sum.low && edges[i].high == sum.high; ++i)
      sum.balance += edges[i].balance;
    if (sum.balance != 0) unbalanced.push_back(sum);
  }
  return unbalanced;
}

} // namespace

Rims::Rims(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  const auto setLane = [&](glm::dvec3 from, glm::dvec3 to, std::size_t lane) {
    for (glm::length_t axis = 0; axis < 3; ++axis)
      edges_.back().from[axis][lane] = from[axis], edges_.back().to[axis][lane] = to[axis];
  };
  glm::dvec3 sum(0.0);
  for (const DirectedEdge& edge : unbalancedEdges(soup, triangles)) {
    glm::dvec3 from = soup.positions[edge.low], to = soup.positions[edge.high];
    if (edge.balance < 0) std::swap(from, to);
    for (int i = 0; i < std::abs(edge.balance); ++i) {
      const std::size_t lane = edgeCount_++ % 4;
      if (lane == 0) edges_.emplace_back();
      for (std::size_t other = lane; other < 4; ++other) setLane(from, other == lane ? to : from, other);
      sum += from;
    }
  }
  // Off the planes that modelled rims lie in: a point in a triangle of the fan has no side of it.
  if (areMany()) bundleEdges();
  if (edgeCount_ > 0) apex_ = sum / static_cast<double>(edgeCount_) + soup.reach * glm::dvec3(0.0137, 0.0211, 0.0173);
}

void Rims::bundleEdges() {
  for (std::size_t begin = 0; begin < edges_.size(); begin += kBundleQuads) {
    Bundle bundle{begin, std::min(begin + kBundleQuads, edges_.size()), {}, 0, 0, glm::dvec3(0.0)};
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (std::size_t i = bundle.begin; i < bundle.end; ++i)
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const EdgeQuad& edge = edges_[i];
        const glm::dvec3 from(edge.from[0][lane], edge.from[1][lane], edge.from[2][lane]);
        const glm::dvec3 to(edge.to[0][lane], edge.to[1][lane], edge.to[2][lane]);
        low = glm::min(low, glm::min(from, to)), high = glm::max(high, glm::max(from, to));
        bundle.length += glm::length(to - from);
        bundle.way += to - from;
      }
    bundle.center = 0.5 * (low + high), bundle.radius = 0.5 * glm::length(high - low);
    bundles_.push_back(bundle);
  }
}

double Rims::fractionAt(glm::dvec3 point) const {
  FanSums sums;
#if defined(__x86_64__)
  if (activeSimd() == SimdLevel::Avx2) {
    avx2::multiplyFan(edges_, apex_, point, sums);
    return fractionOf(sums);
  }
#endif
  portable::multiplyFan(edges_, apex_, point, sums);
  return fractionOf(sums);
}

Rims::Field Rims::fieldAt(glm::dvec3 point, double radius) const {
  Field field;
  FieldSums sums;
  const auto addEdges = [&](std::span<const EdgeQuad> edges) {
#if defined(__x86_64__)
    if (activeSimd() == SimdLevel::Avx2) return avx2::addField(edges, point, radius, sums);
#endif
    return portable::addField(edges, point, radius, sums);
  };
  if (areMany()) {
    for (const Bundle& bundle : bundles_) {
      const glm::dvec3 r = bundle.center - point;
      const double distance = glm::length(r), away = distance - bundle.radius - radius;
      if (away > (kFarRadii - 1) * bundle.radius) {
        sums.slope += glm::cross(bundle.way, -r) / (distance * distance * distance);
        sums.inverseSquares += bundle.length / (away * away);
      } else if (!addEdges(std::span(edges_).subspan(bundle.begin, bundle.end - bundle.begin))) {
        field.isClear = false;
        return field;
      }
    }
  } else {
    field.isClear = addEdges(edges_);
  }
  field.slope = sums.slope / kFourPi;
  field.inverseSquares = sums.inverseSquares, field.inverseCubes = sums.inverseCubes;
  return field;
}

double Rims::mostChange(glm::dvec3 center, double radius) const {
  const Field field = fieldAt(center, radius);
  if (!field.isClear) return HUGE_VAL;
  // By the steepest slope in the ball, or by the slope at its centre and how fast slopes change in it.
  const double bySlopes = field.inverseSquares * radius / kFourPi;
  const double byCenter =
      glm::length(field.slope) * radius + 0.5 * kFieldChange * field.inverseCubes * radius * radius / kFourPi;
  return (areMany() ? bySlopes : std::min(bySlopes, byCenter)) + kSlackTurns;
}

} // namespace brickfield
