// Every triangle that a pose draws as a mesh, in one buffer, in anchored space: metres of world from an anchor, so that
// floats stay fine far from the origin. Here are the buffer's layout, the rows and the lists of work;
// passes/world_field/world_triangles_pass fills it. Masked materials keep their triangles whole: what alpha cuts out of
// a picture is still there for the world field.
#pragma once

#include <cstdint>
#include <vector>

#include "resident/resident_scene.h"
#include "resident/topology_table.h"
#include "scene/instance_bounds.h"
#include "shared/world_field_params.h"

namespace brickfield {

/// Where the triangles of one posed instance stand in the buffer, in the order of its mesh's primitives.
struct InstanceRange {
  std::uint32_t firstTriangle = 0;
  std::uint32_t count = 0;
  int node = -1;
  Box boundsAnchored; ///< holds every corner; empty where nothing is finite
};

struct MovedInstance {
  std::uint32_t instance = 0; ///< into WorldTriangles::instances()
  Box boundsBefore;           ///< anchored; empty where everything is new
  Box boundsNow;
};

class WorldTriangles {
public:
  static constexpr std::uint32_t kMostTriangles = 1u << 26;

  /// fields    nodes with a field are SDF objects: their meshes are left out
  /// resident  of the same scene; must outlive this
  /// holes     with SmallHoles::Closed rows of caps follow those of their mesh, see analyseSurface
  /// error     Failure: more than 2^28 triangles in all meshes
  WorldTriangles(const Scene& scene, const SceneFields& fields, const ResidentScene& resident,
                 SmallHoles holes = SmallHoles::Closed);

  /// Lays out and lists the work for a pose that the resident scene has been given before.
  ///
  /// anchorWorld metres. Skinned vertices are floats of the world: an anchor of floats loses nothing more of them.
  /// returns     true: the layout (which instances are drawn) or the anchor changed since the last settled frame, so
  ///             everything is new and no row is what it was; the first pose too. False: rows are stable and only
  ///             moved() changed.
  /// error       Failure: more than kMostTriangles drawn
  /// cost        a comparison of each instance's matrices; the bounds of those that moved
  bool setPose(const Scene& scene, const Pose& pose, glm::dvec3 anchorWorld);

  /// To be called after each recorded frame: what moved stands in the buffer now, and moved() is empty until the next
  /// pose. Poses that are set in between add up, so none is lost.
  void settle();

  /// Those whose triangles differ from the settled ones in any bit, in ascending order.
  const std::vector<MovedInstance>& moved() const { return moved_; }
  const std::vector<InstanceRange>& instances() const { return ranges_; }
  const Buffer& triangles() const { return triangles_; } ///< shared::WorldTriangle
  std::uint32_t triangleCount() const { return triangleCount_; }
  const Box& boundsAnchored() const { return bounds_; }
  glm::dvec3 anchorWorld() const { return anchorWorld_; }
  std::size_t bytes() const;

  /// For the pass. The chunks of triangles come first, those of welded vertices behind them.
  std::uint32_t triangleChunks() const { return triangleChunks_; }
  std::uint32_t vertexChunks() const { return vertexChunks_; }
  void bindTables() const; ///< for both of its programs
  void bindFans() const;   ///< of the welded vertices, in the place of the mesh pool's

private:
  /// What decides where an instance's triangles lie.
  struct Placement {
    int node = -1, instance = -1, mesh = -1, skin = -1;
    glm::mat4 worldFromObject{1.0f};
    std::vector<float> morphWeights;
    std::vector<glm::mat4> worldFromBind;
    bool isSameInstance(const Placement& other) const;
    bool isSamePlace(const Placement& other) const;
  };

  void layOut(const std::vector<Placement>& drawn);
  Box boundsOf(const PosedInstance& instance) const;
  shared::WorldInstance rowOf(const Placement& placement, const InstanceRange& range) const;
  void listChunks(const Scene& scene);

  const ResidentScene* resident_;
  std::vector<bool> isSdf_;
  TopologyTable topology_;
  std::vector<std::vector<InstanceBounds>> primitiveBounds_; ///< a mesh each
  std::vector<Placement> placements_, settled_;
  std::vector<Box> settledBounds_;
  std::vector<bool> isMoved_;
  std::vector<std::size_t> posed_; ///< a range: its number in the pose
  std::vector<InstanceRange> ranges_;
  std::vector<MovedInstance> moved_;
  std::vector<shared::WorldInstance> rows_;
  Box bounds_;
  glm::dvec3 anchorWorld_{0};
  std::uint32_t triangleCount_ = 0, triangleChunks_ = 0, vertexChunks_ = 0;
  bool isLaidOut_ = false, isNew_ = false;
  Buffer triangles_, faces_, instances_, chunks_;
};

} // namespace brickfield
