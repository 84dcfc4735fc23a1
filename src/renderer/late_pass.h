// Passes that most frames do without: compiled when a frame first has them, and recorded from a frame's context,
// whatever of it they take.
#pragma once

#include <optional>

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"
#include "passes/world_field/exact_passes.h"
#include "passes/world_field/field_frame.h"
#include "passes/world_field/hierarchy_refit_pass.h"
#include "passes/world_field/rtsdf_jump_flood_pass.h"
#include "passes/world_field/rtsdf_rays_pass.h"
#include "passes/world_field/rtsdf_voxelize_pass.h"

namespace brickfield {

inline void recordPass(FieldClearPass& pass, const FrameContext& frame) { pass.record(*frame.field->exact); }
inline void recordPass(FieldSplatPass& pass, const FrameContext& frame) {
  pass.record(*frame.field->exact, frame.worldTriangles->triangles());
}
inline void recordPass(FieldCandidatesPass& pass, const FrameContext& frame) {
  pass.record(*frame.field->exact, frame.worldTriangles->triangles());
}
inline void recordPass(FieldResolvePass& pass, const FrameContext& frame) {
  pass.record(*frame.field->exact, frame.worldTriangles->triangles(), frame.scene);
}
inline void recordPass(HierarchyRefitPass& pass, const FrameContext& frame) {
  pass.record(*frame.field->hierarchy, frame.worldTriangles->triangles());
}
inline void recordPass(RtsdfVoxelizePass& pass, const FrameContext& frame) {
  pass.record(*frame.field->rtsdf, frame.worldTriangles->triangles(), frame.worldTriangles->triangleCount());
}
inline void recordPass(RtsdfJumpFloodPass& pass, const FrameContext& frame) { pass.record(*frame.field->rtsdf); }
inline void recordPass(RtsdfRaysPass& pass, const FrameContext& frame) {
  pass.record(*frame.field->rtsdf, *frame.field->hierarchy, frame.worldTriangles->triangles());
}
template <typename Pass>
requires requires(Pass pass, const FrameContext& frame) { pass.record(frame); }
void recordPass(Pass& pass, const FrameContext& frame) { pass.record(frame); }

/// A pass whose shaders are compiled when a frame first has it.
template <typename Pass>
class LatePass {
public:
  static PassDeclaration declare() { return Pass::declare(); }
  void make(ShaderLibrary& shaders) {
    if (!pass_) pass_.emplace(shaders);
  }
  void record(const FrameContext& frame) { recordPass(*pass_, frame); }

private:
  std::optional<Pass> pass_;
};

template <typename Pass>
constexpr bool isLate = requires(Pass pass, ShaderLibrary& shaders) {
  pass.make(shaders);
};

} // namespace brickfield
