// The light that a hit sends back: direct light with hard shadows, unshadowed environment light, emission. Inner header
// of the reference.
#pragma once

#include "bakers/reference_geometry.h"
#include "scene/brdf.h"
#include "scene/lighting.h"
#include "scene/prefiltered_environment.h"

namespace brickfield {

/// What every hit of an image is lit by.
class ReferenceShading {
public:
  /// Lighting and geometry must outlive it. shadows  false: nothing blocks light
  ReferenceShading(const Lighting& lighting, const ReferenceGeometry& geometry, bool shadows);

  /// Radiance towards the viewer.
  ///
  /// surface        the hit; material what its textures say there
  /// normalWorld    shading normal, on the viewer's side of the triangle
  /// towardsViewer  unit
  glm::vec3 shade(const SurfaceHit& surface, const MaterialSample& material, glm::vec3 normalWorld,
                  glm::vec3 towardsViewer) const;

  /// Radiance of the surroundings.
  glm::vec3 sky(glm::vec3 directionWorld) const;

private:
  glm::vec3 environmentLight(const SurfaceBrdf& brdf, float roughness, glm::vec3 normalWorld,
                             glm::vec3 towardsViewer) const;

  const Lighting& lighting_;
  const ReferenceGeometry& geometry_;
  bool shadows_;
  std::array<glm::vec3, 9> irradiance_;
  PrefilteredEnvironment environment_;
};

/// The normal that textures leave: vertex normal bent by the normal map, both turned round on back faces (glTF 2.0,
/// 3.9.3 and doubleSided).
glm::vec3 shadingNormal(const SurfaceHit& surface, const MaterialSample& material);

} // namespace brickfield
