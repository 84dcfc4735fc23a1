// By the normals of the lobe that the viewer sees.
#include "bakers/reference_mirror.h"

#include <algorithm>

#include "bakers/reference_samples.h"
#include "scene/visible_normals.h"

namespace brickfield {

namespace {

constexpr float kLeastNDotV = 1e-4f;

} // namespace

MirroredDirection sampleMirrored(const SurfaceBrdf& brdf, glm::vec3 normal, glm::vec3 towardsViewer, glm::vec2 square) {
  const glm::mat3 worldFromLobe = basisAround(normal);
  glm::vec3 viewer = glm::transpose(worldFromLobe) * towardsViewer;
  viewer = glm::normalize(glm::vec3(viewer.x, viewer.y, std::max(viewer.z, kLeastNDotV)));
  const glm::vec3 halfway = visibleNormal(brdf.alpha, viewer, square);
  const float vDotH = std::max(glm::dot(viewer, halfway), 0.0f);
  const glm::vec3 mirrored = 2.0f * vDotH * halfway - viewer;
  if (mirrored.z <= 0.0f) return {};
  const glm::vec3 weight = fresnelSchlick(brdf.f0, vDotH) * smithShadowing(brdf.alpha, viewer.z, mirrored.z);
  return {glm::normalize(worldFromLobe * mirrored), weight};
}

} // namespace brickfield
