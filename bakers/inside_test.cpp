// Choice among the sign methods.
#include "bakers/inside_test.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {
constexpr double kMostSlack = 0.25; // of turns that are looked at for the nearest whole number
constexpr double kFarExcess = 0.45; // almost no turn or almost a whole one: no hole is near
// Distances to membranes are estimates to first order: what rims may be off by must not show beside that.
constexpr double kMembraneSlack = 1e-3;
} // namespace

SolidWinding::SolidWinding(const TriangleSoup& soup, const MeshTopology& topology,
                           const std::vector<std::uint32_t>& triangles, bool signless, const MeshHierarchy* whole)
    : signless_(signless) {
  std::vector<std::uint32_t> closedTriangles, openTriangles;
  for (const std::uint32_t triangle : triangles)
    (topology.inClosedComponent[triangle] ? closedTriangles : openTriangles).push_back(triangle);
  const auto wholeOf = [&](const auto& members) { return members.size() == triangles.size() ? whole : nullptr; };
  if (!closedTriangles.empty()) {
    const MeshHierarchy* hierarchy = wholeOf(closedTriangles);
    if (!hierarchy) {
      closedHierarchy_ = std::make_unique<MeshHierarchy>(soup, closedTriangles);
      hierarchy = closedHierarchy_.get();
    }
    closed_.emplace(*hierarchy);
  }
  if (!openTriangles.empty()) open_.emplace(soup, openTriangles, wholeOf(openTriangles));
}

std::size_t SolidWinding::bytes() const {
  return (closedHierarchy_ ? closedHierarchy_->bytes() : 0) + (open_ ? open_->bytes() : 0);
}

double SolidWinding::closedTurns(glm::dvec3 point) const { return closed_ ? closed_->at(point) : 0; }

double SolidWinding::excess(glm::dvec3 point, bool isSignEnough, const NearRims* near) const {
  const double closed = closedTurns(point);
  if (!open_) return closed != 0 ? HUGE_VAL : -HUGE_VAL;
  if (!signless_ && closed != 0) return HUGE_VAL;
  const double whole = signless_ ? closed : 0.0;
  if (isSignEnough) {
    NearlyTurns nearly = near ? open_->nearlyAt(point, *near) : NearlyTurns{0, HUGE_VAL};
    if (std::abs(excessOf(nearly.turns + whole)) <= nearly.slack) nearly = open_->nearlyAt(point);
    if (std::abs(excessOf(nearly.turns + whole)) > nearly.slack) return excessOf(nearly.turns + whole);
  }
  return excessOf(open_->exactlyAt(point) + whole);
}

double SolidWinding::excessBy(glm::dvec3 point, double fraction) const {
  const double closed = closedTurns(point);
  if (!signless_ && closed != 0) return HUGE_VAL;
  const double turns = open_->nearlyAt(point).turns + (signless_ ? closed : 0.0);
  return excessOf(fraction + std::round(turns - fraction));
}

NearlyTurns SolidWinding::nearlyTurns(glm::dvec3 point, const NearRims& near) const {
  const double closed = closedTurns(point);
  if (!signless_ && closed != 0) return {HUGE_VAL, 0};
  NearlyTurns turns = open_->nearlyAt(point, near);
  if (turns.slack >= kMostSlack) turns = {open_->exactlyAt(point), 0};
  turns.turns += signless_ ? closed : 0.0;
  return turns;
}

double SolidWinding::membraneDistance(glm::dvec3 point, double limit, const NearRims* near) const {
  if (!open_) return HUGE_VAL;
  std::optional<WindingAround> around;
  if (near) around = near->around(point, 0.0);
  if (around && isFarFromMembranes(*around, glm::dvec3(0.0), 0.0, limit)) return HUGE_VAL;
  const Rims& rims = open_->rims();
  const bool areMany = rims.areMany();
  const bool isNearEnough =
      around && around->slack < kMembraneSlack && around->slopeSlack < kMembraneSlack * glm::length(around->slope);
  const WindingAround here = areMany ? WindingAround{} : isNearEnough ? *around : rims.fractionAndSlopeAt(point);
  const double least = areMany ? 0.0 : std::abs(here.fraction - 0.5); // whole turns can only be added to it
  if (least > kFarExcess) return HUGE_VAL;
  const double steepness = std::max(glm::length(areMany ? rims.slopeAt(point) : here.slope), 1e-12);
  if (least > limit * steepness) return HUGE_VAL;
  const double excess = std::abs(areMany ? this->excess(point) : excessBy(point, here.fraction));
  return excess > kFarExcess || excess > limit * steepness ? HUGE_VAL : excess / steepness;
}

bool isFarFromMembranes(const WindingAround& around, glm::dvec3 offset, double radius, double limit) {
  const double least = around.leastFromHalf(offset, radius);
  return least > kFarExcess || least > limit * around.steepest(glm::length(offset) + radius);
}

bool SolidWinding::isSteady(glm::dvec3 center, double radius) const {
  if (!open_) return true;
  const Rims& rims = open_->rims();
  if (!rims.areMany()) {
    const std::optional<WindingAround> around = rims.around(center, radius);
    return around && around->leastFromHalf(glm::dvec3(0.0), radius) > 0;
  }
  const double change = rims.mostChange(center, radius);
  if (change >= 0.5) return false;
  const NearlyTurns nearly = open_->nearlyAt(center);
  return std::abs(nearly.turns - std::floor(nearly.turns) - 0.5) > change + nearly.slack;
}

namespace {
std::vector<std::uint32_t> trianglesOf(const MeshHierarchy& hierarchy) {
  std::vector<bool> isIn(hierarchy.soup().triangles.size(), false);
  for (const HierarchyLeaf& leaf : hierarchy.leaves())
    for (const std::uint32_t triangle : leaf.triangles) isIn[triangle] = true;
  std::vector<std::uint32_t> triangles;
  triangles.reserve(hierarchy.triangleCount());
  for (std::uint32_t t = 0; t < isIn.size(); ++t)
    if (isIn[t]) triangles.push_back(t);
  return triangles;
}
} // namespace

InsideTest::InsideTest(const TriangleSoup& soup, const MeshTopology& topology, const MeshHierarchy& solid,
                       SignMethod method, const std::string& label, std::optional<SolidWinding> ready)
    : solid_(&solid), method_(method) {
  if (method == SignMethod::Pseudonormal) {
    pseudonormals_ = Pseudonormals::of(soup);
    if (!pseudonormals_)
      throw BadInput(label, "",
                     fmt::format("the sign method pseudonormal needs a closed manifold; this mesh has {} open and {} "
                                 "non-manifold edges and {} triangles without area",
                                 topology.openEdges, topology.nonManifoldEdges, soup.degenerateCount));
  } else if (method == SignMethod::Parity) {
    isConstant_ = topology.isClosed();
  } else {
    if (ready)
      winding_ = std::move(ready);
    else
      winding_.emplace(soup, topology, trianglesOf(solid), method == SignMethod::Winding, &solid);
    isConstant_ = !winding_->hasOpenTriangles();
  }
}

double InsideTest::excess(glm::dvec3 point) const {
  if (winding_) return winding_->excess(point);
  const bool isInside = pseudonormals_ ? pseudonormals_->isInside(point, MeshDistance(*solid_).closest(point))
                                       : isInsideByParity(*solid_, point);
  return isInside ? HUGE_VAL : -HUGE_VAL;
}

} // namespace brickfield
