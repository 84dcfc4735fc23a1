// Sums stand in near_rim_sums.inl.
#include "bakers/near_rims.h"

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

constexpr float kRounding = 0x1p-24f;
constexpr float kLeastAway = 1e-3f; // radii: nearer edges make floats of no use

/// What sums over edges are, in radii.
struct StripProduct {
  std::array<float, 8> real, imaginary; ///< lane by lane
  std::array<std::int32_t, 8> turns;    ///< and whole turns
  double roundings = 0, moved = 0;      ///< that the argument may be off by: so many times 8 * 2^-24, 2^-24
  bool isClear = true;                  ///< the whole turns are sure
};
struct NearField {
  glm::dvec3 slope{0.0}; ///< times 4 pi
  double squares = 0, cubes = 0;
  double slopeError = 0; ///< that the slope may be off by: so many times 8 * 2^-24
};

#define BRICKFIELD_SIMD_FILE "bakers/near_rim_sums.inl"
#include "bakers/each_simd.inl"

constexpr double kFourPi = 4.0 * std::numbers::pi;
constexpr double kOverSums = 1 + 1e-5; // over the rounding of sums in floats
constexpr double kMostFarSlack = 2e-3; // turns that a loop may be off by to count as far

NearlyTurns turnsOf(const StripProduct& product) {
  AngleSum sum;
  for (std::size_t i = 0; i < 8; ++i) {
    sum.add(static_cast<double>(product.real[i]), static_cast<double>(product.imaginary[i]));
    sum.addTurns(product.turns[i]);
  }
  // Twice what was derived, for the products and sums themselves.
  const double slack = 2.0 * double{kRounding} * (8.0 * product.roundings + product.moved) / (2.0 * std::numbers::pi);
  return {sum.turns(), slack};
}

} // namespace

NearRims::NearRims(const Rims& rims, const RayWinding::Ray& ray, glm::dvec3 center, double radius)
    : ray_(ray), center_(center), radius_(radius) {
  for (const Rims::Loop& loop : rims.loops())
    if (!addFar(loop)) addNear(rims, loop);
}

/// Pieces of the loop's surface are dipoles up to its radius from where they are counted. A dipole's potential has
/// derivatives of up to 2 / r^3 and 6 / r^4.
bool NearRims::addFar(const Rims::Loop& loop) {
  const glm::dvec3 toCenter = loop.center - center_;
  const double distance = glm::length(toCenter), away = distance - loop.radius - radius_;
  if (!(away > loop.radius) || ray_.comesThrough(toCenter, loop.radius + radius_)) return false;
  const double moment = loop.area / (kFourPi * away * away * away);
  const double slack = moment * (2.0 * loop.radius + 3.0 * radius_ * radius_ / away);
  if (slack > kMostFarSlack) return false;
  const double oneOverCube = 1.0 / (kFourPi * distance * distance * distance);
  const double flux = glm::dot(loop.areaVector, toCenter);
  far_.fraction += flux * oneOverCube;
  far_.slope += (3.0 * flux / (distance * distance) * toCenter - loop.areaVector) * oneOverCube;
  far_.slack += slack;
  far_.slopeSlack += 6.0 * moment * (loop.radius + radius_) / away;
  return true;
}

void NearRims::addNear(const Rims& rims, const Rims::Loop& loop) {
  const std::size_t count = std::size_t{4} * (loop.end - loop.begin);
  const auto pointOf = [&](std::size_t i) {
    const std::size_t last = std::min(i, count);
    return (last < count ? rims.point(loop.begin + last / 4, last % 4) : rims.point(loop.end - 1, 4)) - center_;
  };
  glm::dvec3 last = pointOf(0) / radius_;
  for (std::size_t first = 0; first < count; first += 8) {
    EdgeOct& oct = edges_.emplace_back();
    for (std::size_t i = 0; i < 9; ++i) {
      const glm::dvec3 point = i > 0 ? pointOf(first + i) / radius_ : last;
      for (glm::length_t axis = 0; axis < 3; ++axis) oct.points[axis][i] = static_cast<float>(point[axis]);
      if (i > 0) oct.lengths[i - 1] = static_cast<float>(glm::length(point - last));
      last = point;
    }
  }
}

NearlyTurns NearRims::turnsAt(glm::dvec3 point) const {
  const glm::dvec3 offset = point - center_;
  NearlyTurns nearly{far_.at(offset), far_.slack};
  if (edges_.empty()) return nearly;
  StripProduct product;
  const glm::vec3 place(offset / radius_), direction(ray_.direction());
  BRICKFIELD_BEST_SIMD(multiplyStrips(edges_, direction, place, product));
  if (!product.isClear) return {0, HUGE_VAL};
  const NearlyTurns near = turnsOf(product);
  return {nearly.turns + near.turns, nearly.slack + near.slack};
}

std::optional<WindingAround> NearRims::around(glm::dvec3 center, double radius) const {
  const glm::dvec3 offset = center - center_;
  WindingAround around = far_;
  around.fraction = far_.at(offset);
  around.most = glm::length(far_.slope) + far_.slopeSlack;
  if (!edges_.empty()) {
    StripProduct product;
    NearField field;
    const glm::vec3 place(offset / radius_), direction(ray_.direction());
    const auto relativeRadius = static_cast<float>(radius / radius_);
    const bool isClear = BRICKFIELD_BEST_SIMD(sumField(edges_, direction, place, relativeRadius, product, field));
    if (!isClear) return std::nullopt;
    const NearlyTurns near = turnsOf(product);
    const double slopeSlack = 2.0 * 8.0 * double{kRounding} * field.slopeError / (kFourPi * radius_);
    around.fraction += near.turns;
    around.slope += field.slope / (kFourPi * radius_);
    around.bend = Rims::kFieldChange * kOverSums * field.cubes / (kFourPi * radius_ * radius_);
    around.most += kOverSums * field.squares / (kFourPi * radius_);
    around.slack += near.slack + slopeSlack * radius;
    around.slopeSlack += slopeSlack;
  }
  around.fraction -= std::floor(around.fraction);
  return around;
}

} // namespace brickfield
