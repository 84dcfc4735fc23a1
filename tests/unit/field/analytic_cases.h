// Bodies with a closed-form distance, their fields and how exactly a field may be expected to hold them.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "field/analytic.h"
#include "field/brick_layout.h"

namespace brickfield::test {

struct Body {
  std::string name;
  DistanceFunction distance;
  Box surface;
  /// Largest principal curvature of any level set at a point, 1/m; infinite where the distance has a kink near by.
  std::function<float(glm::vec3 point, float reach)> curvature;
};

inline constexpr float kRing = 1.0f, kTube = 0.4f, kRadius = 0.9f;
inline const glm::vec3 kCenter{0.3f, -0.2f, 0.1f};
inline const glm::vec3 kHalfExtent{0.8f, 0.5f, 0.3f};

inline Body sphereBody() {
  return {"sphere",
          [](glm::vec3 p) { return sphereDistance(p, kCenter, kRadius); },
          {kCenter - kRadius, kCenter + kRadius},
          [](glm::vec3 p, float reach) { return 1.0f / std::max(glm::length(p - kCenter) - reach, 0.0f); }};
}

inline Body torusBody() {
  const glm::vec3 reachOut(kRing + kTube, kTube, kRing + kTube);
  // The level sets are tori: curvature 1/(distance to the ring) across, at most 1/(distance to the axis) along.
  return {"torus",
          [](glm::vec3 p) { return torusDistance(p, kCenter, kRing, kTube); },
          {kCenter - reachOut, kCenter + reachOut},
          [](glm::vec3 p, float reach) {
            const float toRing = torusDistance(p, kCenter, kRing, 0.0f) - reach;
            const float toAxis = glm::length(glm::vec2(p.x - kCenter.x, p.z - kCenter.z)) - reach;
            return 1.0f / std::max(std::min(toRing, toAxis), 0.0f);
          }};
}

inline Body boxBody() {
  // Flat where one face alone is nearest for all within reach; kinks and edges elsewhere.
  return {"box",
          [](glm::vec3 p) { return boxDistance(p, kCenter, kHalfExtent); },
          {kCenter - kHalfExtent, kCenter + kHalfExtent},
          [](glm::vec3 p, float reach) {
            const glm::vec3 beyond = glm::abs(p - kCenter) - kHalfExtent;
            for (int axis = 0; axis < 3; ++axis) {
              const float a = beyond[(axis + 1) % 3], b = beyond[(axis + 2) % 3];
              const bool overFace = beyond[axis] > 2 * reach && std::max(a, b) < -reach;
              const bool underFace = beyond[axis] > std::max(a, b) + 2 * reach && beyond[axis] < -reach;
              const bool acrossFace = std::abs(beyond[axis]) <= 2 * reach && std::max(a, b) < -4 * reach;
              const bool sameSide = std::abs(p[axis] - kCenter[axis]) > reach;
              if (sameSide && (overFace || underFace || acrossFace)) return 0.0f;
            }
            return std::numeric_limits<float>::infinity();
          }};
}

inline std::vector<Body> bodies() { return {sphereBody(), torusBody(), boxBody()}; }

inline BrickField fieldOf(const Body& body, int resolution, int bits, int mips) {
  return makeAnalyticField(body.distance, body.surface, resolution, bits, mips);
}

/// One code of a level in voxels.
inline float codeVoxels(const BrickLevel& level) {
  return level.rangeVoxels / (level.format == DistanceFormat::R8Snorm ? 127.0f : 32767.0f);
}

/// By how many voxels trilinear reconstruction of exact samples may miss the distance at a point.
/// Linear interpolation of f along an axis misses by at most h^2/8 max|f''|; three axes add up, and no second
/// derivative of a distance is above the largest curvature within the voxel, whose points are at most sqrt(3) h away.
/// Where the curvature says nothing, the distance is 1-Lipschitz and the weighted mean way to the corners is at most
/// sqrt(3)/2.
inline float trilinearErrorVoxels(const Body& body, glm::vec3 pointObject, float voxelSize) {
  const float curvature = body.curvature(pointObject, 1.7320509f * voxelSize);
  return std::min(3.0f / 8.0f * curvature * voxelSize, 0.8660255f);
}

/// Rounding of single-precision points and distances of bodies of about 1 m, in voxels.
inline float floatErrorVoxels(float voxelSize) { return 2e-6f / voxelSize; }

class Random {
public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  // Not the library's distributions: they differ from one library to the next.
  float unit() { return static_cast<float>(engine_() >> 8) / static_cast<float>(1u << 24); }
  float between(float low, float high) { return low + (high - low) * unit(); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(engine_()); }
  glm::vec3 in(const Box& box) { return box.min + box.extent() * glm::vec3(unit(), unit(), unit()); }
  glm::vec3 direction() {
    const float z = between(-1, 1), angle = between(0, 6.2831853f), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

private:
  std::mt19937 engine_;
};

} // namespace brickfield::test
