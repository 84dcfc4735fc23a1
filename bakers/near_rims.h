// The rims around a brick, gathered once for its samples: edges of loops that come near in floats, in a frame of the
// brick; loops that stay away as one linear function. What they tell is right to a slack that covers both, so that only
// what that leaves open must be asked of all edges in double.
#pragma once

#include <optional>
#include <vector>

#include "bakers/rims.h"

namespace brickfield {

class NearRims {
public:
  /// rims    few, outlive this
  /// ray     of any origin: along which strips are drawn out
  /// center, radius  of a ball around all points that will be asked for
  /// cost    1 us
  NearRims(const Rims& rims, const RayWinding::Ray& ray, glm::dvec3 center, double radius);

  /// As Rims::around, of a ball within that of the constructor.
  ///
  /// cost      2 ns an edge that is near
  /// proved by tests/bake/bakers/near_rims_test.cpp
  std::optional<WindingAround> around(glm::dvec3 center, double radius) const;
  /// As Rims::turnsAlong of rayFrom(point).
  ///
  /// cost      2 ns an edge that is near
  /// proved by tests/bake/bakers/near_rims_test.cpp
  NearlyTurns turnsAt(glm::dvec3 point) const;
  RayWinding::Ray rayFrom(glm::dvec3 point) const { return {point, ray_.along, ray_.isBackwards}; }

  /// Eight edges from one point to the next, in radii from the centre; those that are missing go nowhere.
  struct EdgeOct {
    float points[3][9];
    float lengths[8];
  };

private:
  void addNear(const Rims& rims, const Rims::Loop& loop);
  /// returns  false, and has added nothing, where too little is known of the loop by that
  bool addFar(const Rims::Loop& loop);

  RayWinding::Ray ray_;
  glm::dvec3 center_;
  double radius_;
  std::vector<EdgeOct> edges_;
  WindingAround far_; ///< around the centre; its slack holds in all of the ball
};

} // namespace brickfield
