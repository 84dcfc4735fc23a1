// The light that a hit sends back: direct light of points or of whole lights, environment light, emission; and what of
// both a hit sees. Inner header of the reference.
#pragma once

#include "bakers/reference_geometry.h"
#include "bakers/reference_samples.h"
#include "scene/brdf.h"
#include "scene/light_arrival.h"
#include "scene/lighting.h"
#include "scene/prefiltered_environment.h"

namespace brickfield {

/// What every hit of an image is lit by.
class ReferenceShading {
public:
  /// What it is given must outlive it.
  ReferenceShading(const ReferenceRequest& request, const ReferenceGeometry& geometry, const TextureSampler& sampler);

  /// Radiance that a ray sees: of the surroundings, or of what it met, by one point of each light, one direction of the
  /// hemisphere and one of what is mirrored.
  ///
  /// sample  which of the pixel's samples it is
  glm::vec3 radiance(const RayBundle& rays, const std::optional<SurfaceHit>& hit, const PixelSamples& samples,
                     int sample) const;

  /// What a hit's textures, or its field, say of it.
  MaterialSample materialOf(const SurfaceHit& surface) const;

  /// Share of a light that the surface sees, by all samples of the pixel: of its solid angle, of a rectangle's area.
  float visibleShare(const SurfaceHit& surface, std::uint32_t light, const PixelSamples& samples) const;

  /// Share of the hemisphere over the triangle that is open, by the cosine and by all samples of the pixel.
  float openShare(const SurfaceHit& surface, const PixelSamples& samples) const;

private:
  /// A hit as the light that it sends back needs it.
  struct Shaded {
    const SurfaceHit& surface;
    MaterialSample material;
    SurfaceBrdf brdf;
    glm::vec3 normal;        ///< shading normal, on the viewer's side of the triangle
    glm::vec3 towardsViewer; ///< unit
  };
  /// reflections  so often may a ray still be mirrored
  glm::vec3 radiance(const RayBundle& rays, const std::optional<SurfaceHit>& hit, const PixelSamples& samples,
                     int sample, int reflections) const;
  glm::vec3 environmentLight(const Shaded& shaded, const PixelSamples& samples, int sample, int reflections) const;
  glm::vec3 mirroredLight(const Shaded& shaded, const PixelSamples& samples, int sample, int reflections) const;
  glm::vec3 directLight(const Shaded& shaded, const PixelSamples& samples, int sample) const;
  LightArrival arrivalOf(const PosedLight& light, glm::vec3 pointWorld, glm::vec2 square) const;
  bool isLit(const SurfaceHit& surface, const LightArrival& arrival) const;
  bool isOpen(const SurfaceHit& surface, const glm::mat3& basis, glm::vec2 square) const;

  const ReferenceRequest& request_;
  const Lighting& lighting_;
  const ReferenceGeometry& geometry_;
  const TextureSampler& sampler_;
  bool fromCentres_;
  std::array<glm::vec3, 9> irradiance_;
  PrefilteredEnvironment environment_;
};

/// The normal that textures leave: vertex normal bent by the normal map, both turned round on back faces (glTF 2.0,
/// 3.9.3 and doubleSided).
glm::vec3 shadingNormal(const SurfaceHit& surface, const MaterialSample& material);

} // namespace brickfield
