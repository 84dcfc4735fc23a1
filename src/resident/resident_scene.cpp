// Sorts mesh draws by state, lays out deform jobs, turns poses of SDF nodes into affine maps to grid space.
#include "resident/resident_scene.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

#include "resident/node_looks.h"
#include "shared/bindings.h"

namespace brickfield {

struct ResidentScene::PendingDraw {
  PooledPrimitive primitive;
  std::uint32_t baseVertex;
  shared::MeshDraw row;
  bool mirrored;
  std::uint32_t instance = 0, primitiveIndex = 0;
  auto state() const { return std::tie(primitive.material, mirrored, primitive.firstIndex, baseVertex); }
};

namespace {

// Marks a base vertex that counts deformed vertices from 0, until finishDraws knows where they begin.
constexpr std::uint32_t kDeformed = 1u << 31;

// Grows a buffer to its content and uploads it.
template <typename Element>
void renew(Buffer& buffer, const char* label, const std::vector<Element>& content) {
  if (!buffer) buffer = Buffer(label, content.size() * sizeof(Element));
  buffer.growTo(content.size() * sizeof(Element));
  buffer.upload(0, content);
}

/// Whether the SDF object of a mesh shows its surface from behind too. A field has one answer for the whole object, a
/// mesh one for each primitive: only where every primitive's material is double sided does the object show both sides,
/// so that no back face of a single-sided material appears that the mesh would cull. A mesh without primitives is
/// single sided.
bool isDoubleSidedNode(const Scene& scene, int mesh) {
  const auto& primitives = scene.meshes[static_cast<std::size_t>(mesh)].primitives;
  return !primitives.empty() && std::all_of(primitives.begin(), primitives.end(), [&](const Primitive& primitive) {
    return materialOf(scene, primitive).doubleSided;
  });
}

/// Nothing where the transform flattens space.
std::optional<shared::SdfInstance> sdfInstanceOf(const PosedInstance& instance, const ResidentField& field,
                                                 bool doubleSided) {
  // In double precision: the translation of a small object far from the origin would lose its voxels.
  const glm::dmat4 worldFromObject(instance.worldFromObject);
  if (glm::determinant(glm::dmat3(worldFromObject)) == 0.0) return {};
  const double h = field.voxelSizeObject;
  glm::dmat4 objectFromGrid(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    objectFromGrid[axis][axis] = h;
    objectFromGrid[3][axis] = field.originObject[axis];
  }
  const glm::dmat4 worldFromGrid = worldFromObject * objectFromGrid;
  const glm::dmat4 gridFromWorld = glm::inverse(worldFromGrid);
  if (!isFinite(glm::mat4(gridFromWorld))) return {};

  shared::SdfInstance row{};
  const glm::mat4 rowsOfGrid(glm::transpose(gridFromWorld)), rowsOfWorld(glm::transpose(worldFromGrid));
  for (int axis = 0; axis < 3; ++axis) {
    row.gridFromWorld[axis] = rowsOfGrid[axis];
    row.worldFromGrid[axis] = rowsOfWorld[axis];
  }
  row.boxMin = glm::vec4((field.boundsObject.min - field.originObject) / field.voxelSizeObject,
                         scaleRange(glm::mat4(worldFromGrid)).y);
  row.boxMax = glm::vec4((field.boundsObject.max - field.originObject) / field.voxelSizeObject,
                         scaleRange(glm::mat4(worldFromGrid)).x);
  row.ids = {instance.node, static_cast<int>(field.firstLevel), static_cast<int>(field.levelCount),
             static_cast<int>((doubleSided ? shared::SDF_DOUBLE_SIDED : 0u) | field.number << shared::SDF_FIELD_SHIFT)};
  return row;
}

} // namespace

ResidentScene::ResidentScene(const Scene& scene, const SceneFields& fields)
    : meshes_(scene),
      materials_(scene),
      fieldOfNode_(fields.fieldOfNode),
      lightFieldOfNode_(fields.lightFieldOfNode),
      triplanarOfNode_(fields.triplanarOfNode),
      scene_(&scene) {
  fieldOfNode_.resize(scene.nodes.size(), -1);
  lightFieldOfNode_.resize(scene.nodes.size(), -1);
  triplanarOfNode_.resize(scene.nodes.size(), 0.0f);
  atlas_.reserve(fields.fields);
  for (const BrickField& field : fields.fields) fieldIds_.push_back(atlas_.add(field));
}

std::uint32_t ResidentScene::addDeformJob(const PosedInstance& instance, const PooledPrimitive& primitive,
                                          DeformJob job) {
  const bool skinned = instance.skin >= 0 && primitive.influences > 0;
  job.params.vertices = {primitive.firstVertex, primitive.vertexCount, deformedVertices_,
                         skinned ? primitive.influences : 0u};
  job.params.sources = {primitive.firstInfluence, primitive.firstMorphRow, primitive.morphTargets,
                        static_cast<std::uint32_t>(joints_.size())};
  job.params.weights = {static_cast<std::uint32_t>(weights_.size()), 0, 0, 0};
  weights_.insert(weights_.end(), instance.morphWeights.begin(), instance.morphWeights.end());
  // Targets without a weight of their own stay where they are.
  weights_.resize(job.params.weights.x + primitive.morphTargets, 0.0f);
  if (skinned) joints_.insert(joints_.end(), instance.worldFromBind.begin(), instance.worldFromBind.end());
  deformJobs_.push_back(job);
  const std::uint32_t first = deformedVertices_;
  deformedVertices_ += primitive.vertexCount;
  return first;
}

void ResidentScene::addMeshDraws(const Pose& pose, std::uint32_t number, std::vector<PendingDraw>& pending) {
  const PosedInstance& instance = pose.instances[number];
  for (std::uint32_t i = 0; i < meshes_.primitiveCount(instance.mesh); ++i) {
    const PooledPrimitive& primitive = meshes_.primitive(instance.mesh, i);
    PendingDraw draw{primitive, primitive.firstVertex, {}, mirrorSign(instance.worldFromObject) < 0, number, i};
    const bool morphed =
        primitive.morphTargets > 0 &&
        std::any_of(instance.morphWeights.begin(), instance.morphWeights.end(), [](float w) { return w != 0; });
    const bool skinned = instance.skin >= 0 && primitive.influences > 0;
    if (morphed || skinned) draw.baseVertex = addDeformJob(instance, primitive, {number, i, {}}) | kDeformed;
    draw.row.worldFromObject = instance.worldFromObject;
    draw.row.ids = {instance.node, MaterialTable::rowOf(primitive.material),
                    static_cast<int>((primitive.flatNormals ? shared::DRAW_FLAT_NORMALS : 0u) |
                                     (draw.mirrored ? shared::DRAW_MIRRORED : 0u)),
                    0};
    pending.push_back(draw);
  }
}

void ResidentScene::finishDraws(std::vector<PendingDraw>& pending) {
  const std::uint32_t firstDeformed = meshes_.reserveDeformed(deformedVertices_);
  for (DeformJob& job : deformJobs_) job.params.vertices.z += firstDeformed;
  for (PendingDraw& draw : pending)
    if (draw.baseVertex & kDeformed) draw.baseVertex = (draw.baseVertex & ~kDeformed) + firstDeformed;
  std::stable_sort(pending.begin(), pending.end(),
                   [](const PendingDraw& a, const PendingDraw& b) { return a.state() < b.state(); });

  batches_.clear();
  meshPlaces_.clear();
  std::vector<shared::MeshDraw> rows;
  for (const PendingDraw& draw : pending) {
    if (batches_.empty() ||
        PendingDraw{batches_.back().primitive, batches_.back().baseVertex, {}, batches_.back().mirrored}.state() !=
            draw.state())
      batches_.push_back({draw.primitive, draw.baseVertex, static_cast<std::uint32_t>(rows.size()), 0, draw.mirrored});
    ++batches_.back().drawCount;
    rows.push_back(draw.row);
    meshPlaces_.push_back({draw.instance, static_cast<std::uint32_t>(draw.row.ids.x), draw.primitiveIndex,
                           draw.baseVertex, draw.primitive.firstVertex, draw.primitive.vertexCount,
                           draw.row.worldFromObject});
  }
  meshDrawCount_ = static_cast<std::uint32_t>(rows.size());
  renew(meshDraws_, "mesh_draws", rows);
  std::vector<std::uint32_t> numbers(rows.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  renew(drawIndices_, "mesh_draw_indices", numbers);
  constexpr GLuint kDrawBinding = 1;
  constexpr GLuint kDrawAttribute = 6;
  VertexArray& array = meshes_.vertexArray();
  array.setVertexBuffer(kDrawBinding, drawIndices_, sizeof(std::uint32_t));
  array.setIntegerAttribute(kDrawAttribute, kDrawBinding, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayBindingDivisor(array.id(), kDrawBinding, 1);
}

shared::SdfLook ResidentScene::lookOf(const Scene& scene, const PosedInstance& instance, const ResidentField& field) {
  shared::SdfLook look{};
  look.objectFromGrid = glm::vec4(field.originObject, field.voxelSizeObject);
  const std::vector<Primitive>& primitives = scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives;
  const int material = primitives.empty() ? -1 : primitives.front().material;
  static const Material kDefault;
  const Material& first = material < 0 ? kDefault : scene.materials[static_cast<std::size_t>(material)];
  look.transmission = glm::vec4(first.diffuseTransmissionColor, first.diffuseTransmission);
  look.absorption = glm::vec4(first.absorption, 0);
  look.texturing.x = triplanarOfNode_[static_cast<std::size_t>(instance.node)];
  look.texturing.y = static_cast<float>(MaterialTable::rowOf(material));
  if (look.texturing.x > 0 && std::ranges::find(triplanarMaterials_, material) == triplanarMaterials_.end())
    triplanarMaterials_.push_back(material);
  return look;
}

void ResidentScene::uploadInstances(std::size_t nodes) {
  std::vector<shared::SdfInstance> rows = sdfRows_;
  rows.insert(rows.end(), lightRows_.begin(), lightRows_.end());
  renew(sdfInstances_, "sdf_instances", rows);
  renew(sdfLooks_, "sdf_looks", lookRows_);
  constexpr std::uint32_t kMostRows = 255, kCountShift = 24; // as in shaders/lib/near_bricks.glsl
  std::vector<std::uint32_t> rowsOfNode(std::max(nodes, std::size_t{1}), shared::NO_BRICKS);
  for (std::size_t row = 0; row < rows.size(); ++row) { // a node's instances follow each other
    std::uint32_t& own = rowsOfNode[static_cast<std::size_t>(rows[row].ids.x)];
    if (own == shared::NO_BRICKS)
      own = static_cast<std::uint32_t>(row) | 1u << kCountShift;
    else if (own >> kCountShift < kMostRows)
      own += 1u << kCountShift;
  }
  renew(nodeRows_, "node_rows", rowsOfNode);
}

void ResidentScene::setPose(const Scene& scene, const Pose& pose) {
  deformJobs_.clear();
  sdfRows_.clear();
  lightRows_.clear();
  lookRows_.clear();
  triplanarMaterials_.clear();
  sdfPlaces_.clear();
  joints_.clear();
  weights_.clear();
  deformedVertices_ = 0;
  std::vector<PendingDraw> pending;
  for (std::uint32_t i = 0; i < pose.instances.size(); ++i) {
    const PosedInstance& instance = pose.instances[i];
    const auto node = static_cast<std::size_t>(instance.node);
    const int field = fieldOfNode_[node], bricks = field >= 0 ? field : lightFieldOfNode_[node];
    if (field < 0) addMeshDraws(pose, i, pending);
    if (bricks < 0) continue;
    const ResidentField& resident = atlas_.field(fieldIds_[static_cast<std::size_t>(bricks)]);
    const std::optional<shared::SdfInstance> row =
        sdfInstanceOf(instance, resident, isDoubleSidedNode(scene, instance.mesh));
    if (!row) continue;
    (field >= 0 ? sdfRows_ : lightRows_).push_back(*row);
    if (field < 0) continue;
    sdfPlaces_.push_back(i);
    lookRows_.push_back(lookOf(scene, instance, resident));
  }
  finishDraws(pending);
  uploadInstances(scene.nodes.size());
  renew(jointMatrices_, "joint_matrices", joints_);
  renew(morphWeights_, "morph_weights", weights_);
  sdfInstanceCount_ = static_cast<std::uint32_t>(sdfRows_.size());
}

void ResidentScene::setLighting(const Lighting& lighting) {
  std::vector<shared::LightRow> rows;
  for (const PosedLight& posed : lighting.lights) {
    const Light& light = posed.light;
    shared::LightRow row{};
    const std::uint32_t kind = light.kind == LightKind::Sun         ? shared::LIGHT_SUN
                               : light.kind == LightKind::Point     ? shared::LIGHT_POINT
                               : light.kind == LightKind::Spot      ? shared::LIGHT_SPOT
                               : light.kind == LightKind::Rectangle ? shared::LIGHT_RECTANGLE
                                                                    : shared::LIGHT_SPHERE;
    row.position = glm::vec4(posed.positionWorld, static_cast<float>(kind));
    row.direction = glm::vec4(posed.directionWorld, light.range);
    float radius = light.kind == LightKind::Sun ? std::tan(0.5f * light.angleRadians) : light.radius;
    if (light.kind == LightKind::Rectangle) radius = 0.5f * glm::length(light.size);
    row.intensity = glm::vec4(light.color * light.intensity, radius);
    // KHR_lights_punctual: the angular falloff as scale and offset of the cosine; 0.001 is the extension's guard.
    const float cosInner = std::cos(light.innerConeRadians), cosOuter = std::cos(light.outerConeRadians);
    row.cone.x = 1.0f / std::max(0.001f, cosInner - cosOuter);
    row.cone.y = -cosOuter * row.cone.x;
    if (light.kind == LightKind::Rectangle)
      row.cone = glm::vec4(0.5f * light.size.x * posed.rightWorld, 0.5f * light.size.y);
    rows.push_back(row);
  }
  renew(lights_, "lights", rows);
  lightCount_ = static_cast<std::uint32_t>(rows.size());
}

void ResidentScene::bindNodeLooks() const {
  if (!nodeLooks_) {
    std::vector<shared::NodeLook> looks = nodeLooksOf(*scene_);
    if (looks.empty()) looks.emplace_back();
    nodeLooks_ = Buffer("node_looks", looks);
  }
  nodeLooks_.bindStorage(shared::kNodeLookBinding);
}

void ResidentScene::bindDeform() const {
  meshes_.vertices().bindStorage(shared::kDeformSourceBinding);
  meshes_.vertices().bindStorage(shared::kDeformResultBinding);
  meshes_.influences().bindStorage(shared::kDeformInfluenceBinding);
  meshes_.morphs().bindStorage(shared::kDeformMorphBinding);
  jointMatrices_.bindStorage(shared::kDeformJointBinding);
  morphWeights_.bindStorage(shared::kDeformWeightBinding);
}

std::size_t ResidentScene::tableBytes() const {
  std::size_t sum = 0;
  for (const Buffer* table :
       {&meshDraws_, &drawIndices_, &sdfInstances_, &sdfLooks_, &nodeRows_, &lights_, &jointMatrices_, &morphWeights_})
    sum += table->bytes();
  return nodeLooks_ ? sum + nodeLooks_.bytes() : sum;
}

} // namespace brickfield
