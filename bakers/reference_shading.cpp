// Direct light as glTF 2.0, appendix B says. Environment light is the usual approximation: irradiance by nine
// harmonics, and a prefiltered mirror image times the environment BRDF (Karis 2013), both shadowed alike by occlusion
// maps and, where asked for, by what stands around. Where reflections are asked for, a ray of the specular lobe takes
// the place of the mirror image.
#include "bakers/reference_shading.h"

#include <algorithm>
#include <numbers>

#include "bakers/reference_lights.h"
#include "bakers/reference_mirror.h"
#include "scene/brdf.h"

namespace brickfield {

namespace {

constexpr float kMirrorTurn = 1e-3f; // of the rays beside a mirrored one, where nothing is rough

/// The triangle's normal on the viewer's side.
glm::vec3 sideNormalOf(const SurfaceHit& surface) {
  return surface.isBackFace ? -surface.normalTriangle : surface.normalTriangle;
}

/// Rays start off the surface on the viewer's side, by more than what rounding may have moved the point.
glm::vec3 rayStartOf(const SurfaceHit& surface) {
  return surface.position + 2.0f * surface.positionError * sideNormalOf(surface);
}

} // namespace

ReferenceShading::ReferenceShading(const ReferenceRequest& request, const ReferenceGeometry& geometry,
                                   const TextureSampler& sampler)
    : request_(request),
      lighting_(*request.lighting),
      geometry_(geometry),
      sampler_(sampler),
      fromCentres_(request.lightsFromCentres || !request.shadows),
      irradiance_(irradianceHarmonics(lighting_.environment)),
      environment_(prefilterEnvironment(lighting_.environment)) {}

MaterialSample ReferenceShading::materialOf(const SurfaceHit& surface) const {
  return surface.fieldMaterial ? *surface.fieldMaterial
                               : sampler_.sampleMaterial(*surface.material, surface.materialPoint);
}

glm::vec3 ReferenceShading::environmentLight(const Shaded& shaded, const PixelSamples& samples, int sample,
                                             int reflections) const {
  const auto& [surface, material, brdf, normal, towardsViewer] = shaded;
  const bool isHidden = request_.ambientOcclusionMetres && !isOpen(surface, basisAround(sideNormalOf(surface)),
                                                                   samples.point(sample, SamplePurpose::Occlusion));
  const glm::vec2 entry = environmentBrdf(material.roughness, glm::dot(normal, towardsViewer));
  const glm::vec3 specularShare = brdf.f0 * entry.x + entry.y;
  glm::vec3 light(0.0f);
  if (!isHidden) {
    const glm::vec3 irradiance = glm::max(evaluateHarmonics(irradiance_, normal), glm::vec3(0.0f));
    // What the specular lobe sends back does not reach the diffuse layer.
    light = (1.0f - specularShare) * brdf.diffuse * irradiance / std::numbers::pi_v<float>;
  }
  if (reflections > 0)
    light += mirroredLight(shaded, samples, sample, reflections);
  else if (!isHidden)
    light += specularShare * samplePrefiltered(environment_, glm::reflect(-towardsViewer, normal), material.roughness);
  return material.occlusion * light;
}

glm::vec3 ReferenceShading::mirroredLight(const Shaded& shaded, const PixelSamples& samples, int sample,
                                          int reflections) const {
  auto [direction, weight] =
      sampleMirrored(shaded.brdf, shaded.normal, shaded.towardsViewer, samples.point(sample, SamplePurpose::Mirror));
  if (weight == glm::vec3(0.0f)) return weight;
  // Bent normals mirror what lies below the triangle, too: as if that mirrored it back.
  const glm::vec3 side = sideNormalOf(shaded.surface);
  if (const float rising = glm::dot(direction, side); rising <= 0.0f) direction -= 2.0f * rising * side;
  const glm::vec3 origin = rayStartOf(shaded.surface);
  // The samples share the lobe.
  const float turn = (kMirrorTurn + shaded.brdf.alpha) / std::sqrt(static_cast<float>(samples.count()));
  const glm::mat3 basis = basisAround(direction);
  const auto rayTo = [&](glm::vec3 towards) { return PrimaryRay{origin, glm::normalize(towards), 0.0f}; };
  const RayBundle rays{rayTo(direction), rayTo(direction + turn * basis[0]), rayTo(direction + turn * basis[1])};
  return weight * radiance(rays, geometry_.trace(rays), samples.ofMirrored(), sample, reflections - 1);
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

glm::vec3 ReferenceShading::directLight(const Shaded& shaded, const PixelSamples& samples, int sample) const {
  glm::vec3 radiance(0.0f);
  const auto evaluate = request_.brdf == BrdfModel::BlinnPhong ? evaluateBlinnPhong : evaluateBrdf;
  for (std::uint32_t i = 0; i < lighting_.lights.size(); ++i) {
    const LightArrival arrival =
        arrivalOf(lighting_.lights[i], shaded.surface.position, samples.point(sample, SamplePurpose::Light, i));
    const float nDotL = glm::dot(shaded.normal, arrival.towardsLight);
    if (nDotL <= 0.0f || arrival.irradiance == glm::vec3(0.0f)) continue;
    const glm::vec3 answer =
        evaluate(shaded.brdf, shaded.normal, shaded.towardsViewer, arrival.towardsLight) * arrival.irradiance * nDotL;
    if (answer == glm::vec3(0.0f)) continue;
    if (request_.shadows && !isLit(shaded.surface, arrival)) continue;
    radiance += answer;
  }
  return radiance;
}

glm::vec3 ReferenceShading::radiance(const RayBundle& rays, const std::optional<SurfaceHit>& hit,
                                     const PixelSamples& samples, int sample) const {
  return radiance(rays, hit, samples, sample, request_.reflections);
}

glm::vec3 ReferenceShading::radiance(const RayBundle& rays, const std::optional<SurfaceHit>& hit,
                                     const PixelSamples& samples, int sample, int reflections) const {
  if (!hit) return sampleEnvironment(lighting_.environment, rays.center.directionWorld);
  const MaterialSample material = materialOf(*hit);
  const glm::vec3 baseColor(material.baseColor);
  if (hit->isUnlit) return baseColor;
  const Shaded shaded{*hit, material, makeBrdf(baseColor, material.metallic, material.roughness),
                      shadingNormal(*hit, material), -rays.center.directionWorld};
  return material.emission + environmentLight(shaded, samples, sample, reflections) +
         directLight(shaded, samples, sample);
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
