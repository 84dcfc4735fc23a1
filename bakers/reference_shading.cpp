// Direct light as glTF 2.0, appendix B says. Environment light is the usual approximation: irradiance by nine
// harmonics, and a prefiltered mirror image times the environment BRDF (Karis 2013), both shadowed alike by occlusion
// maps and, where asked for, by what stands around.
#include "bakers/reference_shading.h"

#include <algorithm>
#include <numbers>

#include "bakers/reference_lights.h"
#include "scene/brdf.h"

namespace brickfield {

namespace {

/// The triangle's normal on the viewer's side.
glm::vec3 sideNormalOf(const SurfaceHit& surface) {
  return surface.isBackFace ? -surface.normalTriangle : surface.normalTriangle;
}

/// Rays start off the surface on the viewer's side, by more than what rounding may have moved the point.
glm::vec3 rayStartOf(const SurfaceHit& surface) {
  return surface.position + 2.0f * surface.positionError * sideNormalOf(surface);
}

} // namespace

ReferenceShading::ReferenceShading(const ReferenceRequest& request, const ReferenceGeometry& geometry)
    : request_(request),
      lighting_(*request.lighting),
      geometry_(geometry),
      fromCentres_(request.lightsFromCentres || !request.shadows),
      irradiance_(irradianceHarmonics(lighting_.environment)),
      environment_(prefilterEnvironment(lighting_.environment)) {}

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

LightArrival ReferenceShading::arrivalOf(const PosedLight& light, glm::vec3 pointWorld, glm::vec2 square) const {
  return fromCentres_ ? lightArrivalAt(light, pointWorld) : sampleLight(light, pointWorld, square);
}

bool ReferenceShading::isOpen(const SurfaceHit& surface, const glm::mat3& basis, glm::vec2 square) const {
  return !geometry_.isOccluded(rayStartOf(surface), directionByCosine(basis, square), *request_.ambientOcclusionMetres);
}

bool ReferenceShading::isLit(const SurfaceHit& surface, const LightArrival& arrival) const {
  // The point of the light itself has no direction to it, and nothing in the way.
  if (arrival.towardsLight == glm::vec3(0.0f)) return true;
  // What is below the triangle's horizon the triangle hides, though a ray that starts off it may slip past its edge.
  if (glm::dot(sideNormalOf(surface), arrival.towardsLight) <= 0.0f) return false;
  return !geometry_.isOccluded(rayStartOf(surface), arrival.towardsLight, arrival.distance);
}

float ReferenceShading::visibleShare(const SurfaceHit& surface, std::uint32_t light,
                                     const PixelSamples& samples) const {
  const PosedLight& posed = lighting_.lights[light];
  const int count = fromCentres_ || !hasExtent(posed.light) ? 1 : samples.count();
  int seen = 0;
  for (int sample = 0; sample < count; ++sample)
    seen += isLit(surface, arrivalOf(posed, surface.position, samples.point(sample, SamplePurpose::LightLayer, light)));
  return static_cast<float>(seen) / static_cast<float>(count);
}

float ReferenceShading::openShare(const SurfaceHit& surface, const PixelSamples& samples) const {
  const glm::mat3 basis = basisAround(sideNormalOf(surface));
  int open = 0;
  for (int sample = 0; sample < samples.count(); ++sample)
    open += isOpen(surface, basis, samples.point(sample, SamplePurpose::OcclusionLayer));
  return static_cast<float>(open) / static_cast<float>(samples.count());
}

glm::vec3 ReferenceShading::shade(const SurfaceHit& surface, const MaterialSample& material, glm::vec3 normalWorld,
                                  glm::vec3 towardsViewer, const PixelSamples& samples, int sample) const {
  const glm::vec3 baseColor(material.baseColor);
  if (surface.isUnlit) return baseColor;
  const SurfaceBrdf brdf = makeBrdf(baseColor, material.metallic, material.roughness);
  glm::vec3 radiance = material.emission;
  const bool isHidden = request_.ambientOcclusionMetres && !isOpen(surface, basisAround(sideNormalOf(surface)),
                                                                   samples.point(sample, SamplePurpose::Occlusion));
  if (!isHidden)
    radiance += material.occlusion * environmentLight(brdf, material.roughness, normalWorld, towardsViewer);

  for (std::uint32_t i = 0; i < lighting_.lights.size(); ++i) {
    const LightArrival arrival =
        arrivalOf(lighting_.lights[i], surface.position, samples.point(sample, SamplePurpose::Light, i));
    const float nDotL = glm::dot(normalWorld, arrival.towardsLight);
    if (nDotL <= 0.0f || arrival.irradiance == glm::vec3(0.0f)) continue;
    const auto evaluate = request_.brdf == BrdfModel::BlinnPhong ? evaluateBlinnPhong : evaluateBrdf;
    const glm::vec3 answer =
        evaluate(brdf, normalWorld, towardsViewer, arrival.towardsLight) * arrival.irradiance * nDotL;
    if (answer == glm::vec3(0.0f)) continue;
    if (request_.shadows && !isLit(surface, arrival)) continue;
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
  if (surface.normalMapped) normal = *surface.normalMapped;
  return surface.isBackFace ? -normal : normal;
}

} // namespace brickfield
