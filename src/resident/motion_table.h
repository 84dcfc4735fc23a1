// Where everything stood in the frame before, for motion vectors: transforms of meshes and SDF objects, and the
// deformed vertices of what is skinned or morphed. Things are known again by their number in the pose and their
// primitive.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "gpu/buffer.h"
#include "resident/resident_scene.h"
#include "shared/mesh_params.h"
#include "shared/sdf_params.h"

namespace brickfield {

class MotionTable {
public:
  MotionTable();

  /// Rows for a frame's nodes, draws and SDF instances. What was not there before has not moved.
  ///
  /// eyeWorld  of this frame
  void prepare(const ResidentScene& scene, glm::dvec3 eyeWorld);
  /// Keeps this frame as the one before the next. After its last pass and a barrier for buffer copies.
  void keep(const ResidentScene& scene);

  /// Whether draws, in the order of their rows, must draw their motion themselves: what deforms does, and nodes that
  /// stand in several places, or whose place no transform gives back.
  bool isDrawn(std::uint32_t firstDraw, std::uint32_t drawCount) const;
  bool isAnyDrawn() const { return isAnyDrawn_; }

  /// For the vertex stage of those: rows, vertices of the frame before, vertices of this one.
  void bindMeshes(const ResidentScene& scene) const;
  /// For all others: rows of nodes and of SDF instances.
  void bindRows() const;
  std::size_t bytes() const {
    return nodeMotions_.bytes() + meshMotions_.bytes() + sdfMotions_.bytes() + vertices_.bytes();
  }

private:
  struct Place {
    glm::mat4 worldFromObject{1};
    int firstDeformed = -1; ///< in vertices_; -1: not deformed
  };
  void prepareMeshes(const ResidentScene& scene, glm::dvec3 eyeWorld);

  std::map<std::pair<std::uint32_t, std::uint32_t>, Place> places_; // by number in the pose and primitive
  std::map<std::uint32_t, shared::SdfMotion> sdfPlaces_;            // by number in the pose
  std::vector<bool> isDrawn_;                                       // of each draw
  bool isAnyDrawn_ = false;
  Buffer nodeMotions_, meshMotions_, sdfMotions_, vertices_;
};

} // namespace brickfield
