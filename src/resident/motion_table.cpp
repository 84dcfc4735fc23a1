// Deformed vertices are copied on the GPU; all else is small and kept on the CPU.
#include "resident/motion_table.h"

#include "shared/bindings.h"

namespace brickfield {

MotionTable::MotionTable()
    : meshMotions_("mesh_motions", 0), sdfMotions_("sdf_motions", 0), vertices_("previous_vertices", 0) {}

void MotionTable::prepare(const ResidentScene& scene) {
  const std::uint32_t firstDeformed = scene.meshes().sceneVertexCount();
  std::vector<shared::MeshMotion> rows;
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
  }
  meshMotions_.growTo(rows.size() * sizeof(shared::MeshMotion));
  meshMotions_.upload(0, rows);

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

void MotionTable::bindMeshes(const ResidentScene& scene) const {
  meshMotions_.bindStorage(shared::kPassBufferABinding);
  vertices_.bindStorage(shared::kPassBufferBBinding);
  scene.meshes().vertices().bindStorage(shared::kMotionVertexBinding);
}

} // namespace brickfield
