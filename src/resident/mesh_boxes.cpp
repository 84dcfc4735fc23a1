// Bounds of each primitive, asked where its instance stands.
#include "resident/mesh_boxes.h"

namespace brickfield {

MeshBoxes::MeshBoxes(const Scene& scene) : primitives_(scene.meshes.size()) {
  for (std::size_t mesh = 0; mesh < primitives_.size(); ++mesh)
    for (const Primitive& primitive : scene.meshes[mesh].primitives) primitives_[mesh].emplace_back(primitive);
}

std::vector<Box> MeshBoxes::anchored(const std::vector<MeshPlace>& places, const Pose& pose,
                                     glm::dvec3 anchorWorld) const {
  std::vector<Box> boxes;
  boxes.reserve(places.size());
  for (const MeshPlace& place : places) {
    const PosedInstance& instance = pose.instances[place.instance];
    boxes.push_back(
        primitives_[static_cast<std::size_t>(instance.mesh)][place.primitive].anchored(instance, anchorWorld));
  }
  return boxes;
}

} // namespace brickfield
