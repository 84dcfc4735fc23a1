// Embree 3 scenes, filters and hits. Filters run in the space of the instance, where the winding says which side is the
// front whatever the node's determinant: a mirrored node mirrors ray and triangle alike.
#include "bakers/reference_geometry.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <embree3/rtcore.h>

#include "bakers/reference_field.h"
#include "core/error.h"

namespace brickfield {

namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;
using GeometryHandle = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseGeometry>;

/// One primitive as it stands in its shape's space.
struct Part {
  const Primitive* primitive = nullptr;
  const Material* material = nullptr;
  const TextureSampler* sampler = nullptr;
  std::span<const glm::vec3> positions, normals;
  std::span<const glm::vec4> tangents;

  bool isCut() const { return material->alphaMode != AlphaMode::Opaque; }
  std::array<glm::vec3, 3> corners(std::size_t triangle) const {
    const std::uint32_t* v = &primitive->indices[triangle * 3];
    return {positions[v[0]], positions[v[1]], positions[v[2]]};
  }
};

/// A hierarchy over the primitives of one mesh, or a field.
struct Shape {
  std::vector<std::unique_ptr<DeformedPrimitive>> deformed; ///< what parts refer to where the scene's arrays won't do
  std::vector<std::unique_ptr<Part>> parts;
  const BrickField* field = nullptr; ///< then there are no parts
  SceneHandle scene;
};

struct Placement {
  int node = -1;
  const Shape* shape = nullptr;
  glm::mat4 worldFromObject{1.0f};
  FieldTexturing texturing;
};

/// What filters need beside the ray. Its first member is what Embree hands on.
struct TraceContext {
  RTCIntersectContext embree;
  const std::vector<Placement>* placements = nullptr;
  const RayBundle* rays = nullptr; ///< nothing: a shadow ray, which culls nothing and looks at the finest level
};

/// Barycentric coordinates (of the second and third corner) where a line meets the plane of a triangle.
std::optional<glm::vec2> meetPlane(const std::array<glm::vec3, 3>& corners, const PrimaryRay& ray) {
  // Möller and Trumbore 1997, without its inside test.
  const glm::vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const glm::vec3 p = glm::cross(ray.directionWorld, e2);
  const float determinant = glm::dot(e1, p);
  const glm::vec3 s = ray.originWorld - corners[0], q = glm::cross(s, e1);
  const glm::vec2 barycentric = glm::vec2(glm::dot(s, p), glm::dot(ray.directionWorld, q)) / determinant;
  if (!isFinite(barycentric) || glm::dot(e2, q) / determinant <= 0.0f) return std::nullopt;
  return barycentric;
}

/// Vertex attributes with the footprint that the neighbouring rays span on the triangle's plane.
MaterialPoint materialPointWithFootprint(const Part& part, std::size_t triangle, const glm::mat4& worldFromObject,
                                         const RayBundle& rays, glm::vec2 barycentric) {
  MaterialPoint point = materialPointOf(*part.primitive, triangle, barycentric);
  std::array<glm::vec3, 3> corners = part.corners(triangle);
  for (glm::vec3& corner : corners) corner = transformPoint(worldFromObject, corner);
  const std::optional<glm::vec2> center = meetPlane(corners, rays.center);
  const std::optional<glm::vec2> right = meetPlane(corners, rays.right), down = meetPlane(corners, rays.down);
  const std::uint32_t* v = &part.primitive->indices[triangle * 3];
  for (std::size_t set = 0; set < 2; ++set) {
    const std::vector<glm::vec2>& uvs = part.primitive->uvs[set];
    if (uvs.empty()) continue;
    const glm::mat2 uvFromBarycentric(uvs[v[1]] - uvs[v[0]], uvs[v[2]] - uvs[v[0]]);
    // A neighbour that misses the plane sees the horizon: as wide a footprint as any texture has texels.
    constexpr float kWholeTexture = 1.0f;
    const auto step = [&](const std::optional<glm::vec2>& neighbour) {
      return center && neighbour ? uvFromBarycentric * (*neighbour - *center) : glm::vec2(kWholeTexture);
    };
    point.uvPerFootprint[set] = glm::mat2(step(right), step(down));
  }
  return point;
}

/// Rejects what a ray passes through. Embree calls it with one ray at a time, as we only ask for one.
void filterHit(const RTCFilterFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const auto& part = *static_cast<const Part*>(arguments->geometryUserPtr);
  const auto& context = *reinterpret_cast<const TraceContext*>(arguments->context);
  const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  if (context.rays && !part.material->doubleSided) {
    const glm::vec3 direction(ray.dir_x, ray.dir_y, ray.dir_z), normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    if (glm::dot(direction, normal) > 0.0f) {
      arguments->valid[0] = 0;
      return;
    }
  }
  if (!part.isCut()) return;
  const glm::vec2 barycentric(hit.u, hit.v);
  const MaterialPoint point =
      context.rays ? materialPointWithFootprint(part, hit.primID, (*context.placements)[hit.instID[0]].worldFromObject,
                                                *context.rays, barycentric)
                   : materialPointOf(*part.primitive, hit.primID, barycentric);
  constexpr float kBlendCutoff = 0.5f; // the opaque frame draws Blend as a mask
  const float cutoff = part.material->alphaMode == AlphaMode::Mask ? part.material->alphaCutoff : kBlendCutoff;
  if (part.sampler->sampleBaseColor(*part.material, point).w < cutoff) arguments->valid[0] = 0;
}

GeometryHandle makeTriangles(RTCDevice device, Part& part) {
  GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  // Embree's own buffers: a shared one would have to be readable for 16 bytes at its last vertex.
  void* positions = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            sizeof(glm::vec3), part.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(std::uint32_t), part.primitive->indices.size() / 3);
  if (!positions || !indices) throw Failure("Embree has no memory for the triangles");
  std::ranges::copy(part.positions, static_cast<glm::vec3*>(positions));
  std::ranges::copy(part.primitive->indices, static_cast<std::uint32_t*>(indices));
  rtcSetGeometryUserData(geometry.get(), &part);
  if (!part.material->doubleSided || part.isCut()) rtcSetGeometryIntersectFilterFunction(geometry.get(), filterHit);
  if (part.isCut()) rtcSetGeometryOccludedFilterFunction(geometry.get(), filterHit);
  rtcCommitGeometry(geometry.get());
  return geometry;
}

/// Farthest that geometry may reach. Embree refuses rays with coordinates beyond 1.8e18, also after an instance has
/// divided them by its scale: 1e11 / kLeastScale stays below that with a digit to spare.
constexpr float kLargestCoordinate = 1e11f;
constexpr float kLeastScale = 1e-6f;

/// Embree inverts an instance's matrix; what hardly has an inverse (a node flattened by a scale of 0) is carried to the
/// world vertex by vertex instead. A thousandth of single precision's digits must remain.
bool isInvertible(const glm::mat4& worldFromObject) {
  constexpr float kLeastRatio = 1e-4f;
  const glm::vec2 scales = scaleRange(worldFromObject);
  return scales.x > kLeastRatio * scales.y && scales.x > kLeastScale && scales.y < 1.0f / kLeastScale;
}

void checkReach(const Scene& scene, const Box& boundsWorld) {
  const glm::vec3 reach = glm::max(glm::abs(boundsWorld.min), glm::abs(boundsWorld.max));
  if (!boundsWorld.isEmpty() && std::max({reach.x, reach.y, reach.z}) > kLargestCoordinate)
    throw BadInput(scene.name, "", "the reference traces nothing that reaches farther than 1e11 metres");
}

DeformedPrimitive carryToWorld(DeformedPrimitive object, const glm::mat4& worldFromObject) {
  const glm::mat3 normalWorldFromObject = normalMatrix(worldFromObject);
  for (glm::vec3& position : object.positions) position = transformPoint(worldFromObject, position);
  for (glm::vec3& normal : object.normals) normal = normalWorldFromObject * normal;
  for (glm::vec4& tangent : object.tangents)
    tangent = glm::vec4(transformDirection(worldFromObject, glm::vec3(tangent)), tangent.w);
  return object;
}

glm::vec3 unitOrZero(glm::vec3 direction) {
  const float length = glm::length(direction);
  return length > 0.0f && std::isfinite(length) ? direction / length : glm::vec3(0.0f);
}

/// Bound of what rounding did to worldFromObject * point and to the interpolation before it: some ten operations of
/// 2^-24 each, on the largest terms that were summed.
float roundingOf(const glm::mat4& worldFromObject, const std::array<glm::vec3, 3>& corners, glm::vec3 originWorld,
                 float distance) {
  const glm::vec3 largest = glm::max(glm::abs(corners[0]), glm::max(glm::abs(corners[1]), glm::abs(corners[2])));
  glm::vec3 terms = glm::abs(glm::vec3(worldFromObject[3]));
  for (int axis = 0; axis < 3; ++axis) terms += glm::abs(glm::vec3(worldFromObject[axis])) * largest[axis];
  terms = glm::max(terms, glm::abs(originWorld) + distance);
  constexpr float kRoundings = 16.0f / 16777216.0f;
  return kRoundings * std::max({terms.x, terms.y, terms.z});
}

void fillNormals(const Part& part, const RTCHit& hit, const glm::mat4& worldFromObject, SurfaceHit& surface) {
  const std::uint32_t* v = &part.primitive->indices[std::size_t{hit.primID} * 3];
  const glm::vec3 weights(1.0f - hit.u - hit.v, hit.u, hit.v);
  const auto interpolate = [&](const auto& values) {
    return weights.x * values[v[0]] + weights.y * values[v[1]] + weights.z * values[v[2]];
  };
  const std::array<glm::vec3, 3> corners = part.corners(hit.primID);
  // The cofactor matrix turns normals to the other side of mirrored geometry, whose front is where the winding is
  // clockwise: the sign undoes both.
  const glm::mat3 normalWorldFromObject = mirrorSign(worldFromObject) * normalMatrix(worldFromObject);
  const glm::vec3 normalObject = unitOrZero(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  surface.normalTriangle = unitOrZero(normalWorldFromObject * normalObject);
  surface.normalVertex = unitOrZero(normalWorldFromObject * interpolate(part.normals));
  if (part.primitive->flatNormals || surface.normalVertex == glm::vec3(0.0f))
    surface.normalVertex = surface.normalTriangle;
  if (part.tangents.empty()) return;
  const glm::vec4 tangent = interpolate(part.tangents);
  surface.tangent = unitOrZero(transformDirection(worldFromObject, glm::vec3(tangent)));
  const float handedness = (part.tangents[v[0]].w < 0.0f ? -1.0f : 1.0f) * mirrorSign(worldFromObject);
  surface.bitangent = handedness * glm::cross(surface.normalVertex, surface.tangent);
}

} // namespace

struct ReferenceGeometry::Device {
  DeviceHandle handle;
  std::string firstError;
  std::vector<std::unique_ptr<Shape>> shapes;
  std::vector<Placement> placements; ///< by instance number of the top scene
  SceneHandle top;

  static void rememberError(void* self, RTCError, const char* message) {
    std::string& first = static_cast<Device*>(self)->firstError;
    if (first.empty()) first = message ? message : "unknown error";
  }
  static bool continueBuild(void* progress, double) { return !static_cast<const Progress*>(progress)->isCancelled(); }

  void check(const Progress& progress) const {
    if (progress.isCancelled()) throw Cancelled();
    if (!firstError.empty()) throw Failure("Embree: " + firstError);
  }

  SceneHandle newScene() const {
    SceneHandle scene(rtcNewScene(handle.get()));
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    return scene;
  }
  void commit(RTCScene scene, const Progress& progress) const {
    check(progress);
    rtcSetSceneProgressMonitorFunction(scene, continueBuild, const_cast<Progress*>(&progress));
    rtcJoinCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    check(progress);
  }

  /// deformed: in the order of the mesh's primitives, or empty where the scene's own arrays will do.
  const Shape* addShape(const Scene& scene, int mesh, std::vector<std::unique_ptr<DeformedPrimitive>> deformed,
                        const TextureSampler& sampler, const Progress& progress);
  const Shape* addField(const BrickField& field, const Progress& progress);
  void place(int node, const Shape* shape, const glm::mat4& worldFromObject, const FieldTexturing& texturing = {});
};

const Shape* ReferenceGeometry::Device::addShape(const Scene& scene, int mesh,
                                                 std::vector<std::unique_ptr<DeformedPrimitive>> deformed,
                                                 const TextureSampler& sampler, const Progress& progress) {
  auto shape = std::make_unique<Shape>();
  shape->deformed = std::move(deformed);
  shape->scene = newScene();
  const std::vector<Primitive>& primitives = scene.meshes[static_cast<std::size_t>(mesh)].primitives;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const Primitive& primitive = primitives[i];
    auto part = std::make_unique<Part>();
    part->primitive = &primitive;
    part->material = &materialOf(scene, primitive);
    part->sampler = &sampler;
    const DeformedPrimitive* moved = shape->deformed.empty() ? nullptr : shape->deformed[i].get();
    part->positions = moved ? moved->positions : primitive.positions;
    part->normals = moved ? moved->normals : primitive.normals;
    part->tangents = moved ? moved->tangents : primitive.tangents;
    // Parts keep the primitives' numbers, so that an empty one is no gap.
    if (!primitive.indices.empty())
      rtcAttachGeometryByID(shape->scene.get(), makeTriangles(handle.get(), *part).get(), static_cast<unsigned>(i));
    shape->parts.push_back(std::move(part));
  }
  commit(shape->scene.get(), progress);
  shapes.push_back(std::move(shape));
  return shapes.back().get();
}

const Shape* ReferenceGeometry::Device::addField(const BrickField& field, const Progress& progress) {
  auto shape = std::make_unique<Shape>();
  shape->field = &field;
  shape->scene = newScene();
  attachField(handle.get(), shape->scene.get(), field);
  commit(shape->scene.get(), progress);
  shapes.push_back(std::move(shape));
  return shapes.back().get();
}

void ReferenceGeometry::Device::place(int node, const Shape* shape, const glm::mat4& worldFromObject,
                                      const FieldTexturing& texturing) {
  GeometryHandle geometry(rtcNewGeometry(handle.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), shape->scene.get());
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &worldFromObject[0][0]);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(top.get(), geometry.get(), static_cast<unsigned>(placements.size()));
  placements.push_back({node, shape, worldFromObject, texturing});
}

namespace {
FieldTexturing texturingOf(const Scene& scene, const PosedInstance& instance, const ReferenceFields& fields,
                           const TextureSampler& sampler) {
  const std::vector<float>* metres = fields.triplanarOfNode;
  if (!metres || metres->empty()) return {};
  static const Primitive kNone;
  const std::vector<Primitive>& primitives = scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives;
  const Primitive& first = primitives.empty() ? kNone : primitives.front();
  return {&sampler, &materialOf(scene, first), (*metres)[static_cast<std::size_t>(instance.node)]};
}
} // namespace

ReferenceGeometry::ReferenceGeometry(const Scene& scene, const Pose& pose, const ReferenceFields& fields,
                                     const TextureSampler& sampler, const Progress& progress)
    : device_(std::make_unique<Device>()) {
  checkReach(scene, pose.boundsWorld);
  device_->handle.reset(rtcNewDevice(nullptr));
  if (!device_->handle) throw Failure("Embree: no device");
  rtcSetDeviceErrorFunction(device_->handle.get(), Device::rememberError, device_.get());
  device_->top = device_->newScene();

  std::vector<const Shape*> shapeOfMesh(scene.meshes.size(), nullptr);
  std::vector<const Shape*> shapeOfField(fields.fields ? fields.fields->size() : 0, nullptr);
  for (const PosedInstance& instance : pose.instances) {
    const int field = fields.fieldOfNode ? (*fields.fieldOfNode)[static_cast<std::size_t>(instance.node)] : -1;
    if (field >= 0 && isInvertible(instance.worldFromObject)) {
      const Shape*& shape = shapeOfField[static_cast<std::size_t>(field)];
      if (!shape) shape = device_->addField((*fields.fields)[static_cast<std::size_t>(field)], progress);
      device_->place(instance.node, shape, instance.worldFromObject, texturingOf(scene, instance, fields, sampler));
      continue;
    }
    const std::vector<Primitive>& primitives = scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives;
    const bool moves = std::ranges::any_of(primitives, [&](const Primitive& p) { return isDeformed(p, instance); });
    const bool flattened = !isInvertible(instance.worldFromObject);
    if (!moves && !flattened) {
      const Shape*& shape = shapeOfMesh[static_cast<std::size_t>(instance.mesh)];
      if (!shape) shape = device_->addShape(scene, instance.mesh, {}, sampler, progress);
      device_->place(instance.node, shape, instance.worldFromObject);
      continue;
    }
    std::vector<std::unique_ptr<DeformedPrimitive>> deformed;
    for (const Primitive& primitive : primitives) {
      DeformedPrimitive moved = deformPrimitive(primitive, instance);
      if (flattened) moved = carryToWorld(std::move(moved), instance.worldFromObject);
      deformed.push_back(std::make_unique<DeformedPrimitive>(std::move(moved)));
    }
    device_->place(instance.node, device_->addShape(scene, instance.mesh, std::move(deformed), sampler, progress),
                   flattened ? glm::mat4(1.0f) : instance.worldFromObject);
  }
  device_->commit(device_->top.get(), progress);
}

ReferenceGeometry::~ReferenceGeometry() = default;

std::optional<SurfaceHit> ReferenceGeometry::trace(const RayBundle& rays) const {
  TraceContext context;
  rtcInitIntersectContext(&context.embree);
  context.placements = &device_->placements;
  context.rays = &rays;
  const PrimaryRay& ray = rays.center;
  RTCRayHit query{};
  query.ray.org_x = ray.originWorld.x, query.ray.org_y = ray.originWorld.y, query.ray.org_z = ray.originWorld.z;
  query.ray.dir_x = ray.directionWorld.x, query.ray.dir_y = ray.directionWorld.y,
  query.ray.dir_z = ray.directionWorld.z;
  query.ray.tnear = ray.tNear;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(device_->top.get(), &context.embree, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const Placement& placement = device_->placements[query.hit.instID[0]];
  if (placement.shape->field) {
    SurfaceHit hit = fieldHit(*placement.shape->field, placement.node, placement.worldFromObject, ray, query.ray.tfar);
    if (placement.texturing.metres > 0) textureField(placement.texturing, placement.worldFromObject, rays, hit);
    return hit;
  }
  const Part& part = *placement.shape->parts[query.hit.geomID];
  const std::array<glm::vec3, 3> corners = part.corners(query.hit.primID);
  const glm::vec2 barycentric(query.hit.u, query.hit.v);
  SurfaceHit surface;
  surface.distance = query.ray.tfar;
  surface.node = placement.node;
  surface.primitive = part.primitive;
  surface.material = part.material;
  surface.isUnlit = part.material->unlit;
  surface.position = transformPoint(placement.worldFromObject, corners[0] + barycentric.x * (corners[1] - corners[0]) +
                                                                   barycentric.y * (corners[2] - corners[0]));
  surface.positionError = roundingOf(placement.worldFromObject, corners, ray.originWorld, surface.distance);
  fillNormals(part, query.hit, placement.worldFromObject, surface);
  surface.isBackFace = glm::dot(surface.normalTriangle, ray.directionWorld) > 0.0f;
  surface.materialPoint =
      materialPointWithFootprint(part, query.hit.primID, placement.worldFromObject, rays, barycentric);
  return surface;
}

bool ReferenceGeometry::isOccluded(glm::vec3 originWorld, glm::vec3 directionWorld, float distance) const {
  TraceContext context;
  rtcInitIntersectContext(&context.embree);
  context.placements = &device_->placements;
  RTCRay ray{};
  ray.org_x = originWorld.x, ray.org_y = originWorld.y, ray.org_z = originWorld.z;
  ray.dir_x = directionWorld.x, ray.dir_y = directionWorld.y, ray.dir_z = directionWorld.z;
  ray.tnear = 0.0f;
  ray.tfar = distance;
  ray.mask = ~0u;
  rtcOccluded1(device_->top.get(), &context.embree, &ray);
  return ray.tfar < 0.0f;
}

} // namespace brickfield
