// The rims of open triangles: edges that are walked more often in one direction than in the other. They alone decide
// the winding number up to whole turns: any other triangles with the same rims, as a fan from one point to each rim
// edge, differ from these by a closed surface. So away from rims the winding number changes smoothly but for whole
// turns across triangles, with the slope that Biot and Savart's law gives for a current along the rims.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "bakers/ray_winding.h"

namespace brickfield {

/// How the winding number goes on around a point, in a ball, where no triangle is crossed: d away it is
/// fraction + slope.d to slack + bend d^2 / 2, and its slope is that to slopeSlack + bend d, and no steeper than most.
struct WindingAround {
  double fraction = 0;   ///< at the point, less some whole number: 0 to 1
  glm::dvec3 slope{0.0}; ///< turns per unit of soup space
  double bend = 0;
  double most = HUGE_VAL;
  double slack = 0, slopeSlack = 0; ///< what far rims may add

  double at(glm::dvec3 offset) const { return fraction + glm::dot(slope, offset); }
  /// Of a ball at an offset: its points' numbers keep at least so far from one half and all whole turns more. Negative
  /// where they may not.
  double leastFromHalf(glm::dvec3 offset, double radius) const {
    const double far = glm::length(offset) + radius;
    const double byLine = fromHalf(at(offset)) - glm::length(slope) * radius - 0.5 * bend * far * far;
    return std::max(byLine, fromHalf(fraction) - most * far) - slack;
  }
  /// Slopes are no steeper so far away.
  double steepest(double distance) const { return std::min(glm::length(slope) + bend * distance + slopeSlack, most); }

private:
  static double fromHalf(double turns) { return std::abs(turns - std::floor(turns) - 0.5); }
};

/// Sum of angles, as the number whose argument it is but for whole turns, and those.
class AngleSum {
public:
  /// The argument of a number, between -pi and pi.
  void add(double real, double imaginary) {
    const double sumReal = real_ * real - imaginary_ * imaginary, sumImaginary = real_ * imaginary + imaginary_ * real;
    if (imaginary_ >= 0 && imaginary >= 0 && sumImaginary < 0) ++turns_;
    if (imaginary_ < 0 && imaginary < 0 && sumImaginary >= 0) --turns_;
    real_ = sumReal, imaginary_ = sumImaginary;
  }
  void addTurns(int turns) { turns_ += turns; }
  double turns() const { return turns_ + std::atan2(imaginary_, real_) / (2.0 * std::numbers::pi); }

private:
  double real_ = 1, imaginary_ = 0;
  int turns_ = 0;
};

/// A number of turns that is right to the slack.
struct NearlyTurns {
  double turns = 0, slack = 0;
};

class Rims {
public:
  /// triangles of the soup; no rims where all their edges are balanced
  Rims(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles);

  std::size_t edgeCount() const { return edgeCount_; }
  std::size_t bytes() const {
    return edges_.size() * sizeof(EdgeQuad) + bundles_.size() * sizeof(Bundle) + loops_.size() * sizeof(Loop) +
           loopQuads_.size() * sizeof(LoopQuad);
  }

  /// The winding number of the triangles less some whole number, from 0 to 1.
  ///
  /// point     soup space; of no use on a rim itself
  /// returns   to 1e-12 times the number of edges
  /// cost      3 ns an edge
  /// proved by tests/bake/bakers/rims_test.cpp
  double fractionAt(glm::dvec3 point) const;
  /// What the rims, drawn out backwards along a ray without end, add to the ray's crossings with the triangles:
  /// together the winding number of its origin. Loops that are far away and off the ray count as dipoles; with few
  /// edges.
  ///
  /// cost      3 ns an edge of loops that are near
  /// proved by tests/bake/bakers/open_winding_test.cpp
  NearlyTurns turnsAlong(const RayWinding::Ray& ray) const;
  /// By each edge. cost 3 ns an edge
  double exactTurnsAlong(const RayWinding::Ray& ray) const;
  /// Slope of the winding number, in turns per unit of soup space; with many edges its length to a tenth.
  glm::dvec3 slopeAt(glm::dvec3 point) const { return fieldAt(point, 0.0).slope; }
  /// Both at once, without a bend. cost 4 ns an edge
  WindingAround fractionAndSlopeAt(glm::dvec3 point) const;
  /// In a ball around a point; nothing where a rim comes into the ball, or with many edges.
  ///
  /// cost      5 ns an edge of loops that are near
  /// proved by tests/bake/bakers/rims_test.cpp
  std::optional<WindingAround> around(glm::dvec3 center, double radius) const;
  /// By how much the winding number changes at most, but by crossing triangles, from the centre of a ball to any of its
  /// points. Infinite where a rim comes into the ball.
  ///
  /// cost      5 ns an edge; with many edges far ones count together
  /// proved by tests/bake/bakers/rims_test.cpp
  double mostChange(glm::dvec3 center, double radius) const;
  /// Whether sums over each edge would cost more than winding numbers.
  bool areMany() const { return edgeCount_ > kFewEdges; }

  /// Four edges from one point to the next, in metres of object space as meshes come; those that are missing at the end
  /// of a loop go nowhere.
  struct EdgeQuad {
    float points[3][5];
  };
  /// Soup space from object space, as TriangleSoup has it.
  struct Frame {
    glm::dvec3 centerObject{0.0};
    double unitsPerMetre = 1;
  };
  /// Edges that lead back to where they begin: all alone a current that is seen as a dipole from afar.
  struct Loop {
    std::uint32_t begin, end; ///< quads
    glm::dvec3 center;
    double radius;
    double area;           ///< of a surface within the ball that the loop bounds
    glm::dvec3 areaVector; ///< of any surface that it bounds
  };
  /// Four loops as they are seen from afar, a lane each; those that are missing at the end make nothing.
  struct LoopQuad {
    double center[3][4], areaVector[3][4], radius[4], area[4];
  };
  const std::vector<Loop>& loops() const { return loops_; } ///< where edges are few
  /// The k-th of a quad's five points, in soup space.
  glm::dvec3 point(std::size_t quad, std::size_t k) const {
    const auto& p = edges_[quad].points;
    return (glm::dvec3(p[0][k], p[1][k], p[2][k]) - frame_.centerObject) * frame_.unitsPerMetre;
  }
  /// By how much t x r / r^3 changes a unit of way, times r^3: |t x v - 3 (t x r)(r.v)| for unit vectors is at most 2
  /// along r and 1 across it.
  static constexpr double kFieldChange = 2.2360680;

private:
  static constexpr std::size_t kFewEdges = 512;

  /// Edges that stand together.
  struct Bundle {
    std::size_t begin, end; ///< of edges_
    glm::dvec3 center;
    double radius, length;
    glm::dvec3 way; ///< sum of the edges as vectors
  };
  struct Field {
    glm::dvec3 slope{0.0};     ///< turns per unit
    double inverseSquares = 0; ///< integral along the rims of 1 / r^2 at the most, r to the ball around the point
    double inverseCubes = 0;   ///< the same of 1 / r^3; of use where no bundle counted as one
    bool isClear = true;       ///< no rim comes into the ball; the rest is of no use where one does
  };
  Field fieldAt(glm::dvec3 point, double radius) const;
  void addLoop(const std::vector<glm::dvec3>& points);
  void gatherLoops();
  void bundleEdges();

  Frame frame_;
  std::vector<EdgeQuad> edges_;
  std::vector<Loop> loops_; ///< where edges are few
  std::vector<LoopQuad> loopQuads_;
  std::vector<Bundle> bundles_; ///< where they are many
  std::size_t edgeCount_ = 0;
  glm::dvec3 apex_{0.0}; ///< of the fan
};

} // namespace brickfield
