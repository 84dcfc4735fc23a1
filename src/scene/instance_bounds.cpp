// A skinned vertex is a mean of what its joints make of it, weighted by weights that sum to 1: it lies in the box
// around all of these, each of which lies in the joint's transformed box.
#include "scene/instance_bounds.h"

#include <cmath>

namespace brickfield {

namespace {

/// Centre and half extent of where an affine map takes a box, and a measure of the numbers that it adds up.
struct Placed {
  glm::dvec3 center, half, magnitude;
};

Placed place(const glm::dmat4& map, glm::dvec3 min, glm::dvec3 max) {
  const glm::dvec3 center = 0.5 * (min + max), half = 0.5 * (max - min);
  const glm::dvec3 farthest = glm::max(glm::abs(min), glm::abs(max));
  Placed placed{glm::dvec3(map[3]), glm::dvec3(0), glm::abs(glm::dvec3(map[3]))};
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 column(map[axis]);
    placed.center += column * center[axis];
    placed.half += glm::abs(column) * half[axis];
    placed.magnitude += glm::abs(column) * farthest[axis];
  }
  return placed;
}

bool isFinite(const Placed& placed) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(placed.magnitude[axis])) return false;
  return true;
}

float roundedDown(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest <= value ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}
float roundedUp(double value) { return -roundedDown(-value); }

} // namespace

InstanceBounds::InstanceBounds(const Primitive& primitive) : targets_(primitive.morphTargets.size()) {
  const auto extend = [](Range& range, glm::vec3 point) {
    range.min = glm::min(range.min, glm::dvec3(point)), range.max = glm::max(range.max, glm::dvec3(point));
  };
  const auto influences = static_cast<std::size_t>(primitive.influencesPerVertex);
  for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
    extend(rest_, primitive.positions[v]);
    double sum = 0;
    for (std::size_t i = v * influences; i < (v + 1) * influences; ++i) {
      if (primitive.jointWeights[i] == 0.0f) continue;
      if (primitive.joints[i] >= joints_.size()) joints_.resize(primitive.joints[i] + std::size_t{1});
      extend(joints_[primitive.joints[i]], primitive.positions[v]);
      sum += primitive.jointWeights[i];
    }
    if (influences > 0) weightError_ = std::max(weightError_, std::abs(1 - sum));
  }
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    extend(targets_[t], glm::vec3(0));
    for (const glm::vec3& offset : primitive.morphTargets[t].positions) extend(targets_[t], offset);
  }
}

InstanceBounds::Range InstanceBounds::morphed(const Range& rest, const PosedInstance& instance) const {
  Range range = rest;
  for (std::size_t t = 0; t < std::min(targets_.size(), instance.morphWeights.size()); ++t) {
    const double weight = instance.morphWeights[t];
    range.min += weight * (weight < 0 ? targets_[t].max : targets_[t].min);
    range.max += weight * (weight < 0 ? targets_[t].min : targets_[t].max);
  }
  return range;
}

Box InstanceBounds::anchored(const PosedInstance& instance, glm::dvec3 anchorWorld) const {
  const bool isSkinned = !joints_.empty() && !instance.worldFromBind.empty();
  // Twelve roundings for eight influences and a matrix, one a target, and as many again to be sure; of numbers no
  // larger than the magnitude.
  const double rounding = std::ldexp(static_cast<double>(24 + 2 * targets_.size()), -24);
  glm::dvec3 min(std::numeric_limits<double>::infinity()), max = -min, magnitude(0);
  const glm::dmat4 worldFromObject(instance.worldFromObject); // identity for skinned ones, whose draws apply it too
  const auto add = [&](const glm::dmat4& worldFromRest, const Range& rest) {
    if (!(rest.min.x <= rest.max.x)) return;
    const Range range = morphed(rest, instance);
    const Placed placed = place(worldFromRest, range.min, range.max);
    if (!isFinite(placed)) return;
    min = glm::min(min, placed.center - placed.half), max = glm::max(max, placed.center + placed.half);
    magnitude = glm::max(magnitude, placed.magnitude);
  };
  if (isSkinned)
    for (std::size_t j = 0; j < std::min(joints_.size(), instance.worldFromBind.size()); ++j)
      add(worldFromObject * glm::dmat4(instance.worldFromBind[j]), joints_[j]);
  else
    add(worldFromObject, rest_);
  Box box;
  if (!(min.x <= max.x)) return box;
  // Rigid instances never pass through floats of the world; the anchor's own magnitude covers both kinds.
  const glm::dvec3 slack =
      (rounding + (isSkinned ? weightError_ : 0.0)) * magnitude + rounding * glm::abs(min - anchorWorld);
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = roundedDown(min[axis] - anchorWorld[axis] - slack[axis]);
    box.max[axis] = roundedUp(max[axis] - anchorWorld[axis] + slack[axis]);
  }
  return box;
}

} // namespace brickfield
