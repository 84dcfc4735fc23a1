// Deformed vertices are copied on the GPU; all else is small and kept on the CPU.
#include "resident/motion_table.h"

#include <algorithm>

#include <glm/gtc/matrix_access.hpp>

#include "shared/bindings.h"

namespace brickfield {

namespace {

// What a point that moves with its node was, from what it is. Where this would magnify errors of the depth buffer, or a
// flattened node has lost the way back, it counts as drawn.
shared::NodeMotion nodeMotion(const glm::mat4& before, const glm::mat4& now, glm::dvec3 eyeWorld) {
  constexpr double kMostStretch = 100;
  glm::dmat4 motion(1);
  if (before != now) {
    motion = glm::dmat4(before) * glm::inverse(glm::dmat4(now));
    motion[3] = glm::dvec4(glm::dvec3(motion * glm::dvec4(eyeWorld, 1)) - eyeWorld, 1);
  }
  shared::NodeMotion row{};
  for (int axis = 0; axis < 3; ++axis) row.previousEyeFromEye[axis] = glm::vec4(glm::row(motion, axis));
  double stretch = 0;
  for (int axis = 0; axis < 3; ++axis) stretch += glm::length(glm::dvec3(motion[axis]));
  row.isDrawn.x = stretch < 3 * kMostStretch ? 0 : 1; // no number counts as drawn, too
  return row;
}

} // namespace

MotionTable::MotionTable()
    : nodeMotions_("node_motions", 0),
      meshMotions_("mesh_motions", 0),
      sdfMotions_("sdf_motions", 0),
      vertices_("previous_vertices", 0) {}

void MotionTable::prepareMeshes(const ResidentScene& scene, glm::dvec3 eyeWorld) {
  const std::uint32_t firstDeformed = scene.meshes().sceneVertexCount();
  std::vector<shared::MeshMotion> rows;
  std::vector<shared::NodeMotion> nodes;
  std::vector<bool> isPlaced;
  for (const MeshPlace& now : scene.meshPlaces()) {
    const auto before = places_.find({now.instance, now.primitive});
    const Place place = before == places_.end() ? Place{now.worldFromObject, -1} : before->second;
    const bool isDeformed = now.baseVertex >= firstDeformed;
    shared::MeshMotion row{};
    row.previousWorldFromObject = place.worldFromObject;
    row.vertices = {place.firstDeformed, static_cast<int>(now.baseVertex), static_cast<int>(now.firstVertex), 0};
    // Deformed things that were not there before have not moved: their own vertices count.
    if (before == places_.end() && isDeformed) row.vertices.z = static_cast<int>(now.baseVertex);
    rows.push_back(row);

    if (now.node >= nodes.size()) nodes.resize(now.node + 1), isPlaced.resize(now.node + 1);
    shared::NodeMotion& node = nodes[now.node];
    const shared::NodeMotion motion = nodeMotion(place.worldFromObject, now.worldFromObject, eyeWorld);
    const bool isSame = !isPlaced[now.node] || std::ranges::equal(node.previousEyeFromEye, motion.previousEyeFromEye);
    const bool isDrawn = node.isDrawn.x || motion.isDrawn.x || !isSame || isDeformed || place.firstDeformed >= 0;
    node = motion;
    node.isDrawn.x = isDrawn ? 1 : 0;
    isPlaced[now.node] = true;
  }
  isDrawn_.clear();
  for (const MeshPlace& now : scene.meshPlaces()) isDrawn_.push_back(nodes[now.node].isDrawn.x != 0);
  isAnyDrawn_ = std::ranges::find(isDrawn_, true) != isDrawn_.end();
  nodeMotions_.growTo(nodes.size() * sizeof(shared::NodeMotion));
  nodeMotions_.upload(0, nodes);
  meshMotions_.growTo(rows.size() * sizeof(shared::MeshMotion));
  meshMotions_.upload(0, rows);
}

void MotionTable::prepare(const ResidentScene& scene, glm::dvec3 eyeWorld) {
  prepareMeshes(scene, eyeWorld);
  std::vector<shared::SdfMotion> motions;
  const std::vector<shared::SdfInstance>& instances = scene.sdfInstances();
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const auto before = sdfPlaces_.find(scene.sdfPlaces()[i]);
    shared::SdfMotion motion{};
    for (int axis = 0; axis < 3; ++axis) motion.previousWorldFromGrid[axis] = instances[i].worldFromGrid[axis];
    motions.push_back(before == sdfPlaces_.end() ? motion : before->second);
  }
  sdfMotions_.growTo(motions.size() * sizeof(shared::SdfMotion));
  sdfMotions_.upload(0, motions);
}

void MotionTable::keep(const ResidentScene& scene) {
  const std::uint32_t firstDeformed = scene.meshes().sceneVertexCount();
  places_.clear();
  std::uint32_t deformedEnd = firstDeformed;
  for (const MeshPlace& now : scene.meshPlaces()) {
    const bool isDeformed = now.baseVertex >= firstDeformed;
    places_[{now.instance, now.primitive}] = {now.worldFromObject,
                                              isDeformed ? static_cast<int>(now.baseVertex - firstDeformed) : -1};
    if (isDeformed) deformedEnd = std::max(deformedEnd, now.baseVertex + now.vertexCount);
  }
  const std::size_t bytes = (deformedEnd - firstDeformed) * sizeof(shared::MeshVertex);
  if (bytes > 0) {
    vertices_.growTo(bytes);
    glCopyNamedBufferSubData(scene.meshes().vertices().id(), vertices_.id(),
                             static_cast<GLintptr>(firstDeformed * sizeof(shared::MeshVertex)), 0,
                             static_cast<GLsizeiptr>(bytes));
  }
  sdfPlaces_.clear();
  for (std::size_t i = 0; i < scene.sdfInstances().size(); ++i) {
    shared::SdfMotion& motion = sdfPlaces_[scene.sdfPlaces()[i]];
    for (int axis = 0; axis < 3; ++axis)
      motion.previousWorldFromGrid[axis] = scene.sdfInstances()[i].worldFromGrid[axis];
  }
}

bool MotionTable::isDrawn(std::uint32_t firstDraw, std::uint32_t drawCount) const {
  const auto first = isDrawn_.begin() + firstDraw;
  return std::find(first, first + drawCount, true) != first + drawCount;
}

void MotionTable::bindRows() const {
  nodeMotions_.bindStorage(shared::kPassBufferABinding);
  sdfMotions_.bindStorage(shared::kPassBufferBBinding);
}

void MotionTable::bindMeshes(const ResidentScene& scene) const {
  meshMotions_.bindStorage(shared::kPassBufferABinding);
  vertices_.bindStorage(shared::kPassBufferBBinding);
  scene.meshes().vertices().bindStorage(shared::kMotionVertexBinding);
}

} // namespace brickfield
