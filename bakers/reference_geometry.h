// The posed triangles in Embree: one hierarchy a mesh, shared by its rigid instances; one of its own for each deformed
// instance; SDF objects that are traced as such are one primitive of their own kind. Culls back faces and cuts alpha
// masks while rays travel. Inner header of the reference.
//
//   world --instanceFromWorld (Embree)--> the space of PosedInstance::worldFromObject --> triangles
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "bakers/reference.h"
#include "core/progress.h"
#include "scene/pose.h"
#include "scene/texture_sampling.h"
#include "scene/view.h"

namespace brickfield {

/// A ray with its neighbours one step to the right and one down: they span its footprint.
struct RayBundle {
  PrimaryRay center, right, down;
};

/// Where a ray met a surface, in world space.
struct SurfaceHit {
  float distance = 0; ///< metres along the ray from its origin
  int node = -1;
  const Primitive* primitive = nullptr;
  const Material* material = nullptr;
  glm::vec3 position{0.0f};
  float positionError = 0;        ///< metres: bound of the rounding in position
  glm::vec3 normalTriangle{0.0f}; ///< unit, on the triangle's front side
  glm::vec3 normalVertex{0.0f};   ///< unit, interpolated; the triangle's own where flatNormals
  glm::vec3 tangent{0.0f};        ///< unit, interpolated; zero where the primitive has none
  glm::vec3 bitangent{0.0f};
  bool isBackFace = false;
  MaterialPoint materialPoint; ///< with the footprint of the bundle
  /// Of a field: what its bricks store; material is the default one then.
  std::optional<MaterialSample> fieldMaterial;
  std::optional<glm::vec3> normalMapped; ///< of a textured field: unit, on normalVertex' side
  bool isUnlit = false;
};

/// Refers to the scene, the pose, the fields and the sampler, which must outlive it.
class ReferenceGeometry {
public:
  /// Builds all hierarchies with the threads of the surrounding task arena.
  /// error Failure from Embree; Cancelled; BadInput where geometry reaches beyond 1e11 metres
  ReferenceGeometry(const Scene& scene, const Pose& pose, const ReferenceFields& fields, const TextureSampler& sampler,
                    const Progress& progress);
  ~ReferenceGeometry();
  ReferenceGeometry(const ReferenceGeometry&) = delete;
  ReferenceGeometry& operator=(const ReferenceGeometry&) = delete;

  /// First visible surface from the bundle's near plane on: back faces of single-sided materials and the holes of masks
  /// let the ray pass.
  std::optional<SurfaceHit> trace(const RayBundle& rays) const;

  /// Whether anything but a hole of a mask lies between two points of a ray. Both sides of every surface block.
  bool isOccluded(glm::vec3 originWorld, glm::vec3 directionWorld, float distance) const;

private:
  struct Device;
  std::unique_ptr<Device> device_;
};

} // namespace brickfield
