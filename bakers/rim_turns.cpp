// In voxels; sums stand in rim_turns.inl.
#include "bakers/rim_turns.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <span>

#include "bakers/float4.h"
#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

/// What is linear in a sample: rims that are far.
struct FarTurns {
  double turns = 0; ///< at the brick's centre
  glm::dvec3 slope{0.0};
  double slack = 0; ///< in all of the brick
};

#define BRICKFIELD_SIMD_FILE "bakers/rim_turns.inl"
#include "bakers/each_simd.inl"

constexpr double kFourPi = 4.0 * std::numbers::pi;
constexpr double kBrickRadiusVoxels = 0.5 * 1.7320509 * kBrickCells;
constexpr double kMostFarSlack = 1e-2; // turns that a loop may be off by to count as a dipole
// Corners are rounded by less than links keep away from triangles (SampleLinks), 5e-5 voxel.
constexpr float kMostCoordinate = 512;

/// As NearRims::addFar; a loop's own surface may be on rays.
bool addFar(const Rims::Loop& loop, glm::dvec3 center, double voxel, FarTurns& far) {
  const glm::dvec3 toCenter = (loop.center - center) / voxel;
  const double radius = loop.radius / voxel, area = loop.area / (voxel * voxel);
  const double distance = glm::length(toCenter), away = distance - radius - kBrickRadiusVoxels;
  if (!(away > radius)) return false;
  const double moment = area / (kFourPi * away * away * away);
  const double slack = moment * (2.0 * radius + 3.0 * kBrickRadiusVoxels * kBrickRadiusVoxels / away);
  if (slack > kMostFarSlack) return false;
  const double oneOverCube = 1.0 / (kFourPi * distance * distance * distance);
  const glm::dvec3 areaVector = loop.areaVector / (voxel * voxel);
  const double flux = glm::dot(areaVector, toCenter);
  far.turns += flux * oneOverCube;
  far.slope += (3.0 * flux / (distance * distance) * toCenter - areaVector) * oneOverCube;
  far.slack += slack;
  return true;
}

} // namespace

RimTurns::RimTurns(const Rims& rims, glm::dvec3 first, double spacing) {
  areMeasured_ = !rims.areMany();
  if (!areMeasured_) return;
  const glm::dvec3 center = first + 0.5 * kBrickCells * spacing;
  FarTurns far;
  for (const Rims::Loop& loop : rims.loops())
    if (!addFar(loop, center, spacing, far) && !gather(loop, rims, first, spacing)) {
      areMeasured_ = false;
      return;
    }
  const std::span<const Corner> corners = std::span(corners_).first(cornerCount_);
  BRICKFIELD_BEST_SIMD(sumTurns(corners, far, turns_.data(), slacks_.data()));
}

/// returns false where they are too many or too long
bool RimTurns::gather(const Rims::Loop& loop, const Rims& rims, glm::dvec3 first, double spacing) {
  const std::size_t count = std::size_t{4} * (loop.end - loop.begin);
  if (cornerCount_ + count + 1 > corners_.size()) return false;
  const double oneOverSpacing = 1.0 / spacing;
  for (std::size_t i = 0; i <= count; ++i) {
    const glm::dvec3 soup = i < count ? rims.point(loop.begin + i / 4, i % 4) : rims.point(loop.end - 1, 4);
    const glm::vec3 point((soup - first) * oneOverSpacing);
    if (glm::any(glm::greaterThan(glm::abs(point), glm::vec3(kMostCoordinate)))) return false;
    const bool isLast = i == count;
    if (i > 0 && corners_[cornerCount_ - 1].point == point) // a lane that goes nowhere
      corners_[cornerCount_ - 1].isLast = isLast;
    else
      corners_[cornerCount_++] = {point, isLast};
  }
  return true;
}

void RimTurns::cut(SampleLinks& links) const {
  for (std::size_t i = 1; i < cornerCount_; ++i)
    if (!corners_[i - 1].isLast) links.cutBelow(corners_[i - 1].point, corners_[i].point);
}

} // namespace brickfield
