// Times of the world field's passes on one scene, for the exact method and for RTSDF, in one run.
#pragma once

#include <string>
#include <vector>

#include "app/field_motion.h"
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

/// Medians over the frames, and what the last one worked on.
struct FieldTimes {
  double milliseconds = 0; ///< of the whole update, on the GPU
  /// In the order of the frame, of other frames: a timer keeps a pass from running beside the next, so they sum to
  /// more.
  std::vector<PassTime> passes;
  double planMilliseconds = 0; ///< on the CPU: what moved, which tiles, uploads
  struct Tiles {
    std::uint32_t keys = 0, candidates = 0, values = 0;
  } tiles;                    ///< of the exact field, made anew
  std::uint32_t gathered = 0; ///< triangles that moved
  std::uint32_t drawn = 0;    ///< triangles that may have left keys
  std::uint32_t sdfObjects = 0;
  std::size_t bytes = 0; ///< of GPU memory

  double of(std::string_view pass) const; ///< milliseconds; 0: it was not recorded
};

class FieldBench {
public:
  /// scene  must outlive this
  FieldBench(const ContextInfo& info, const Scene& scene, const SceneFields& fields);

  /// The eye stands in the middle of the scene.
  FieldTimes timeExact(const FieldShape& shape, const PoseOfFrame& poseOf, int frames);
  /// Of triangles alone: SDF objects are not in it.
  FieldTimes timeRtsdf(const RtsdfSettings& settings, const PoseOfFrame& poseOf, int frames);

private:
  /// record  of a frame's number; returns the milliseconds of its plan
  template <typename Record>
  FieldTimes timeFrames(int frames, const Record& record);
  template <typename Record>
  void timeUpdate(const Record& record);
  template <typename Record>
  void timePass(const char* name, GLbitfield barriers, const Record& record);
  void recordExact(ExactField& exact);
  void recordRtsdf(RtsdfField& field);

  const Scene& scene_;
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
  WorldTrianglesPass gather_;
  PseudonormalsPass pseudonormals_;
  FieldClearPass clear_;
  FieldSplatPass splat_;
  FieldCandidatesPass candidates_;
  FieldResolvePass resolve_;
  HierarchyRefitPass refit_;
  RtsdfVoxelizePass voxelize_;
  RtsdfJumpFloodPass flood_;
  RtsdfRaysPass rays_;
  bool arePassesApart_ = false; ///< each with a timer of its own, in every other frame
};

} // namespace brickfield
