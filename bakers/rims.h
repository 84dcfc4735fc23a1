// The rims of open triangles: edges that are walked more often in one direction than in the other. They alone decide
// the winding number up to whole turns: any other triangles with the same rims, as a fan from one point to each rim
// edge, differ from these by a closed surface. So away from rims the winding number changes smoothly but for whole
// turns across triangles, with the slope that Biot and Savart's law gives for a current along the rims.
#pragma once

#include <cstdint>
#include <vector>

#include "bakers/triangle_soup.h"

namespace brickfield {

class Rims {
public:
  /// triangles of the soup; no rims where all their edges are balanced
  Rims(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles);

  std::size_t edgeCount() const { return edgeCount_; }
  std::size_t bytes() const { return edges_.size() * sizeof(EdgeQuad) + bundles_.size() * sizeof(Bundle); }

  /// The winding number of the triangles less some whole number, from 0 to 1.
  ///
  /// point     soup space; of no use on a rim itself
  /// returns   to 1e-12 times the number of edges
  /// cost      4 ns an edge
  /// proved by tests/bake/bakers/rims_test.cpp
  double fractionAt(glm::dvec3 point) const;
  /// Slope of the winding number, in turns per unit of soup space, either way; with many edges to a tenth.
  glm::dvec3 slopeAt(glm::dvec3 point) const { return fieldAt(point, 0.0).slope; }
  /// By how much the winding number changes at most, but by crossing triangles, from the centre of a ball to any of its
  /// points. Infinite where a rim comes into the ball.
  ///
  /// cost      5 ns an edge; with many edges far ones count together
  /// proved by tests/bake/bakers/rims_test.cpp
  double mostChange(glm::dvec3 center, double radius) const;
  /// Whether walks over each edge would cost more than winding numbers.
  bool areMany() const { return edgeCount_ > kFewEdges; }

  /// From and to of four edges; those that are missing go nowhere.
  struct EdgeQuad {
    double from[3][4], to[3][4];
  };

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
  void bundleEdges();

  std::vector<EdgeQuad> edges_;
  std::vector<Bundle> bundles_;
  std::size_t edgeCount_ = 0;
  glm::dvec3 apex_{0.0}; ///< of the fan
};

} // namespace brickfield
