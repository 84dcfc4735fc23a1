// Across a triangle of a closed component the winding number changes by one, so that one side at least is inside: a
// solid whose sides are both outside has ended already.
#include "bakers/solid_thickness.h"

#include <cmath>

namespace brickfield {

namespace {

constexpr double kProbe = 1.0 / 128; // of the limit: where the sides of a point are looked at
constexpr double kBallSlack = 1e-3;  // over rounding
constexpr int kHalvings = 5;         // of 2^7 on a logarithmic scale: to a factor of 2^(7/32), 1.164

} // namespace

std::optional<double> SolidThickness::behind(std::uint32_t triangle, glm::dvec3 point, double limit,
                                             const KnownSides& known) const {
  const auto [a, b, c] = soup_->corners(triangle);
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const double probe = kProbe * limit;
  const bool before = known.before ? *known.before : inside_->isInside(point + probe * normal);
  const bool after = known.behind ? *known.behind : inside_->isInside(point - probe * normal);
  if (before && after) return std::nullopt;
  if (!before && !after) return probe;
  const glm::dvec3 inwards = after ? -normal : normal;
  const double radius = 0.5 * limit;
  const double fromEmpty = glm::length(point + radius * inwards - known.emptyCenter);
  if (fromEmpty + (1 - kBallSlack) * radius < known.emptyRadius) return HUGE_VAL;
  if (solid_->nearest(point + radius * inwards, (1 - kBallSlack) * radius).triangle == kNoTriangle) return HUGE_VAL;
  if (!inside_->isInside(point + radius * inwards)) return endBetween(point, inwards, {probe, radius});
  if (!inside_->isInside(point + limit * inwards)) return endBetween(point, inwards, {radius, limit});
  return HUGE_VAL;
}

double SolidThickness::endBetween(glm::dvec3 point, glm::dvec3 inwards, glm::dvec2 insideAndOutside) const {
  auto [inside, outside] = std::pair(insideAndOutside.x, insideAndOutside.y);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(inside * outside);
    (inside_->isInside(point + middle * inwards) ? inside : outside) = middle;
  }
  return inside;
}

} // namespace brickfield
