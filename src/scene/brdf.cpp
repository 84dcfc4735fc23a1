// The formulas of glTF 2.0, appendix B, and of KHR_lights_punctual.
#include "scene/brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brickfield {

namespace {
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kDielectricF0 = 0.04f;      // index of refraction 1.5
constexpr float kLeastViewerCosine = 1e-4f; // keeps the visibility's denominator off zero on smooth surfaces
} // namespace

SurfaceBrdf makeBrdf(glm::vec3 baseColor, float metallic, float roughness) {
  const float clamped = std::clamp(roughness, kLeastRoughness, 1.0f);
  return {baseColor * (1.0f - metallic), glm::mix(glm::vec3(kDielectricF0), baseColor, metallic), clamped * clamped};
}

float distributionGgx(float alpha, float nDotH) {
  if (nDotH <= 0.0f) return 0.0f;
  const float alphaSquared = alpha * alpha;
  const float denominator = nDotH * nDotH * (alphaSquared - 1.0f) + 1.0f;
  return alphaSquared / (kPi * denominator * denominator);
}

float visibilitySmith(float alpha, float nDotL, float nDotV) {
  if (nDotL <= 0.0f || nDotV <= 0.0f) return 0.0f;
  const float alphaSquared = alpha * alpha;
  const float light = nDotV * std::sqrt(nDotL * nDotL * (1.0f - alphaSquared) + alphaSquared);
  const float viewer = nDotL * std::sqrt(nDotV * nDotV * (1.0f - alphaSquared) + alphaSquared);
  return 0.5f / (light + viewer);
}

glm::vec3 fresnelSchlick(glm::vec3 f0, float vDotH) {
  const float rest = std::clamp(1.0f - vDotH, 0.0f, 1.0f);
  const float squared = rest * rest;
  return f0 + (1.0f - f0) * (squared * squared * rest);
}

glm::vec3 evaluateBrdf(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer, glm::vec3 towardsLight) {
  const float nDotL = glm::dot(normal, towardsLight);
  if (nDotL <= 0.0f) return glm::vec3(0.0f);
  const float nDotV = std::max(glm::dot(normal, towardsViewer), kLeastViewerCosine);
  const glm::vec3 halfway = glm::normalize(towardsViewer + towardsLight);
  const glm::vec3 fresnel = fresnelSchlick(brdf.f0, glm::dot(towardsViewer, halfway));
  const float lobe = distributionGgx(brdf.alpha, glm::dot(normal, halfway)) * visibilitySmith(brdf.alpha, nDotL, nDotV);
  return (1.0f - fresnel) * brdf.diffuse / kPi + fresnel * lobe;
}

const char* brdfModelName(BrdfModel model) { return model == BrdfModel::BlinnPhong ? "blinn-phong" : "cook-torrance"; }

float blinnPhongExponent(float alpha) { return 2.0f / (alpha * alpha) - 2.0f; }

glm::vec3 evaluateBlinnPhong(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer,
                             glm::vec3 towardsLight) {
  if (glm::dot(normal, towardsLight) <= 0.0f) return glm::vec3(0.0f);
  const float exponent = blinnPhongExponent(brdf.alpha);
  const float nDotH = std::clamp(glm::dot(normal, glm::normalize(towardsViewer + towardsLight)), 0.0f, 1.0f);
  const float scale = (exponent + 2.0f) * (exponent + 4.0f) / (8.0f * kPi * (std::exp2(-0.5f * exponent) + exponent));
  return (1.0f - brdf.f0) * brdf.diffuse / kPi + brdf.f0 * (scale * std::pow(nDotH, exponent));
}

float distanceFalloff(float distance, float range) {
  const float inverseSquare = 1.0f / (distance * distance);
  if (range <= 0.0f) return inverseSquare;
  const float share = distance / range;
  return std::clamp(1.0f - share * share * share * share, 0.0f, 1.0f) * inverseSquare;
}

float coneFalloff(float cosine, float innerConeRadians, float outerConeRadians) {
  const float outer = std::cos(outerConeRadians);
  // The extension's own least width keeps equal cones from dividing by zero.
  const float scale = 1.0f / std::max(0.001f, std::cos(innerConeRadians) - outer);
  const float share = std::clamp((cosine - outer) * scale, 0.0f, 1.0f);
  return share * share;
}

} // namespace brickfield
