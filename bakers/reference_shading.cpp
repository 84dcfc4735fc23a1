// Direct light as glTF 2.0, appendix B says. Environment light is the usual approximation: irradiance by nine
// harmonics, and a prefiltered mirror image times the environment BRDF (Karis 2013), neither of them shadowed but by
// occlusion maps.
#include "bakers/reference_shading.h"

#include <algorithm>
#include <numbers>

#include "scene/brdf.h"
#include "scene/light_arrival.h"

namespace brickfield {

ReferenceShading::ReferenceShading(const Lighting& lighting, const ReferenceGeometry& geometry, bool shadows)
    : lighting_(lighting),
      geometry_(geometry),
      shadows_(shadows),
      irradiance_(irradianceHarmonics(lighting.environment)),
      environment_(prefilterEnvironment(lighting.environment)) {}

glm::vec3 ReferenceShading::sky(glm::vec3 directionWorld) const {
  return sampleEnvironment(lighting_.environment, directionWorld);
}

glm::vec3 ReferenceShading::environmentLight(const SurfaceBrdf& brdf, float roughness, glm::vec3 normalWorld,
                                             glm::vec3 towardsViewer) const {
  const glm::vec3 irradiance = glm::max(evaluateHarmonics(irradiance_, normalWorld), glm::vec3(0.0f));
  const glm::vec2 entry = environmentBrdf(roughness, glm::dot(normalWorld, towardsViewer));
  const glm::vec3 specularShare = brdf.f0 * entry.x + entry.y;
  const glm::vec3 mirrored = samplePrefiltered(environment_, glm::reflect(-towardsViewer, normalWorld), roughness);
  // What the specular lobe sends back does not reach the diffuse layer.
  return (1.0f - specularShare) * brdf.diffuse * irradiance / std::numbers::pi_v<float> + specularShare * mirrored;
}

glm::vec3 ReferenceShading::shade(const SurfaceHit& surface, const MaterialSample& material, glm::vec3 normalWorld,
                                  glm::vec3 towardsViewer) const {
  const glm::vec3 baseColor(material.baseColor);
  if (surface.material->unlit) return baseColor;
  const SurfaceBrdf brdf = makeBrdf(baseColor, material.metallic, material.roughness);
  glm::vec3 radiance =
      material.emission + material.occlusion * environmentLight(brdf, material.roughness, normalWorld, towardsViewer);

  // Shadow rays start off the surface on the viewer's side, by more than what rounding may have moved the point.
  const glm::vec3 sideNormal = surface.isBackFace ? -surface.normalTriangle : surface.normalTriangle;
  const glm::vec3 start = surface.position + 2.0f * surface.positionError * sideNormal;
  for (const PosedLight& light : lighting_.lights) {
    const LightArrival arrival = lightArrivalAt(light, surface.position);
    const float nDotL = glm::dot(normalWorld, arrival.towardsLight);
    if (nDotL <= 0.0f || arrival.irradiance == glm::vec3(0.0f)) continue;
    const glm::vec3 answer =
        evaluateBrdf(brdf, normalWorld, towardsViewer, arrival.towardsLight) * arrival.irradiance * nDotL;
    if (answer == glm::vec3(0.0f)) continue;
    if (shadows_ && geometry_.isOccluded(start, arrival.towardsLight, arrival.distance)) continue;
    radiance += answer;
  }
  return radiance;
}

glm::vec3 shadingNormal(const SurfaceHit& surface, const MaterialSample& material) {
  glm::vec3 normal = surface.normalVertex;
  if (surface.material->normalTexture.isUsed() && surface.tangent != glm::vec3(0.0f)) {
    const glm::vec3 bent = material.normalTangent.x * surface.tangent + material.normalTangent.y * surface.bitangent +
                           material.normalTangent.z * surface.normalVertex;
    const float length = glm::length(bent);
    if (length > 0.0f) normal = bent / length;
  }
  return surface.isBackFace ? -normal : normal;
}

} // namespace brickfield
