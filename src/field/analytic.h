// Exact signed distances of simple bodies, and the baker that turns any exact distance function into a BrickField:
// what tests compare against and what fields without a mesh are made of. It reads no meshes.
#pragma once

#include <functional>

#include "field/brick_field.h"

namespace brickfield {

// Signed distances in the unit of the point, negative inside, exact everywhere.
// source  Hart 1996, appendix A; the torus and the box are the textbook forms
float sphereDistance(glm::vec3 point, glm::vec3 center, float radius);
float boxDistance(glm::vec3 point, glm::vec3 center, glm::vec3 halfExtent);
/// The torus around the y axis through `center`; 0 < tubeRadius < ringRadius.
float torusDistance(glm::vec3 point, glm::vec3 center, float ringRadius, float tubeRadius);
/// The half space below a plane; normal of unit length, distance 0 where dot(point, normal) = offset.
float planeDistance(glm::vec3 point, glm::vec3 normal, float offset);

using DistanceFunction = std::function<float(glm::vec3 pointObject)>;

/// Bakes a field: bricks near the surface, bounds elsewhere, the coarsest level whole in 16 bits without clamping.
///
/// distance      metres of object space, negative inside, exact or short (|d| never above the true one, 1-Lipschitz)
/// boundsSurface a box around the surface; a surface that reaches beyond is cut off where the box and a voxel end
/// resolution    voxels along the longest side, 8 to 1024
/// bits          8 or 16, of all levels but the coarsest
/// mips          levels, as layoutGrid
/// returns       a field that validateField accepts, without attributes
/// error         BadInput: as layoutGrid; a distance that is not finite
/// bound         a sample is off by half a code, for small negative distances by up to one
/// proved by     tests/unit/field/analytic_test.cpp
BrickField makeAnalyticField(const DistanceFunction& distance, Box boundsSurface, int resolution, int bits, int mips);

/// Attributes of one surface point, linear light.
struct SurfaceAttributes {
  glm::vec4 baseColor{1}; ///< linear; stored with the sRGB transfer
  float metallic = 0;
  float roughness = 1;
  float occlusion = 1;
  bool unlit = false;
  glm::vec3 emission{0};
};

/// Fills the attribute arrays of every level. `attributes` gets where the sample lies and answers for the surface
/// point closest to it. The emission stays empty in levels that emit nothing.
void addAttributes(BrickField& field, const std::function<SurfaceAttributes(glm::vec3 pointObject)>& attributes);

} // namespace brickfield
