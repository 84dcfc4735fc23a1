// Solid angles of the fan's triangles by Van Oosterom and Strackee, The Solid Angle of a Plane Triangle, 1983. They are
// arguments of complex numbers; the product of those has the sum for its argument, up to whole turns, and one arc
// tangent does for all.
#include "bakers/rims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>

#include "bakers/float4.h"
#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

/// What sums over rim edges are.
struct FanSums {
  std::array<double, 4> real, imaginary; ///< lane by lane
  glm::dvec3 slope{0.0};                 ///< times 4 pi
};
struct StripSums {
  std::array<double, 4> real, imaginary; ///< lane by lane
  std::array<int, 4> turns;              ///< and whole turns
};
/// What loops make that count as dipoles, and which ones do not.
struct FarLoops {
  double flux = 0, spread = 0; ///< sums of area.r / r^3 and of area radius / away^3
  std::array<std::uint16_t, 512> near;
  std::size_t nearCount = 0;
};
struct FieldSums {
  glm::dvec3 slope{0.0}; ///< times 4 pi
  double inverseSquares = 0, inverseCubes = 0;
};

#define BRICKFIELD_SIMD_FILE "bakers/rim_sums.inl"
#include "bakers/each_simd.inl"

constexpr double kFourPi = 4.0 * std::numbers::pi;
constexpr double kSlackTurns = 1e-9; // over rounding
constexpr std::size_t kBundleQuads = 16;
constexpr double kFarRadii = 3;     // of a bundle: beyond, it counts as one edge where there are many
constexpr double kFarLoopRadii = 5; // of a loop: beyond, it makes less than 0.016 turns

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

/// Counts `balance` times from its low to its high vertex, or the other way where that is negative.
struct CountedEdge {
  std::uint32_t low, high;
  int balance;
};

std::vector<CountedEdge> unbalancedEdges(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  std::vector<CountedEdge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = soup.triangles[t][k], to = soup.triangles[t][(k + 1) % 3];
      edges.push_back(from < to ? CountedEdge{from, to, 1} : CountedEdge{to, from, -1});
    }
  std::sort(edges.begin(), edges.end(), [](const CountedEdge& a, const CountedEdge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  std::vector<CountedEdge> unbalanced;
  for (std::size_t i = 0; i < edges.size();) {
    CountedEdge sum{edges[i].low, edges[i].high, 0};
    for (; i < edges.size() && edges[i].low == sum.low && edges[i].high == sum.high; ++i)
      sum.balance += edges[i].balance;
    if (sum.balance != 0) unbalanced.push_back(sum);
  }
  return unbalanced;
}

struct DirectedEdge {
  std::uint32_t from, to;
};

/// Ascending by where they begin.
std::vector<DirectedEdge> rimEdges(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles) {
  std::vector<DirectedEdge> edges;
  for (const CountedEdge& edge : unbalancedEdges(soup, triangles))
    for (int i = 0; i < std::abs(edge.balance); ++i)
      edges.push_back(edge.balance > 0 ? DirectedEdge{edge.low, edge.high} : DirectedEdge{edge.high, edge.low});
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  return edges;
}

} // namespace

/// As many rim edges begin at a vertex as end there, so a walk can go on until it is back where it began.
Rims::Rims(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles)
    : frame_{soup.centerObject, soup.unitsPerMetre} {
  const std::vector<DirectedEdge> edges = rimEdges(soup, triangles);
  edgeCount_ = edges.size();
  if (edges.empty()) return;
  const auto firstFrom = [&](std::uint32_t vertex) {
    const auto isBefore = [](const DirectedEdge& edge, std::uint32_t v) { return edge.from < v; };
    return static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), vertex, isBefore) - edges.begin());
  };
  std::vector<bool> isWalked(edges.size(), false);
  std::vector<glm::dvec3> points;
  glm::dvec3 sum(0.0);
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (isWalked[start]) continue;
    points.assign(1, soup.positions[edges[start].from]);
    for (std::size_t edge = start;;) {
      isWalked[edge] = true;
      points.push_back(soup.positions[edges[edge].to]);
      sum += points.back();
      if (edges[edge].to == edges[start].from) break;
      edge = firstFrom(edges[edge].to);
      while (isWalked[edge]) ++edge;
    }
    addLoop(points);
  }
  if (areMany())
    bundleEdges();
  else
    gatherLoops();
  // Off the planes that modelled rims lie in: a point in a triangle of the fan has no side of it.
  apex_ = sum / static_cast<double>(edgeCount_) + soup.reach * glm::dvec3(0.0137, 0.0211, 0.0173);
}

/// points  the first once more at the end
void Rims::addLoop(const std::vector<glm::dvec3>& points) {
  const auto begin = static_cast<std::uint32_t>(edges_.size());
  const std::size_t last = points.size() - 1;
  glm::dvec3 low = points[0], high = points[0];
  for (const glm::dvec3 point : points) low = glm::min(low, point), high = glm::max(high, point);
  Loop loop{begin, begin, 0.5 * (low + high), 0, 0, glm::dvec3(0.0)};
  for (std::size_t first = 0; first < last; first += 4) {
    EdgeQuad& quad = edges_.emplace_back();
    for (std::size_t i = 0; i < 5; ++i)
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        const double metres = points[std::min(first + i, last)][axis] / frame_.unitsPerMetre;
        quad.points[axis][i] = static_cast<float>(metres + frame_.centerObject[axis]);
      }
  }
  for (std::size_t i = 0; i < last; ++i) {
    const glm::dvec3 from = points[i] - loop.center, to = points[i + 1] - loop.center;
    loop.radius = std::max(loop.radius, glm::length(from));
    loop.area += 0.5 * glm::length(glm::cross(from, to));
    loop.areaVector += 0.5 * glm::cross(from, to);
  }
  loop.end = static_cast<std::uint32_t>(edges_.size());
  if (!areMany()) loops_.push_back(loop);
}

void Rims::gatherLoops() {
  constexpr double kNowhere = 1e6; // along no ray that runs along an axis
  for (std::size_t first = 0; first < loops_.size(); first += 4) {
    LoopQuad& quad = loopQuads_.emplace_back();
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const bool isLoop = first + lane < loops_.size();
      const Loop loop = isLoop ? loops_[first + lane] : Loop{0, 0, glm::dvec3(kNowhere), 0, 0, glm::dvec3(0.0)};
      for (glm::length_t axis = 0; axis < 3; ++axis)
        quad.center[axis][lane] = loop.center[axis], quad.areaVector[axis][lane] = loop.areaVector[axis];
      quad.radius[lane] = loop.radius, quad.area[lane] = loop.area;
    }
  }
}

void Rims::bundleEdges() {
  for (std::size_t begin = 0; begin < edges_.size(); begin += kBundleQuads) {
    Bundle bundle{begin, std::min(begin + kBundleQuads, edges_.size()), {}, 0, 0, glm::dvec3(0.0)};
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (std::size_t i = bundle.begin; i < bundle.end; ++i)
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const glm::dvec3 from = point(i, lane), to = point(i, lane + 1);
        low = glm::min(low, glm::min(from, to)), high = glm::max(high, glm::max(from, to));
        bundle.length += glm::length(to - from);
        bundle.way += to - from;
      }
    bundle.center = 0.5 * (low + high), bundle.radius = 0.5 * glm::length(high - low);
    bundles_.push_back(bundle);
  }
}

namespace {

template <bool kWithSlope>
FanSums fanOf(std::span<const Rims::EdgeQuad> edges, const Rims::Frame& frame, glm::dvec3 apex, glm::dvec3 point) {
  FanSums sums;
  BRICKFIELD_BEST_SIMD(multiplyFan<kWithSlope>(edges, frame, apex, point, sums));
  return sums;
}

/// returns false where an edge comes into the ball
bool addFieldOf(std::span<const Rims::EdgeQuad> edges, const Rims::Frame& frame, glm::dvec3 point, double radius,
                FieldSums& sums) {
  return BRICKFIELD_BEST_SIMD(addField(edges, frame, point, radius, sums));
}

} // namespace

namespace {

StripSums stripsOf(std::span<const Rims::EdgeQuad> edges, const Rims::Frame& frame, const RayWinding::Ray& ray) {
  return BRICKFIELD_BEST_SIMD(multiplyStrips(edges, frame, ray));
}

FarLoops farLoopsOf(std::span<const Rims::LoopQuad> loops, const RayWinding::Ray& ray) {
  FarLoops far;
  BRICKFIELD_BEST_SIMD(sumFarLoops(loops, ray, kFarLoopRadii, far));
  return far;
}

void add(AngleSum& sum, const StripSums& strips) {
  for (std::size_t i = 0; i < 4; ++i) sum.add(strips.real[i], strips.imaginary[i]), sum.addTurns(strips.turns[i]);
}

} // namespace

double Rims::exactTurnsAlong(const RayWinding::Ray& ray) const {
  AngleSum sum;
  add(sum, stripsOf(edges_, frame_, ray));
  return sum.turns();
}

/// Off the ray no part of a far loop's strips is between its surface and the point: they look as that does. Pieces of
/// it are dipoles up to a radius from where they are counted, and those change by up to 2 / r^3 a way.
NearlyTurns Rims::turnsAlong(const RayWinding::Ray& ray) const {
  const FarLoops far = farLoopsOf(loopQuads_, ray);
  NearlyTurns nearly{far.flux / kFourPi, 2.0 * far.spread / kFourPi + kSlackTurns};
  AngleSum near;
  for (std::size_t i = 0; i < far.nearCount; ++i) {
    const Loop& loop = loops_[far.near[i]];
    add(near, stripsOf(std::span(edges_).subspan(loop.begin, loop.end - loop.begin), frame_, ray));
  }
  nearly.turns += near.turns();
  return nearly;
}

double Rims::fractionAt(glm::dvec3 point) const { return fractionOf(fanOf<false>(edges_, frame_, apex_, point)); }

WindingAround Rims::fractionAndSlopeAt(glm::dvec3 point) const {
  const FanSums sums = fanOf<true>(edges_, frame_, apex_, point);
  WindingAround around;
  around.fraction = fractionOf(sums);
  around.slope = sums.slope / kFourPi;
  return around;
}

/// Of a loop's surface all points are at least so far from the ball: the solid angle is at most its area by the square
/// of that, the slope twice that by the cube (a dipole's, along its axis).
std::optional<WindingAround> Rims::around(glm::dvec3 center, double radius) const {
  if (areMany()) return std::nullopt;
  WindingAround around;
  FieldSums near;
  for (const Loop& loop : loops_) {
    const double away = glm::length(loop.center - center) - radius - loop.radius;
    if (away > (kFarLoopRadii - 1) * loop.radius) {
      const double most = loop.area / (kFourPi * away * away);
      around.slack += most, around.slopeSlack += 2.0 * most / away;
      continue;
    }
    const std::span edges = std::span(edges_).subspan(loop.begin, loop.end - loop.begin);
    if (!addFieldOf(edges, frame_, center, radius, near)) return std::nullopt;
    around.fraction += fractionOf(fanOf<false>(edges, frame_, apex_, center));
  }
  around.fraction -= std::floor(around.fraction);
  around.slope = near.slope / kFourPi;
  around.bend = kFieldChange * near.inverseCubes / kFourPi;
  around.most = near.inverseSquares / kFourPi + around.slopeSlack;
  around.slack += kSlackTurns;
  return around;
}

Rims::Field Rims::fieldAt(glm::dvec3 point, double radius) const {
  Field field;
  FieldSums sums;
  const auto addEdges = [&](std::span<const EdgeQuad> edges) { return addFieldOf(edges, frame_, point, radius, sums); };
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
