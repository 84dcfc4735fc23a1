// Choice among the sign methods.
#include "bakers/inside_test.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {
constexpr double kUncertainTurns = 0.015; // what clusters may be off by, and a half
constexpr double kFarExcess = 0.45;       // almost no turn or almost a whole one: no hole is near
} // namespace

SolidWinding::SolidWinding(const TriangleSoup& soup, const MeshTopology& topology,
                           const std::vector<std::uint32_t>& triangles, bool signless, const MeshHierarchy* whole)
    : signless_(signless) {
  std::vector<std::uint32_t> closedTriangles, openTriangles;
  for (const std::uint32_t triangle : triangles)
    (topology.inClosedComponent[triangle] ? closedTriangles : openTriangles).push_back(triangle);
  const auto makePart = [&]<typename Winding>(std::optional<Part<Winding>>& part,
                                              const std::vector<std::uint32_t>& members, auto... settings) {
    if (members.empty()) return;
    const bool isWhole = whole && members.size() == triangles.size();
    auto hierarchy = isWhole ? nullptr : std::make_unique<MeshHierarchy>(soup, members);
    Winding winding(isWhole ? *whole : *hierarchy, settings...);
    part.emplace(Part<Winding>{std::move(hierarchy), std::move(winding)});
  };
  makePart(closed_, closedTriangles);
  if (openTriangles.empty()) return;
  rims_.emplace(soup, openTriangles);
  makePart(open_, openTriangles, rims_->areMany() ? WindingNumber::kFarRadii : WindingNumber::kFarRadiiOfWhole);
}

std::size_t SolidWinding::bytes() const {
  std::size_t sum = 0;
  if (closed_ && closed_->hierarchy) sum += closed_->hierarchy->bytes();
  if (open_) sum += open_->winding.bytes() + (open_->hierarchy ? open_->hierarchy->bytes() : 0);
  if (rims_) sum += rims_->bytes();
  return sum;
}

double SolidWinding::closedTurns(glm::dvec3 point) const { return closed_ ? closed_->winding.at(point) : 0; }

double SolidWinding::excess(glm::dvec3 point, double exactTurns) const {
  const double closed = closedTurns(point);
  if (!open_) return std::abs(closed) >= 0.5 ? HUGE_VAL : -HUGE_VAL;
  if (!signless_ && std::abs(closed) >= 0.5) return HUGE_VAL;
  // But for whole turns the rims know better.
  const double turns = static_cast<double>(open_->winding.at(point)) + (signless_ ? std::round(closed) : 0.0);
  if (std::abs(excessOf(turns)) > (rims_->areMany() ? std::min(kUncertainTurns, exactTurns) : exactTurns))
    return excessOf(turns);
  const double fraction = rims_->fractionAt(point);
  return excessOf(fraction + std::round(turns - fraction));
}

double SolidWinding::excessBy(glm::dvec3 point, double fraction) const {
  const double closed = closedTurns(point);
  if (!signless_ && std::abs(closed) >= 0.5) return HUGE_VAL;
  const double turns = static_cast<double>(open_->winding.at(point)) + (signless_ ? std::round(closed) : 0.0);
  return excessOf(fraction + std::round(turns - fraction));
}

double SolidWinding::membraneDistance(glm::dvec3 point, double limit) const {
  if (!rims_) return HUGE_VAL;
  const bool areMany = rims_->areMany();
  const WindingAround here = areMany ? WindingAround{} : rims_->fractionAndSlopeAt(point);
  const double least = areMany ? 0.0 : std::abs(here.fraction - 0.5); // whole turns can only be added to it
  if (least > kFarExcess) return HUGE_VAL;
  const double steepness = std::max(glm::length(areMany ? rims_->slopeAt(point) : here.slope), 1e-12);
  if (least > limit * steepness) return HUGE_VAL;
  const double excess = std::abs(areMany ? this->excess(point) : excessBy(point, here.fraction));
  return excess > kFarExcess || excess > limit * steepness ? HUGE_VAL : excess / steepness;
}

bool isFarFromMembranes(const WindingAround& around, glm::dvec3 offset, double radius, double limit) {
  const double least = around.leastFromHalf(offset, radius);
  return least > kFarExcess || least > limit * around.steepest(glm::length(offset) + radius);
}

bool SolidWinding::isSteady(glm::dvec3 center, double radius) const {
  if (!rims_) return true;
  if (!rims_->areMany()) {
    const std::optional<WindingAround> around = rims_->around(center, radius);
    return around && around->leastFromHalf(glm::dvec3(0.0), radius) > 0;
  }
  const double change = rims_->mostChange(center, radius);
  if (change >= 0.5) return false;
  const double turns = static_cast<double>(open_->winding.at(center));
  return std::abs(turns - std::floor(turns) - 0.5) > change + kUncertainTurns;
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
