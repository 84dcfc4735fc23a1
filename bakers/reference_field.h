// An SDF object as Embree traces it: one primitive of its own kind, whose rays go through the finest bricks by
// field/trace_field.cpp. Inner header of the reference.
#pragma once

#include <embree3/rtcore.h>

#include "bakers/reference_geometry.h"
#include "field/brick_field.h"

namespace brickfield {

/// Attaches a field to a scene as geometry 0; it must outlive the scene. error Failure: Embree has no memory
void attachField(RTCDevice device, RTCScene scene, const BrickField& field);

/// The surface that a ray met after `distance` metres: normal and attributes of the finest level, white and rough where
/// it has none, as the renderer draws it.
SurfaceHit fieldHit(const BrickField& field, int node, const glm::mat4& worldFromObject, const PrimaryRay& ray,
                    float distance);

/// Where the textures of a field without attributes come from; metres 0: from nowhere.
struct FieldTexturing {
  const TextureSampler* sampler = nullptr;
  const Material* material = nullptr;
  float metres = 0; ///< as sampleTriplanar takes them
};

/// Renews what fieldHit said of attributes and of the shading normal, filtered over the footprint that the rays span on
/// the surface's plane.
void textureField(const FieldTexturing& texturing, const glm::mat4& worldFromObject, const RayBundle& rays,
                  SurfaceHit& surface);

} // namespace brickfield
