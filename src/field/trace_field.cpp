// Sphere tracing of one level (Hart 1996), with crossings solved voxel by voxel. A trilinear voxel along a ray is a
// cubic; its first crossing is isolated by subdividing its Bernstein form (Lane and Riesenfeld 1981), whose hull proves
// voxels without a crossing empty at once. The graphics card's twin brackets by samples instead.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "field/brick_field.h"
#include "field/brick_layout.h"
#include "field/brick_lookup.h"

namespace brickfield {

namespace {

// Steps over a border go this far beyond it. The crossing is always bracketed from the last point known outside, so a
// crossing within the nudge is still found. Well above the rounding of doubles at 7168 voxels (1e-12).
constexpr double kNudgeVoxels = 1e-9;
constexpr double kSqrt3 = 1.7320508075688772;

using Cubic = std::array<double, 4>; // Bernstein coefficients over [0,1]

// The smallest t where the cubic turns negative, given that it is not at 0; 2^-30 is 1e-9 voxel.
std::optional<double> firstNegative(const Cubic& b, double low, double high, int depth = 0) {
  if (b[0] >= 0 && b[1] >= 0 && b[2] >= 0 && b[3] >= 0) return {}; // the curve lies in the hull of its coefficients
  constexpr int kDeepest = 30;
  if (depth == kDeepest) return b[3] < 0 ? std::optional(high) : std::nullopt;
  const double ab = 0.5 * (b[0] + b[1]), bc = 0.5 * (b[1] + b[2]), cd = 0.5 * (b[2] + b[3]);
  const double abc = 0.5 * (ab + bc), bcd = 0.5 * (bc + cd), middle = 0.5 * (abc + bcd);
  const double half = 0.5 * (low + high);
  if (const auto found = firstNegative({b[0], ab, abc, middle}, low, half, depth + 1)) return found;
  if (middle < 0) return half;
  return firstNegative({middle, bcd, cd, b[3]}, half, high, depth + 1);
}

// Runs along the ray in the level's space, by `way` in voxels from the point where it enters the bounds.
class LevelWalk {
public:
  LevelWalk(const BrickLevel& level, glm::dvec3 entryVoxels, glm::dvec3 directionUnit)
      : level_(level),
        entryVoxels_(entryVoxels),
        directionUnit_(directionUnit),
        // An encoded distance is off by up to one code (codes of -1 stand for all small negative ones).
        quantumVoxels_(level.rangeVoxels / (level.format == DistanceFormat::R8Snorm ? 127.0 : 32767.0)) {}

  std::optional<double> firstEntry(double end) {
    isInside_ = startsInside();
    double way = 0;
    while (way <= end) {
      const glm::ivec3 voxel = voxelAt(level_, pointAt(way), directionUnit_);
      const glm::ivec3 brick = brickOfVoxel(voxel);
      const IndirectionCell cell = cellAt(level_, brick);
      if (cell.isEmpty()) {
        if (cell.isInside() && !isInside_) return way;
        isInside_ = cell.isInside();
        way = wayPastEmpty(way, brick, cell);
      } else if (const auto found = crossOrAdvance(way, end, voxel, cell.brickIndex())) {
        return found;
      }
    }
    return {};
  }

private:
  glm::dvec3 pointAt(double way) const { return entryVoxels_ + way * directionUnit_; }

  bool startsInside() const {
    const glm::ivec3 voxel = voxelAt(level_, entryVoxels_, directionUnit_);
    const IndirectionCell cell = cellAt(level_, brickOfVoxel(voxel));
    return cell.isEmpty() ? cell.isInside() : sampleVoxels(level_, entryVoxels_) < 0;
  }

  // Way until the ray leaves a box that it is in. The bounds may stick out of the grid by a hair, so that the ray is
  // beyond a face already: that face is not met again.
  double exitWay(double way, glm::ivec3 corner, int edge) const {
    const glm::dvec3 point = pointAt(way);
    double exit = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (directionUnit_[axis] == 0) continue;
      const int face = corner[axis] + (directionUnit_[axis] > 0 ? edge : 0);
      const double ahead = (face - point[axis]) / directionUnit_[axis];
      if (ahead > 0) exit = std::min(exit, way + ahead);
    }
    return exit + kNudgeVoxels;
  }

  // No surface is in the cell, so its exit is safe. Nor is one within the bound; the reconstructed surface lies at most
  // sqrt(3)/2 voxel and a code beside the true one: its distance is an average over corners whose root mean square
  // distance is sqrt(sum of f(1-f)) <= sqrt(3)/2.
  double wayPastEmpty(double way, glm::ivec3 brick, IndirectionCell cell) const {
    const double exit = exitWay(way, kBrickCells * brick, kBrickCells);
    return std::max(exit, way + cell.boundVoxels() - 0.5 * kSqrt3 - quantumVoxels_);
  }

  // Safe step at a reconstructed distance: no partial derivative of it is above 1 (and what two codes add), so its
  // gradient is at most sqrt(3) of that; and by the argument above, applied to both ends, it is at most sqrt(3) voxels
  // and two codes longer than the way to the reconstructed surface.
  double safeStep(double distanceVoxels) const {
    const double distance = std::abs(distanceVoxels);
    return std::max(distance / (kSqrt3 * (1 + 2 * quantumVoxels_)), distance - kSqrt3 - 2 * quantumVoxels_);
  }

  // One move within a stored brick: over the voxel if a safe step leads out of it, else through it by its cubic.
  std::optional<double> crossOrAdvance(double& way, double end, glm::ivec3 voxel, std::uint32_t brickIndex) {
    const glm::dvec3 corner(voxel);
    const VoxelCorners corners = voxelCorners(level_, brickIndex, voxel - kBrickCells * brickOfVoxel(voxel));
    const double exit = exitWay(way, voxel, 1);
    const double distance = trilinear(corners, pointAt(way) - corner);
    if ((distance < 0) == isInside_) {
      const double step = safeStep(distance);
      if (way + step > exit) {
        way += step;
        return {};
      }
    }
    const double last = std::min(exit, end);
    while (true) {
      const auto crossing = firstChange(corners, corner, way, last);
      if (!crossing) break;
      if (!isInside_) return crossing;
      isInside_ = false;
      way = *crossing;
    }
    way = exit;
    return {};
  }

  // The first way in [way, last] within one voxel where the sign is no longer that of isInside_.
  std::optional<double> firstChange(const VoxelCorners& corners, glm::dvec3 corner, double way, double last) const {
    std::array<double, 4> f; // at 0, 1/3, 2/3, 1, turned so that a change is a negative value
    for (int i = 0; i < 4; ++i) {
      const double value = trilinear(corners, pointAt(way + (last - way) * i / 3.0) - corner);
      f[static_cast<std::size_t>(i)] = isInside_ ? -value : value;
    }
    if (f[0] < 0) return way;
    // The cubic through four points, in Bernstein form.
    const Cubic b{f[0], (-5 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]) / 6,
                  (2 * f[0] - 9 * f[1] + 18 * f[2] - 5 * f[3]) / 6, f[3]};
    const auto part = firstNegative(b, 0, 1);
    if (!part) return {};
    return way + (last - way) * *part;
  }

  const BrickLevel& level_;
  glm::dvec3 entryVoxels_;
  glm::dvec3 directionUnit_;
  double quantumVoxels_;
  bool isInside_ = false;
};

// Part of [tMin, tMax] in which a ray is in the closed box; nothing where it is not.
std::optional<glm::dvec2> clipToBox(const Box& box, glm::dvec3 origin, glm::dvec3 direction, double tMin, double tMax) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - origin[axis], high = box.max[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return {};
      continue;
    }
    const double a = low / direction[axis], b = high / direction[axis];
    tMin = std::max(tMin, std::min(a, b));
    tMax = std::min(tMax, std::max(a, b));
  }
  if (!(tMin <= tMax)) return {};
  return glm::dvec2(tMin, tMax);
}

} // namespace

std::optional<float> traceField(const BrickField& field, std::size_t level, glm::vec3 originObject,
                                glm::vec3 directionObject, float tMin, float tMax) {
  const glm::dvec3 origin(originObject), direction(directionObject);
  const double length = glm::length(direction);
  if (!isFinite(originObject) || !(length > 0) || !std::isfinite(length)) return {};
  const auto range = clipToBox(field.boundsObject, origin, direction, tMin, tMax);
  if (!range) return {};
  const BrickLevel& bricks = field.levels[level];
  const double voxelSize = bricks.voxelSizeObject;
  const glm::dvec3 entryVoxels = (origin + range->x * direction - glm::dvec3(field.originObject)) / voxelSize;
  const double tPerVoxel = voxelSize / length;
  const double end = (range->y - range->x) / tPerVoxel;
  const auto way = LevelWalk(bricks, entryVoxels, direction / length).firstEntry(end);
  if (!way) return {};
  // The walk may end a nudge late, and the rounding to float may leave the range by half a step.
  const double t = std::clamp(range->x + *way * tPerVoxel, range->x, range->y);
  return std::clamp(static_cast<float>(t), tMin, tMax);
}

} // namespace brickfield
