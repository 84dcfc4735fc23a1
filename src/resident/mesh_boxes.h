// A box around each mesh draw of a pose, for whoever draws it from more places than one eye.
#pragma once

#include <vector>

#include "resident/resident_scene.h"
#include "scene/instance_bounds.h"

namespace brickfield {

class MeshBoxes {
public:
  /// cost one look at each vertex of the scene
  explicit MeshBoxes(const Scene& scene);

  /// Metres from the anchor, in the order of `places`, which are of this pose; empty where nothing is finite.
  std::vector<Box> anchored(const std::vector<MeshPlace>& places, const Pose& pose, glm::dvec3 anchorWorld) const;

private:
  std::vector<std::vector<InstanceBounds>> primitives_; ///< a mesh each
};

} // namespace brickfield
