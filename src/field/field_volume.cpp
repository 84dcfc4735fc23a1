// In double what the shaders do in float.
#include "field/field_volume.h"

#include <algorithm>
#include <cmath>

namespace brickfield {

namespace {

std::size_t indexOf(const FieldVolume& volume, glm::ivec3 inWindow) {
  const glm::ivec3 at = glm::clamp(inWindow, glm::ivec3(0), volume.extent - 1);
  return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(volume.extent.y) + static_cast<std::size_t>(at.y)) *
             static_cast<std::size_t>(volume.extent.x) +
         static_cast<std::size_t>(at.x);
}

glm::dvec3 inWindow(const FieldVolume& volume, glm::dvec3 pointAnchored) {
  return pointAnchored / volume.texelSize - glm::dvec3(volume.firstTexel);
}

/// From the nearest side of the window, texels.
double depthOf(const FieldVolume& volume, glm::dvec3 pointAnchored) {
  const glm::dvec3 at = inWindow(volume, pointAnchored);
  const glm::dvec3 nearest = glm::min(at, glm::dvec3(volume.extent) - at);
  return std::min({nearest.x, nearest.y, nearest.z});
}

bool isCut(const FieldVolume& volume, double texels, double depth) {
  return std::abs(texels) > volume.rangeTexels - 1.0 || (!volume.isWhole && texels > depth - 1.5);
}

glm::dvec3 clampedToTexels(const FieldVolume& volume, glm::dvec3 at) {
  return glm::clamp(at, glm::dvec3(0.5), glm::dvec3(volume.extent) - 0.5);
}

} // namespace

bool isHeld(const FieldVolume& volume, glm::dvec3 pointAnchored) { return depthOf(volume, pointAnchored) >= 0.5; }

double fieldTexels(const FieldVolume& volume, glm::dvec3 pointAnchored) {
  const glm::dvec3 at = clampedToTexels(volume, inWindow(volume, pointAnchored)) - 0.5;
  const glm::dvec3 lowest = glm::floor(at), part = at - lowest;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) weight *= step[axis] ? part[axis] : 1 - part[axis];
    sum += weight * double{volume.distances[indexOf(volume, glm::ivec3(lowest) + step)]};
  }
  return sum;
}

FieldSample sampleField(std::span<const FieldVolume> cascades, glm::dvec3 pointAnchored) {
  FieldSample sample;
  for (std::size_t c = 0; c < cascades.size(); ++c) {
    const FieldVolume& volume = cascades[c];
    if (!isHeld(volume, pointAnchored)) continue;
    const double texels = fieldTexels(volume, pointAnchored), metres = texels * volume.texelSize;
    if (sample.cascade < 0)
      sample = {metres, static_cast<int>(c)};
    else
      sample.distanceWorld =
          sample.distanceWorld < 0 ? std::min(sample.distanceWorld, metres) : std::max(sample.distanceWorld, metres);
    if (!isCut(volume, texels, depthOf(volume, pointAnchored))) break;
  }
  if (sample.cascade >= 0) return sample;
  const FieldVolume& last = cascades.back();
  const glm::dvec3 at = inWindow(last, pointAnchored);
  const double outside = glm::distance(at, clampedToTexels(last, at));
  sample.distanceWorld = std::hypot(std::max(fieldTexels(last, pointAnchored), 0.0), outside) * last.texelSize;
  return sample;
}

glm::dvec3 fieldGradient(std::span<const FieldVolume> cascades, glm::dvec3 pointAnchored) {
  const int answering = sampleField(cascades, pointAnchored).cascade;
  const double h = 0.5 * (answering < 0 ? cascades.back() : cascades[static_cast<std::size_t>(answering)]).texelSize;
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 offset(0);
    offset[axis] = h;
    gradient[axis] = sampleField(cascades, pointAnchored + offset).distanceWorld -
                     sampleField(cascades, pointAnchored - offset).distanceWorld;
  }
  return gradient / (2 * h);
}

std::uint32_t fieldNode(std::span<const FieldVolume> cascades, glm::dvec3 pointAnchored) {
  bool isSplit = false;
  for (const FieldVolume& volume : cascades) {
    if (volume.nodes.empty() || !isHeld(volume, pointAnchored)) continue;
    const glm::ivec3 lowest(glm::floor(inWindow(volume, pointAnchored) - 0.5));
    std::uint32_t least = kFieldNodeUncertain, most = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const std::uint32_t node =
          volume.nodes[indexOf(volume, lowest + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))];
      least = std::min(least, node);
      most = std::max(most, node);
    }
    if (least == most && most != 0) return most;
    if (least != 0) return kFieldNodeUncertain;
    isSplit = isSplit || most != 0;
  }
  return isSplit ? kFieldNodeUncertain : 0;
}

} // namespace brickfield
