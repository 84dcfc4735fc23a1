// The world field on the CPU: volumes as they were read back, and what shaders/lib/world_field.glsl makes of them, for
// tests and pictures of errors. Points are anchored: metres from FieldVolumes::anchorWorld.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace brickfield {

/// One cascade, or the one volume of a method that has no more. A texel's centre lies at
/// (lattice + 0.5) * texelSize from the anchor.
struct FieldVolume {
  glm::ivec3 firstTexel{0};         ///< lattice
  glm::ivec3 extent{0};             ///< texels
  double texelSize = 1;             ///< metres
  float rangeTexels = 0;            ///< largest magnitude that is kept
  bool isWhole = false;             ///< nothing that counts lies outside
  std::vector<float> distances;     ///< texels, negative inside; in the window's order, x fastest
  std::vector<std::uint32_t> nodes; ///< node + 1, 0 for none in range; empty where the method knows none

  bool operator==(const FieldVolume&) const = default;
};

struct FieldVolumes {
  glm::dvec3 anchorWorld{0};
  std::vector<FieldVolume> cascades; ///< finest first

  bool operator==(const FieldVolumes&) const = default;
};

struct FieldSample {
  double distanceWorld = 0; ///< metres, negative inside
  int cascade = -1;         ///< whose texels are the scale of it; -1: the point is outside all of them
};

inline constexpr std::uint32_t kFieldNodeUncertain = 0xffffffffu;

/// Trilinear; the finest cascade that holds the point, and where its range or border may have cut the value off, the
/// larger of it and the next coarser one's. Outside all a lower bound of the distance to what they hold.
///
/// cascades   at least one
/// proved by  tests/gpu/passes/world_field_test.cpp, with the shader
FieldSample sampleField(std::span<const FieldVolume> cascades, glm::dvec3 pointAnchored);

/// Of one cascade, texels, interpolated; the point is clamped to where its texels surround it.
double fieldTexels(const FieldVolume& volume, glm::dvec3 pointAnchored);

/// Whether the eight texels around the point are all held.
bool isHeld(const FieldVolume& volume, glm::dvec3 pointAnchored);

/// Metres a metre, by central differences over a texel of the cascade that answers.
glm::dvec3 fieldGradient(std::span<const FieldVolume> cascades, glm::dvec3 pointAnchored);

/// Number + 1 of the nearest node where the eight texels around the point agree, 0 where nobody is in range, else
/// kFieldNodeUncertain.
std::uint32_t fieldNode(std::span<const FieldVolume> cascades, glm::dvec3 pointAnchored);

} // namespace brickfield
