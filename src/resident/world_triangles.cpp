// Ranges follow the pose's instances; work is listed for those that differ from what the last settled frame left.
#include "resident/world_triangles.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"

namespace brickfield {

namespace {

template <typename Element>
bool haveSameBits(const std::vector<Element>& a, const std::vector<Element>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Element)) == 0);
}

// Grows without keeping the content, which is new anyway.
void fit(Buffer& buffer, const char* label, std::size_t bytes) {
  if (!buffer || buffer.bytes() < bytes) buffer = Buffer(label, bytes);
}

std::vector<bool> meshesOutsideFields(const Scene& scene, const std::vector<bool>& isSdf) {
  std::vector<bool> isUsed(scene.meshes.size(), false);
  for (std::size_t node = 0; node < scene.nodes.size(); ++node)
    if (scene.nodes[node].mesh >= 0 && !isSdf[node]) isUsed[static_cast<std::size_t>(scene.nodes[node].mesh)] = true;
  return isUsed;
}

std::vector<bool> sdfNodes(const Scene& scene, const SceneFields& fields) {
  std::vector<bool> isSdf(scene.nodes.size(), false);
  for (std::size_t node = 0; node < std::min(isSdf.size(), fields.fieldOfNode.size()); ++node)
    isSdf[node] = fields.fieldOfNode[node] >= 0;
  return isSdf;
}

// Below this a transform's least scale against its largest leaves floats no inside.
constexpr float kFlat = 1e-6f;

std::uint32_t flagsOf(const glm::mat4& worldFromObject, const std::vector<glm::mat4>& worldFromBind) {
  // A skeleton mirrors where most of its joints do: the deformed triangles have turned with them.
  if (!worldFromBind.empty()) {
    float sum = 0;
    for (const glm::mat4& joint : worldFromBind) sum += mirrorSign(joint);
    return sum < 0 ? shared::WORLD_INSTANCE_MIRRORED : 0;
  }
  const glm::vec2 scales = scaleRange(worldFromObject);
  return (mirrorSign(worldFromObject) < 0 ? shared::WORLD_INSTANCE_MIRRORED : 0u) |
         (scales.x > kFlat * scales.y ? 0u : shared::WORLD_INSTANCE_FLAT);
}

void appendChunks(std::uint32_t instance, std::uint32_t first, std::uint32_t count, std::uint32_t vertexOffset,
                  std::vector<shared::GatherChunk>& chunks) {
  for (std::uint32_t done = 0; done < count; done += shared::GATHER_TRIANGLES)
    chunks.push_back({instance, first + done, std::min(count - done, shared::GATHER_TRIANGLES), vertexOffset});
}

} // namespace

bool WorldTriangles::Placement::isSameInstance(const Placement& other) const {
  return node == other.node && instance == other.instance && mesh == other.mesh && skin == other.skin;
}

bool WorldTriangles::Placement::isSamePlace(const Placement& other) const {
  return std::memcmp(&worldFromObject, &other.worldFromObject, sizeof worldFromObject) == 0 &&
         haveSameBits(morphWeights, other.morphWeights) && haveSameBits(worldFromBind, other.worldFromBind);
}

WorldTriangles::WorldTriangles(const Scene& scene, const SceneFields& fields, const ResidentScene& resident,
                               SmallHoles holes)
    : resident_(&resident),
      isSdf_(sdfNodes(scene, fields)),
      topology_(scene, resident.meshes(), meshesOutsideFields(scene, isSdf_), holes),
      primitiveBounds_(scene.meshes.size()) {
  const std::vector<bool> isUsed = meshesOutsideFields(scene, isSdf_);
  for (std::size_t m = 0; m < isUsed.size(); ++m)
    if (isUsed[m])
      for (const Primitive& primitive : scene.meshes[m].primitives) primitiveBounds_[m].emplace_back(primitive);
  fit(triangles_, "world_triangles", 0);
  fit(faces_, "world_faces", 0);
  fit(instances_, "world_instances", 0);
  fit(chunks_, "world_gather_chunks", 0);
}

void WorldTriangles::layOut(const std::vector<Placement>& drawn) {
  std::uint64_t count = 0;
  std::vector<InstanceRange> ranges;
  for (const Placement& placement : drawn) {
    const std::uint32_t triangles = topology_.mesh(placement.mesh).triangleCount;
    ranges.push_back({static_cast<std::uint32_t>(count), triangles, placement.node, {}});
    count += triangles;
    if (count > kMostTriangles) throw Failure("world field: the pose draws more than 2^26 triangles of meshes");
  }
  ranges_ = std::move(ranges);
  triangleCount_ = static_cast<std::uint32_t>(count);
  fit(triangles_, "world_triangles", count * sizeof(shared::WorldTriangle));
  fit(faces_, "world_faces", count * sizeof(shared::WorldFace));
  fit(instances_, "world_instances", drawn.size() * sizeof(shared::WorldInstance));
  rows_.assign(drawn.size(), {});
  settled_.clear();
  settledBounds_.assign(drawn.size(), {});
  isMoved_.assign(drawn.size(), true);
  isLaidOut_ = true;
}

Box WorldTriangles::boundsOf(const PosedInstance& instance) const {
  Box box;
  for (const InstanceBounds& bounds : primitiveBounds_[static_cast<std::size_t>(instance.mesh)])
    box.extend(bounds.anchored(instance, anchorWorld_));
  return box;
}

shared::WorldInstance WorldTriangles::rowOf(const Placement& placement, const InstanceRange& range) const {
  // In double: both translations may be kilometres, and their difference centimetres.
  glm::dmat4 anchoredFromObject(placement.worldFromObject);
  anchoredFromObject[3] -= glm::dvec4(anchorWorld_, 0.0) * anchoredFromObject[3].w;
  const TopologyTable::MeshRows& mesh = topology_.mesh(placement.mesh);
  shared::WorldInstance row{};
  row.anchoredFromObject = glm::mat4(anchoredFromObject);
  row.triangles = {range.firstTriangle, range.count, mesh.firstTriangle,
                   static_cast<std::uint32_t>(placement.node) << shared::WORLD_TRIANGLE_NODE_SHIFT};
  row.vertices = {0, mesh.vertexCount, mesh.firstFan, flagsOf(placement.worldFromObject, placement.worldFromBind)};
  return row;
}

void WorldTriangles::listChunks(const Scene& scene) {
  std::vector<shared::GatherChunk> chunks;
  const std::vector<DeformJob>& jobs = resident_->deformJobs();
  std::size_t job = 0;
  for (const MovedInstance& moved : moved_) {
    const auto posed = static_cast<std::uint32_t>(posed_[moved.instance]);
    const int mesh = placements_[moved.instance].mesh;
    const TopologyTable::MeshRows& rows = topology_.mesh(mesh);
    std::uint32_t triangle = 0, cap = rows.triangleCount;
    for (const std::uint32_t caps : rows.capsOfPrimitive) cap -= caps;
    for (std::uint32_t p = 0; p < scene.meshes[static_cast<std::size_t>(mesh)].primitives.size(); ++p) {
      const PooledPrimitive& primitive = resident_->meshes().primitive(mesh, p);
      while (job < jobs.size() && std::pair(jobs[job].instance, jobs[job].primitive) < std::pair(posed, p)) ++job;
      const bool isDeformed = job < jobs.size() && jobs[job].instance == posed && jobs[job].primitive == p;
      const std::uint32_t offset = isDeformed ? jobs[job].params.vertices.z - primitive.firstVertex : 0;
      appendChunks(moved.instance, triangle, primitive.indexCount / 3, offset, chunks);
      triangle += primitive.indexCount / 3;
      appendChunks(moved.instance, cap, rows.capsOfPrimitive[p], offset, chunks);
      cap += rows.capsOfPrimitive[p];
    }
  }
  triangleChunks_ = static_cast<std::uint32_t>(chunks.size());
  for (const MovedInstance& moved : moved_)
    appendChunks(moved.instance, 0, topology_.mesh(placements_[moved.instance].mesh).vertexCount, 0, chunks);
  vertexChunks_ = static_cast<std::uint32_t>(chunks.size()) - triangleChunks_;
  fit(chunks_, "world_gather_chunks", chunks.size() * sizeof(shared::GatherChunk));
  chunks_.upload(0, chunks);
}

bool WorldTriangles::setPose(const Scene& scene, const Pose& pose, glm::dvec3 anchorWorld) {
  std::vector<Placement> drawn;
  std::vector<std::size_t> posed;
  for (std::size_t i = 0; i < pose.instances.size(); ++i) {
    const PosedInstance& instance = pose.instances[i];
    if (isSdf_[static_cast<std::size_t>(instance.node)]) continue;
    posed.push_back(i);
    drawn.push_back({instance.node, instance.instance, instance.mesh, instance.skin, instance.worldFromObject,
                     instance.morphWeights, instance.worldFromBind});
  }
  const bool isSameLayout = isLaidOut_ && anchorWorld == anchorWorld_ &&
                            std::equal(drawn.begin(), drawn.end(), placements_.begin(), placements_.end(),
                                       [](const Placement& a, const Placement& b) { return a.isSameInstance(b); });
  if (!isSameLayout) layOut(drawn);
  anchorWorld_ = anchorWorld;

  moved_.clear();
  bounds_ = {};
  for (std::uint32_t i = 0; i < drawn.size(); ++i) {
    if (!isMoved_[i]) isMoved_[i] = !drawn[i].isSamePlace(settled_[i]);
    if (isMoved_[i]) {
      ranges_[i].boundsAnchored = boundsOf(pose.instances[posed[i]]);
      rows_[i] = rowOf(drawn[i], ranges_[i]);
      moved_.push_back({i, settledBounds_[i], ranges_[i].boundsAnchored});
    }
    bounds_.extend(ranges_[i].boundsAnchored);
  }
  placements_ = std::move(drawn);
  posed_ = std::move(posed);
  if (!moved_.empty()) {
    const std::uint32_t first = moved_.front().instance, count = moved_.back().instance - first + 1;
    instances_.upload(first * sizeof(shared::WorldInstance),
                      std::span<const shared::WorldInstance>(rows_).subspan(first, count));
  }
  listChunks(scene);
  isNew_ = isNew_ || !isSameLayout;
  return isNew_;
}

void WorldTriangles::settle() {
  for (const MovedInstance& moved : moved_) settledBounds_[moved.instance] = moved.boundsNow;
  settled_ = placements_;
  isMoved_.assign(placements_.size(), false);
  moved_.clear();
  triangleChunks_ = vertexChunks_ = 0;
  isNew_ = false;
}

void WorldTriangles::bindTables() const {
  triangles_.bindStorage(shared::kGatherTriangleBinding);
  faces_.bindStorage(shared::kGatherFaceBinding);
  instances_.bindStorage(shared::kGatherInstanceBinding);
  topology_.triangles().bindStorage(shared::kGatherTopologyBinding);
  chunks_.bindStorage(shared::kGatherChunkBinding);
}

void WorldTriangles::bindFans() const {
  topology_.fanStarts().bindStorage(shared::kGatherFanStartBinding);
  topology_.fanCorners().bindStorage(shared::kGatherFanCornerBinding);
}

std::size_t WorldTriangles::bytes() const {
  return topology_.bytes() + triangles_.bytes() + faces_.bytes() + instances_.bytes() + chunks_.bytes();
}

} // namespace brickfield
