// User geometry of Embree around traceField. Instances hand rays over in object space with the direction not made unit,
// so that the ray's parameter stays the world's.
#include "bakers/reference_field.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "field/card_crossing.h"
#include "field/surface_attributes.h"
#include "scene/triplanar.h"

namespace brickfield {

namespace {

constexpr std::size_t kFinest = 0;
constexpr int kMostCuts = 16;
constexpr float kPastCutVoxels = 1e-2f; // beyond the hit, far enough that its own rounding is not met again

void boundsOf(const RTCBoundsFunctionArguments* arguments) {
  const Box& box = static_cast<const BrickField*>(arguments->geometryUserPtr)->boundsObject;
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = box.min.x, bounds.lower_y = box.min.y, bounds.lower_z = box.min.z;
  bounds.upper_x = box.max.x, bounds.upper_y = box.max.y, bounds.upper_z = box.max.z;
}

/// Where the surface is cut away (masks, backs of single-sided sheets) a ray goes on behind it, as in
/// shaders/lib/sdf_hit.glsl.
std::optional<float> meetField(const BrickField& field, const RTCRay& ray) {
  const glm::vec3 origin(ray.org_x, ray.org_y, ray.org_z), direction(ray.dir_x, ray.dir_y, ray.dir_z);
  float from = ray.tnear;
  for (int cut = 0; cut < kMostCuts; ++cut) {
    const std::optional<float> met = traceField(field, kFinest, origin, direction, from, ray.tfar);
    if (!met) return std::nullopt;
    if (isCovered(field, kFinest, origin + *met * direction, direction, false)) return met;
    from = *met + kPastCutVoxels * field.levels[kFinest].voxelSizeObject / glm::length(direction);
  }
  return std::nullopt;
}

// Embree calls both with one ray at a time, as we only ask for one.
void intersectField(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  auto& query = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const auto met = meetField(*static_cast<const BrickField*>(arguments->geometryUserPtr), query.ray);
  if (!met) return;
  query.ray.tfar = *met;
  query.hit.geomID = arguments->geomID;
  query.hit.primID = arguments->primID;
  query.hit.instID[0] = arguments->context->instID[0];
}

void occludeField(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
  if (meetField(*static_cast<const BrickField*>(arguments->geometryUserPtr), ray))
    ray.tfar = -std::numeric_limits<float>::infinity();
}

MaterialSample materialOfField(const SurfaceAttributes& attributes) {
  MaterialSample material;
  material.baseColor = attributes.baseColor;
  material.metallic = attributes.metallic;
  material.roughness = attributes.roughness;
  material.occlusion = attributes.occlusion;
  material.emission = attributes.emission;
  return material;
}

} // namespace

void attachField(RTCDevice device, RTCScene scene, const BrickField& field) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  if (!geometry) throw Failure("Embree has no memory for a field");
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<BrickField*>(&field));
  rtcSetGeometryBoundsFunction(geometry, boundsOf, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersectField);
  rtcSetGeometryOccludedFunction(geometry, occludeField);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, 0);
  rtcReleaseGeometry(geometry);
}

SurfaceHit fieldHit(const BrickField& field, int node, const glm::mat4& worldFromObject, const PrimaryRay& ray,
                    float distance) {
  static const Material kPlain;
  SurfaceHit surface;
  surface.distance = distance;
  surface.node = node;
  surface.material = &kPlain;
  surface.position = ray.originWorld + distance * ray.directionWorld;
  // Rounding of the sum and of the way, and half of three codes of 8 bits (4 / 127 voxel each): stored distances make a
  // flat surface ripple by about that, and shadow rays that start in a trough would meet the next crest.
  const glm::vec3 terms = glm::abs(ray.originWorld) + glm::abs(distance * ray.directionWorld);
  constexpr float kRoundings = 16.0f / 16777216.0f, kRippleVoxels = 1.5f * 4.0f / 127.0f;
  surface.positionError = kRoundings * std::max({terms.x, terms.y, terms.z}) +
                          kRippleVoxels * field.levels[kFinest].voxelSizeObject * scaleRange(worldFromObject).x;

  const glm::dvec4 pointWorld(glm::dvec3(ray.originWorld) + double{distance} * glm::dvec3(ray.directionWorld), 1.0);
  const glm::vec3 pointObject(glm::inverse(glm::dmat4(worldFromObject)) * pointWorld);
  // The cofactor matrix of a mirrored object turns normals round: the sign undoes that.
  const glm::vec3 normal =
      mirrorSign(worldFromObject) * (normalMatrix(worldFromObject) * fieldNormal(field, kFinest, pointObject));
  const float length = glm::length(normal);
  surface.normalTriangle = length > 0.0f && std::isfinite(length) ? normal / length : -ray.directionWorld;
  surface.normalVertex = surface.normalTriangle;
  SurfaceAttributes attributes;
  attributes.baseColor = glm::vec4(1.0f);
  attributes.metallic = 0.0f;
  attributes.roughness = attributes.occlusion = 1.0f;
  attributes = attributesAt(field, kFinest, pointObject).value_or(attributes);
  surface.fieldMaterial = materialOfField(attributes);
  surface.isUnlit = attributes.unlit;
  return surface;
}

void textureField(const FieldTexturing& texturing, const glm::mat4& worldFromObject, const RayBundle& rays,
                  SurfaceHit& surface) {
  constexpr float kLeastFacing = 0.05f; // as in shaders/passes/triplanar.frag.glsl
  const glm::dmat4 objectFromWorld = glm::inverse(glm::dmat4(worldFromObject));
  const glm::vec3 normalWorld = surface.normalTriangle;
  const bool isBack = glm::dot(normalWorld, rays.center.directionWorld) > 0;
  const glm::vec3 towardsViewer = isBack ? -normalWorld : normalWorld;
  TriplanarPoint at;
  at.pointObject = glm::vec3(objectFromWorld * glm::dvec4(glm::dvec3(surface.position), 1));
  at.normalObject = glm::normalize(glm::transpose(glm::mat3(worldFromObject)) * towardsViewer);
  for (int side = 0; side < 2; ++side) {
    const PrimaryRay& ray = side == 0 ? rays.right : rays.down;
    const float facing = std::min(glm::dot(ray.directionWorld, towardsViewer), -kLeastFacing);
    const float way = glm::dot(surface.position - ray.originWorld, towardsViewer) / facing;
    const glm::vec3 offsetWorld = ray.originWorld + way * ray.directionWorld - surface.position;
    at.footprintObject[static_cast<std::size_t>(side)] = glm::mat3(objectFromWorld) * offsetWorld;
  }
  const TriplanarSample sample = sampleTriplanar(*texturing.sampler, *texturing.material, at, texturing.metres);
  surface.fieldMaterial = sample.material;
  surface.isUnlit = texturing.material->unlit;
  const glm::vec3 mapped = glm::normalize(glm::transpose(glm::mat3(objectFromWorld)) * sample.normalObject);
  surface.normalMapped = isBack ? -mapped : mapped;
}

} // namespace brickfield
