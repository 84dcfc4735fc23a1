// The second of the two sums of Karis 2013: what the specular lobe makes of a white environment, as a table. Integrated
// on a grid over the normals of GGX that the viewer sees, so that every entry is the same on every machine. Twin of
// shaders/passes/environment_brdf.comp.glsl.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/brdf.h"
#include "scene/visible_normals.h"

namespace brickfield {

namespace {

constexpr int kCosines = 64, kRoughnesses = 32; // entries at both ends of each axis
constexpr int kRadialSteps = 64, kAzimuthSteps = 24;

glm::vec2 integrate(float roughness, float nDotV) {
  const float clamped = std::max(roughness, kLeastRoughness);
  const float alpha = clamped * clamped;
  const glm::vec3 viewer(std::sqrt(1.0f - nDotV * nDotV), 0.0f, nDotV);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < kRadialSteps; ++i)
    for (int j = 0; j < kAzimuthSteps; ++j) {
      // The other half of the square is the same.
      const glm::vec2 place((static_cast<float>(i) + 0.5f) / kRadialSteps,
                            0.5f * (static_cast<float>(j) + 0.5f) / kAzimuthSteps);
      const glm::vec3 halfway = visibleNormal(alpha, viewer, place);
      const float vDotH = std::max(glm::dot(viewer, halfway), 0.0f);
      const float nDotL = 2.0f * vDotH * halfway.z - nDotV;
      if (nDotL <= 0.0f) continue;
      const double weight = smithShadowing(alpha, nDotV, nDotL), fresnel = fresnelSchlick(glm::vec3(0.0f), vDotH).x;
      sum += weight * glm::dvec2(1.0 - fresnel, fresnel);
    }
  return glm::vec2(sum / static_cast<double>(kRadialSteps * kAzimuthSteps));
}

using Table = std::array<std::array<glm::vec2, kCosines>, kRoughnesses>;

const Table& table() {
  static const Table kTable = [] {
    Table entries;
    constexpr float kLeastCosine = 1e-3f; // at 0 itself light and viewer lie in the surface and the integral is 0 / 0
    for (std::size_t r = 0; r < kRoughnesses; ++r)
      for (std::size_t c = 0; c < kCosines; ++c)
        entries[r][c] = integrate(static_cast<float>(r) / (kRoughnesses - 1),
                                  std::max(static_cast<float>(c) / (kCosines - 1), kLeastCosine));
    return entries;
  }();
  return kTable;
}

} // namespace

glm::vec2 environmentBrdf(float roughness, float nDotV) {
  const float row = std::clamp(roughness, 0.0f, 1.0f) * (kRoughnesses - 1);
  const float column = std::clamp(nDotV, 0.0f, 1.0f) * (kCosines - 1);
  const std::size_t r = std::min(static_cast<std::size_t>(row), std::size_t{kRoughnesses - 2});
  const std::size_t c = std::min(static_cast<std::size_t>(column), std::size_t{kCosines - 2});
  const float between = column - static_cast<float>(c);
  return glm::mix(glm::mix(table()[r][c], table()[r][c + 1], between),
                  glm::mix(table()[r + 1][c], table()[r + 1][c + 1], between), row - static_cast<float>(r));
}

} // namespace brickfield
