// Which of the two ways is taken.
#include "bakers/open_winding.h"

#include <cmath>

namespace brickfield {

namespace {
constexpr double kSumSlackTurns = 0.015; // what clusters may be off by, and a half
}

OpenWinding::OpenWinding(const TriangleSoup& soup, const std::vector<std::uint32_t>& triangles,
                         const MeshHierarchy* whole)
    : rims_(soup, triangles), own_(whole ? nullptr : std::make_unique<MeshHierarchy>(soup, triangles)) {
  const MeshHierarchy& hierarchy = whole ? *whole : *own_;
  if (rims_.areMany())
    sums_.emplace(hierarchy);
  else
    rays_.emplace(hierarchy);
}

NearlyTurns OpenWinding::nearlyAt(glm::dvec3 point) const {
  if (sums_) return {static_cast<double>(sums_->at(point)), kSumSlackTurns};
  const RayWinding::Ray ray = rays_->rayFrom(point);
  NearlyTurns turns = rims_.turnsAlong(ray);
  turns.turns += rays_->crossings(ray);
  return turns;
}

std::optional<NearRims> OpenWinding::nearRims(glm::dvec3 center, double radius) const {
  if (!rays_) return std::nullopt;
  return NearRims(rims_, rays_->rayFrom(center), center, radius);
}

NearlyTurns OpenWinding::nearlyAt(glm::dvec3 point, const NearRims& near) const {
  NearlyTurns turns = near.turnsAt(point);
  turns.turns += rays_->crossings(near.rayFrom(point));
  return turns;
}

double OpenWinding::roughlyAt(glm::dvec3 point) const {
  constexpr double kMostSlack = 0.02;
  const NearlyTurns nearly = nearlyAt(point);
  return nearly.slack <= kMostSlack ? nearly.turns : exactlyAt(point);
}

double OpenWinding::exactlyAt(glm::dvec3 point) const {
  if (!sums_) {
    const RayWinding::Ray ray = rays_->rayFrom(point);
    return rims_.exactTurnsAlong(ray) + rays_->crossings(ray);
  }
  const auto turns = static_cast<double>(sums_->at(point));
  if (std::abs(turns - std::floor(turns) - 0.5) > kSumSlackTurns) return turns;
  const double fraction = rims_.fractionAt(point);
  return fraction + std::round(turns - fraction);
}

std::size_t OpenWinding::bytes() const {
  return rims_.bytes() + (own_ ? own_->bytes() : 0) + (sums_ ? sums_->bytes() : 0);
}

} // namespace brickfield
