// Normals of the lobe as seen by the viewer: a disk, bent to the half that faces him, on the sphere that the ellipsoid
// of the lobe is when it is drawn out.
#include "bakers/reference_mirror.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bakers/reference_samples.h"

namespace brickfield {

namespace {

constexpr float kLeastNDotV = 1e-4f;

/// Of a lobe's normals that which one point of the square stands for. viewer: in the space whose z is the normal
glm::vec3 visibleNormal(float alpha, glm::vec3 viewer, glm::vec2 square) {
  const glm::vec3 drawn = glm::normalize(glm::vec3(alpha * viewer.x, alpha * viewer.y, viewer.z));
  const float flat = drawn.x * drawn.x + drawn.y * drawn.y;
  const glm::vec3 right = flat > 0.0f ? glm::vec3(-drawn.y, drawn.x, 0.0f) / std::sqrt(flat) : glm::vec3(1, 0, 0);
  const glm::vec3 up = glm::cross(drawn, right);
  const float radius = std::sqrt(square.x), angle = 2.0f * std::numbers::pi_v<float> * square.y;
  const float x = radius * std::cos(angle), share = 0.5f * (1.0f + drawn.z);
  const float y = (1.0f - share) * std::sqrt(std::max(0.0f, 1.0f - x * x)) + share * radius * std::sin(angle);
  const glm::vec3 onSphere = x * right + y * up + std::sqrt(std::max(0.0f, 1.0f - x * x - y * y)) * drawn;
  return glm::normalize(glm::vec3(alpha * onSphere.x, alpha * onSphere.y, std::max(0.0f, onSphere.z)));
}

/// Smith's lambda: how much of a rough surface hides behind itself.
float hiddenOf(float alpha, float cosine) {
  const float square = cosine * cosine;
  return 0.5f * (std::sqrt(1.0f + alpha * alpha * (1.0f - square) / square) - 1.0f);
}

} // namespace

MirroredDirection sampleMirrored(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer, glm::vec2 square) {
  const glm::mat3 worldFromLobe = basisAround(normal);
  glm::vec3 viewer = glm::transpose(worldFromLobe) * towardsViewer;
  viewer = glm::normalize(glm::vec3(viewer.x, viewer.y, std::max(viewer.z, kLeastNDotV)));
  const glm::vec3 halfway = visibleNormal(brdf.alpha, viewer, square);
  const float vDotH = std::max(glm::dot(viewer, halfway), 0.0f);
  const glm::vec3 mirrored = 2.0f * vDotH * halfway - viewer;
  if (mirrored.z <= 0.0f) return {};
  const float ofViewer = 1.0f + hiddenOf(brdf.alpha, viewer.z);
  const glm::vec3 weight = fresnelSchlick(brdf.f0, vDotH) * (ofViewer / (ofViewer + hiddenOf(brdf.alpha, mirrored.z)));
  return {glm::normalize(worldFromLobe * mirrored), weight};
}

} // namespace brickfield
