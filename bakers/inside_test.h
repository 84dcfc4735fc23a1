// Which points are inside: one face over the sign methods, for the triangles that bound solids. Sheets have no inside
// and are kept out of it (sheets.h).
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "bakers/open_winding.h"
#include "bakers/pseudonormals.h"
#include "bakers/ray_parity.h"

namespace brickfield {

/// Inside by winding number, where part of the triangles forms closed components and part does not.
///
/// Closed ones wrap a point a whole number of times: any number but 0 is inside, so a mesh turned inside out is solid
/// too, while an inner shell that faces inwards is a cavity. Open ones give fractions: half a turn or more is inside,
/// but only behind the faces. Before them, half a turn is a valley of terrain or a room seen from within, not a solid.
class SolidWinding {
public:
  /// triangles of the soup; may be empty: nothing is inside
  /// whole     hierarchy of all of them, used where all are closed or all open; must outlive this; may be nothing
  /// signless  |w| >= 1/2 is inside for open triangles as well (SignMethod::Winding)
  SolidWinding(const TriangleSoup& soup, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
               bool signless, const MeshHierarchy* whole = nullptr);

  /// See InsideTest.
  double excess(glm::dvec3 point) const { return excess(point, false); }
  bool isInside(glm::dvec3 point, const NearRims* near = nullptr) const { return excess(point, true, near) >= 0; }
  std::optional<NearRims> nearRims(glm::dvec3 center, double radius) const {
    return open_ ? open_->nearRims(center, radius) : std::nullopt;
  }
  const Rims* rims() const { return open_ ? &open_->rims() : nullptr; }
  NearlyTurns nearlyTurns(glm::dvec3 point, const NearRims& near) const;
  bool isInsideBy(double turns) const { return excessOf(turns) >= 0; }
  bool isSteady(glm::dvec3 center, double radius) const;
  double membraneDistance(glm::dvec3 point, double limit, const NearRims* near = nullptr) const;
  /// True where the answer can change without a surface between: open triangles.
  bool hasOpenTriangles() const { return open_.has_value(); }
  /// Of moments, and of hierarchies besides the whole one.
  std::size_t bytes() const;

private:
  double excess(glm::dvec3 point, bool isSignEnough, const NearRims* near = nullptr) const;
  /// By the exact fraction of the open triangles' number.
  double excessBy(glm::dvec3 point, double fraction) const;
  /// Of closed ones, a whole number.
  double closedTurns(glm::dvec3 point) const;
  double excessOf(double turns) const { return (signless_ ? std::abs(turns) : turns) - 0.5; }

  std::unique_ptr<MeshHierarchy> closedHierarchy_; ///< nothing where it is the whole one
  std::optional<RayWinding> closed_;
  std::optional<OpenWinding> open_;
  bool signless_;
};

/// Whether InsideTest::membraneDistance is infinite in all of a ball.
///
/// offset, radius  of the ball; it lies within that of `around`
bool isFarFromMembranes(const WindingAround& around, glm::dvec3 offset, double radius, double limit);

class InsideTest {
public:
  /// method  not TwoSided, which has no inside
  /// ready   of all triangles of `solid`, by it, for SignMethod::Auto; nothing: made here
  /// error   BadInput that names `label`: Pseudonormal on a mesh that is no closed manifold
  InsideTest(const TriangleSoup& soup, const MeshTopology& topology, const MeshHierarchy& solid, SignMethod method,
             const std::string& label, std::optional<SolidWinding> ready = std::nullopt);

  /// point   soup space
  /// near    of a ball that holds it, if there: changes the time, never the result
  bool isInside(glm::dvec3 point, const NearRims* near = nullptr) const {
    return winding_ ? winding_->isInside(point, near) : excess(point) >= 0;
  }
  /// How far the point is from changing sides: at least 0 inside. For open triangles their winding number less one
  /// half, which is smooth wherever there is no triangle; infinite (either way) where only a triangle could change the
  /// answer. To 1e-9; with very many rim edges to 0.015, but for near one half.
  double excess(glm::dvec3 point) const;
  /// The open triangles' rims as they are seen from a ball: where the winding number by them keeps to one side of one
  /// half, points that can be joined without crossing a triangle have the same answer. Nothing where there are none or
  /// very many.
  std::optional<NearRims> nearRims(glm::dvec3 center, double radius) const {
    return winding_ ? winding_->nearRims(center, radius) : std::nullopt;
  }
  /// The open triangles' rims; nothing where there are none.
  const Rims* rims() const { return winding_ ? winding_->rims() : nullptr; }
  /// With rims: the winding number to a quarter; infinite where closed triangles alone make the point an inside one.
  NearlyTurns nearlyTurns(glm::dvec3 point, const NearRims& near) const { return winding_->nearlyTurns(point, near); }
  /// With rims: the answer where the winding number is so large.
  bool isInsideBy(double turns) const { return winding_->isInsideBy(turns); }
  /// How far a point is from where the answer changes although no triangle is there, to first order: excess by slope.
  ///
  /// returns  soup space; infinite beyond limit or where the number is almost whole
  double membraneDistance(glm::dvec3 point, double limit, const NearRims* near = nullptr) const {
    return winding_ ? winding_->membraneDistance(point, limit, near) : HUGE_VAL;
  }
  /// True where points that can be joined within a ball without crossing a triangle are known to have the same answer.
  bool isSteady(glm::dvec3 center, double radius) const {
    return isConstant_ || (winding_ && winding_->isSteady(center, radius));
  }

  /// True where points that can be joined without crossing a triangle always have the same answer.
  bool isConstantBetweenSurfaces() const { return isConstant_; }
  /// What it adds to the hierarchy of the solid.
  std::size_t bytes() const { return winding_ ? winding_->bytes() : 0; }

private:
  const MeshHierarchy* solid_;
  SignMethod method_;
  std::optional<SolidWinding> winding_;
  std::optional<Pseudonormals> pseudonormals_;
  bool isConstant_ = true;
};

} // namespace brickfield
