// The truth about the distance field of a posed scene's meshes, independent of what the renderer makes: triangles
// placed on the CPU in double, their own weld and closedness, exact distances and winding numbers. Masked materials are
// whole here, as in the world field; SDF objects are left out.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "scene/pose.h"

namespace brickfield {

/// At one point. Closed surfaces have an inside, all others are sheets.
struct FieldTruth {
  double closedDistance = std::numeric_limits<double>::infinity(); ///< metres, unsigned; infinite without any
  double openDistance = std::numeric_limits<double>::infinity();
  bool insideClosed = false; ///< of the closed part that is nearest
  double thinning = 0;       ///< metres off the closed distance at parts thinner than a texel, see FieldOracle::at
  bool insideAny = false;    ///< of any closed part: differs from insideClosed only where parts reach into each other
  int node = -1;             ///< of what is nearest, sheets by their unsigned distance; -1: there is nothing

  double unsignedDistance() const { return std::min(closedDistance, openDistance); }
  bool onClosedComponent() const { return closedDistance <= openDistance; }
  /// The field's meaning: the nearest closed surface, signed, or the nearest sheet less half its thickness.
  double unionDistance(double sheetHalfThickness) const {
    const double closed = insideClosed ? -closedDistance : closedDistance, sheet = openDistance - sheetHalfThickness;
    return closed <= sheet ? closed - thinning : sheet;
  }
};

class FieldOracle {
public:
  /// fieldOfNode  as SceneFields has it: nodes with 0 or more are no meshes; may be empty
  explicit FieldOracle(const Scene& scene, const Pose& pose, const std::vector<int>& fieldOfNode = {});
  ~FieldOracle();
  FieldOracle(FieldOracle&&) noexcept;

  /// pointWorld  metres
  /// texelMetres of a field that takes closed parts thinner than a texel for a texel thick, lest rays slip through:
  /// where
  ///             the way to the nearest place, a texel prolonged, leaves the part again by its back, half of what is
  ///             missing comes off on each side, fading from one texel away to two. 0: parts are as thin as they are
  /// bound      distances exact to the rounding of floats in skins, else of double; a side is right farther from a
  ///            surface than that
  /// proved by  tests/oracle/support/field_truth_test.cpp
  FieldTruth at(glm::dvec3 pointWorld, double texelMetres = 0) const;
  /// Whether parts, or folds of one, reach into each other near a point that a closed part holds: what lies right
  /// behind the nearest place of some part is in one as well, so that no nearest surface can tell which side is out.
  ///
  /// reach   metres: places farther away do not count
  /// behind  metres: how far behind them; less than any wall is thick
  bool seesBuriedSurface(glm::dvec3 pointWorld, double reach, double behind) const;
  /// The same of many points, on all threads. texelMetres  as many, or none for 0
  std::vector<FieldTruth> at(std::span<const glm::dvec3> pointsWorld, std::span<const double> texelMetres = {}) const;

  std::size_t closedParts() const;
  std::size_t closedTriangles() const;
  std::size_t openTriangles() const;

private:
  double thinningAt(glm::dvec3 pointWorld, const FieldTruth& truth, double texelMetres) const;

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace brickfield
