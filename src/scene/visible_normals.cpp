// A disk, bent to the half that faces the viewer, on the sphere that the ellipsoid of the lobe is when it is drawn out.
#include "scene/visible_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brickfield {

namespace {

/// Smith's lambda: how much of a rough surface hides behind itself.
float smithLambda(float alpha, float cosine) {
  const float square = cosine * cosine;
  return 0.5f * (std::sqrt(1.0f + alpha * alpha * (1.0f - square) / square) - 1.0f);
}

} // namespace

glm::vec3 visibleNormal(float alpha, glm::vec3 viewer, glm::vec2 square) {
  const glm::vec3 drawn = glm::normalize(glm::vec3(alpha * viewer.x, alpha * viewer.y, viewer.z));
  const float flat = drawn.x * drawn.x + drawn.y * drawn.y;
  const glm::vec3 right = flat > 0.0f ? glm::vec3(-drawn.y, drawn.x, 0.0f) / std::sqrt(flat) : glm::vec3(0, 1, 0);
  const glm::vec3 up = glm::cross(drawn, right);
  const float radius = std::sqrt(square.x), angle = 2.0f * std::numbers::pi_v<float> * (square.y - 0.25f);
  const float x = radius * std::cos(angle), share = 0.5f * (1.0f + drawn.z);
  const float y = (1.0f - share) * std::sqrt(std::max(0.0f, 1.0f - x * x)) + share * radius * std::sin(angle);
  const glm::vec3 onSphere = x * right + y * up + std::sqrt(std::max(0.0f, 1.0f - x * x - y * y)) * drawn;
  return glm::normalize(glm::vec3(alpha * onSphere.x, alpha * onSphere.y, std::max(0.0f, onSphere.z)));
}

float smithShadowing(float alpha, float nDotV, float nDotL) {
  const float ofViewer = 1.0f + smithLambda(alpha, nDotV);
  return ofViewer / (ofViewer + smithLambda(alpha, nDotL));
}

} // namespace brickfield
