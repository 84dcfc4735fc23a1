// Boxes under transforms, normals, octahedral packing, sRGB.
#include "core/math.h"

#include <algorithm>

namespace brickfield {

Box transformBox(const glm::mat4& destinationFromSource, const Box& boxSource) {
  if (boxSource.isEmpty()) return {};
  // Arvo 1990: each matrix entry contributes its smaller and larger product on its own.
  Box box{glm::vec3(destinationFromSource[3]), glm::vec3(destinationFromSource[3])};
  for (int column = 0; column < 3; ++column) {
    const glm::vec3 a = glm::vec3(destinationFromSource[column]) * boxSource.min[column];
    const glm::vec3 b = glm::vec3(destinationFromSource[column]) * boxSource.max[column];
    box.min += glm::min(a, b);
    box.max += glm::max(a, b);
  }
  return box;
}

bool isFinite(const glm::mat4& matrix) {
  for (int column = 0; column < 4; ++column)
    if (!isFinite(matrix[column])) return false;
  return true;
}

glm::mat3 normalMatrix(const glm::mat4& destinationFromSource) {
  const glm::mat3 m(destinationFromSource);
  return glm::mat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
}

float mirrorSign(const glm::mat4& destinationFromSource) {
  return glm::determinant(glm::mat3(destinationFromSource)) < 0.0f ? -1.0f : 1.0f;
}

glm::vec2 scaleRange(const glm::mat4& destinationFromSource) {
  // Singular values of M are the roots of the eigenvalues of MᵀM, a symmetric 3x3 matrix: closed form (Smith 1961).
  const glm::dmat3 m(destinationFromSource);
  const glm::dmat3 s = glm::transpose(m) * m;
  const double offDiagonal = s[1][0] * s[1][0] + s[2][0] * s[2][0] + s[2][1] * s[2][1];
  const double q = (s[0][0] + s[1][1] + s[2][2]) / 3.0;
  const double p2 =
      (s[0][0] - q) * (s[0][0] - q) + (s[1][1] - q) * (s[1][1] - q) + (s[2][2] - q) * (s[2][2] - q) + 2.0 * offDiagonal;
  const double p = std::sqrt(p2 / 6.0);
  if (!(p > 0.0)) return glm::vec2(static_cast<float>(std::sqrt(std::max(q, 0.0))));
  const glm::dmat3 b = (s - q * glm::dmat3(1.0)) / p;
  const double r = std::clamp(glm::determinant(b) / 2.0, -1.0, 1.0);
  constexpr double kThirdOfTurn = 2.0943951023931953;
  const double phi = std::acos(r) / 3.0;
  const double largest = q + 2.0 * p * std::cos(phi);
  const double smallest = q + 2.0 * p * std::cos(phi + kThirdOfTurn);
  return {static_cast<float>(std::sqrt(std::max(smallest, 0.0))),
          static_cast<float>(std::sqrt(std::max(largest, 0.0)))};
}

glm::vec2 octahedralFromDirection(glm::vec3 direction) {
  const glm::vec3 d = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  if (d.z >= 0.0f) return glm::vec2(d);
  return {(1.0f - std::abs(d.y)) * (d.x >= 0.0f ? 1.0f : -1.0f), (1.0f - std::abs(d.x)) * (d.y >= 0.0f ? 1.0f : -1.0f)};
}

glm::vec3 directionFromOctahedral(glm::vec2 octahedral) {
  glm::vec3 d(octahedral, 1.0f - std::abs(octahedral.x) - std::abs(octahedral.y));
  const float fold = std::max(-d.z, 0.0f);
  d.x += d.x >= 0.0f ? -fold : fold;
  d.y += d.y >= 0.0f ? -fold : fold;
  return glm::normalize(d);
}

float linearFromSrgb(float srgb) { return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f); }
float srgbFromLinear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}
glm::vec3 linearFromSrgb(glm::vec3 srgb) {
  return {linearFromSrgb(srgb.x), linearFromSrgb(srgb.y), linearFromSrgb(srgb.z)};
}
glm::vec3 srgbFromLinear(glm::vec3 linear) {
  return {srgbFromLinear(linear.x), srgbFromLinear(linear.y), srgbFromLinear(linear.z)};
}

} // namespace brickfield
