// Robust scenes; point queries with an exact distance to each triangle.
#include "tests/support/embree_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

#include "bakers/mesh_distance.h"

namespace brickfield::test {

struct EmbreeRays::Scene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  std::vector<glm::vec3> corners;
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

EmbreeRays::EmbreeRays(std::span<const shared::WorldTriangle> rows) : scene_(std::make_unique<Scene>()) {
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, rows.size() * 3));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool isEmpty = rows[i].codes.w & shared::WORLD_TRIANGLE_EMPTY;
    const glm::vec4* row[] = {&rows[i].a, &rows[i].b, &rows[i].c};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[i * 3 + k] = isEmpty ? glm::vec3(std::numeric_limits<float>::quiet_NaN()) : glm::vec3(*row[k]);
      indices[i * 3 + k] = static_cast<std::uint32_t>(i * 3 + k);
      scene_->corners.push_back(corners[i * 3 + k]);
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

EmbreeRays::~EmbreeRays() = default;

OracleHit EmbreeRays::trace(glm::vec3 origin, glm::vec3 direction) const {
  RTCRayHit query{};
  query.ray.org_x = origin.x, query.ray.org_y = origin.y, query.ray.org_z = origin.z;
  query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {query.ray.tfar, 0, false};
  // Embree's normal is that of counter-clockwise corners.
  const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
  return {query.ray.tfar, query.hit.primID, glm::dot(normal, direction) < 0};
}

float EmbreeRays::distance(glm::vec3 point) const {
  struct Query {
    const Scene* scene;
    glm::dvec3 point;
    double nearest;
  } state{scene_.get(), point, std::numeric_limits<double>::infinity()};
  RTCPointQuery query{point.x, point.y, point.z, 0, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(
      scene_->scene, &query, &context,
      [](RTCPointQueryFunctionArguments* arguments) {
        auto& seen = *static_cast<Query*>(arguments->userPtr);
        const glm::vec3* corners = &seen.scene->corners[arguments->primID * 3];
        const PointOnTriangle on = closestPointOnTriangle(seen.point, {corners[0], corners[1], corners[2]});
        const double distance = glm::distance(on.point, seen.point);
        if (!(distance < seen.nearest)) return false;
        seen.nearest = distance;
        arguments->query->radius = static_cast<float>(distance);
        return true;
      },
      &state);
  return static_cast<float>(state.nearest);
}

} // namespace brickfield::test
