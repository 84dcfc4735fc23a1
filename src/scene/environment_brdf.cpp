// The second of the two sums of Karis 2013: what the specular lobe makes of a white environment, as a table. Integrated
// on a grid over half vectors drawn from GGX, so that every entry is the same on every machine. Twin of
// shaders/passes/environment_brdf.comp.glsl.
#include <algorithm>
#include <array>
#include <numbers>

#include "scene/brdf.h"

namespace brickfield {

namespace {

constexpr int kCosines = 64, kRoughnesses = 32; // entries at both ends of each axis
constexpr int kPolarSteps = 64, kAzimuthSteps = 24;

glm::vec2 integrate(float roughness, float nDotV) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float clamped = std::max(roughness, kLeastRoughness);
  const float alpha = clamped * clamped;
  const glm::vec3 viewer(std::sqrt(1.0f - nDotV * nDotV), 0.0f, nDotV);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < kPolarSteps; ++i) {
    // Walter et al. 2007, eq. 35: the share of GGX below a polar angle, inverted.
    const float share = (static_cast<float>(i) + 0.5f) / kPolarSteps;
    const float cosine = std::sqrt((1.0f - share) / (1.0f + (alpha * alpha - 1.0f) * share));
    const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f));
    for (int j = 0; j < kAzimuthSteps; ++j) {
      const float azimuth = kPi * (static_cast<float>(j) + 0.5f) / kAzimuthSteps; // the other half is the same
      const glm::vec3 halfway(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
      const float vDotH = glm::dot(viewer, halfway);
      const float nDotL = 2.0f * vDotH * halfway.z - nDotV;
      if (nDotL <= 0.0f || vDotH <= 0.0f) continue;
      // Density of the light's direction is D (N.H) / 4 (V.H), which leaves 4 V (N.L) (V.H) / (N.H).
      const double weight = 4.0f * visibilitySmith(alpha, nDotL, nDotV) * nDotL * vDotH / cosine;
      const double fresnel = fresnelSchlick(glm::vec3(0.0f), vDotH).x;
      sum += weight * glm::dvec2(1.0 - fresnel, fresnel);
    }
  }
  return glm::vec2(sum / static_cast<double>(kPolarSteps * kAzimuthSteps));
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
