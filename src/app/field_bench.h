// Times of the world field's passes on one scene, for the exact method and for RTSDF, in one run.
#pragma once

#include <string>
#include <vector>

#include "gpu/timer.h"
#include "passes/frame_context.h"
#include "passes/geometry/deform_pass.h"
#include "passes/world_field/exact_passes.h"
#include "passes/world_field/hierarchy_refit_pass.h"
#include "passes/world_field/rtsdf_jump_flood_pass.h"
#include "passes/world_field/rtsdf_rays_pass.h"
#include "passes/world_field/rtsdf_voxelize_pass.h"
#include "passes/world_field/world_field.h"
#include "passes/world_field/world_triangles_pass.h"
#include "resident/scene_hierarchy.h"

namespace brickfield {

/// What moves while it is measured.
enum class FieldMotion : std::uint8_t { Everything, Mover, Nothing };

/// Median milliseconds of each pass over the frames, in the order of the frame, and what an update worked on.
struct FieldTimes {
  std::vector<PassTime> passes;
  double sumMilliseconds = 0; ///< median of the frames' sums
  std::uint32_t keyTiles = 0, candidateTiles = 0, valueTiles = 0;
  std::uint32_t gathered = 0; ///< triangles
  std::size_t bytes = 0;
};

class FieldBench {
public:
  /// scene  its last node is the mover; must outlive this
  FieldBench(const ContextInfo& info, const Scene& scene, const SceneFields& fields);

  FieldTimes timeExact(const FieldShape& shape, FieldMotion motion, int frames);
  FieldTimes timeRtsdf(const RtsdfSettings& settings, FieldMotion motion, int frames);

  std::uint32_t triangleCount() const { return triangles_.triangleCount(); }

private:
  /// The pose of a frame and whether everything counts as new in it.
  Pose poseOf(FieldMotion motion, int frame) const;
  template <typename Record>
  FieldTimes timeFrames(int frames, const Record& record);
  void gather();

  const Scene& scene_;
  Pose rest_;
  ResidentScene resident_;
  WorldTriangles triangles_;
  SceneHierarchy hierarchy_;
  ShaderLibrary shaders_;
  FrameTimers timers_;
  FrameTargets targets_;
  VisibleBoxes visible_;
  Buffer counters_;
  Texture none_;
  DeformPass deform_;
  WorldTrianglesPass gatherPass_;
  FieldSplatPass splat_;
  FieldCandidatesPass candidates_;
  FieldResolvePass resolve_;
  HierarchyRefitPass refit_;
  RtsdfVoxelizePass voxelize_;
  RtsdfJumpFloodPass flood_;
  RtsdfRaysPass rays_;
};

/// A copy of the scene with one more node, "Mover", last: a torus of about 6,000 triangles, a twelfth of the scene's
/// longest side across. What the published figures call a moving object.
Scene withMover(const Scene& scene);

} // namespace brickfield
