// Vectors, boxes and packings that all rooms share. Conventions: right-handed, +Y up, metres, camera along -Z,
// matrices named destinationFromSource and applied to column vectors.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace brickfield {

/// Axis-aligned box; the default one is empty (min > max) and is the identity of `extend`.
struct Box {
  glm::vec3 min{std::numeric_limits<float>::infinity()};
  glm::vec3 max{-std::numeric_limits<float>::infinity()};

  bool isEmpty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  glm::vec3 center() const { return 0.5f * min + 0.5f * max; }
  glm::vec3 extent() const { return isEmpty() ? glm::vec3(0) : max - min; }
  void extend(glm::vec3 point) { min = glm::min(min, point), max = glm::max(max, point); }
  void extend(const Box& box) { min = glm::min(min, box.min), max = glm::max(max, box.max); }
  Box expanded(float margin) const { return {min - margin, max + margin}; }
  bool contains(glm::vec3 p) const {
    return glm::all(glm::lessThanEqual(min, p)) && glm::all(glm::lessThanEqual(p, max));
  }
};

/// Smallest axis-aligned box in destination space around a box of source space. Empty stays empty.
Box transformBox(const glm::mat4& destinationFromSource, const Box& boxSource);

inline bool isFinite(glm::vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }
inline bool isFinite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool isFinite(glm::vec4 v) { return isFinite(glm::vec3(v)) && std::isfinite(v.w); }
bool isFinite(const glm::mat4& matrix);

inline glm::vec3 transformPoint(const glm::mat4& destinationFromSource, glm::vec3 pointSource) {
  return glm::vec3(destinationFromSource * glm::vec4(pointSource, 1.0f));
}
inline glm::vec3 transformDirection(const glm::mat4& destinationFromSource, glm::vec3 directionSource) {
  return glm::mat3(destinationFromSource) * directionSource;
}
/// The matrix that carries normals: the cofactor matrix, which unlike the inverse transpose exists for every affine
/// transform. Its result points to the same side for a mirrored transform only after a flip by `mirrorSign`.
glm::mat3 normalMatrix(const glm::mat4& destinationFromSource);
/// -1 where the transform mirrors (negative determinant), else 1.
float mirrorSign(const glm::mat4& destinationFromSource);
/// Smallest and largest factor by which the linear part stretches a direction (singular values).
glm::vec2 scaleRange(const glm::mat4& destinationFromSource);

/// Unit vector to octahedral coordinates in [-1,1]^2 (Meyer et al. 2010) and back; twin of shaders/lib/octahedral.glsl.
glm::vec2 octahedralFromDirection(glm::vec3 direction);
glm::vec3 directionFromOctahedral(glm::vec2 octahedral);

/// IEC 61966-2-1 transfer functions, component-wise on [0,1].
float linearFromSrgb(float srgb);
float srgbFromLinear(float linear);
glm::vec3 linearFromSrgb(glm::vec3 srgb);
glm::vec3 srgbFromLinear(glm::vec3 linear);

inline std::uint32_t ceilDivide(std::uint32_t value, std::uint32_t divisor) { return (value + divisor - 1) / divisor; }

} // namespace brickfield
