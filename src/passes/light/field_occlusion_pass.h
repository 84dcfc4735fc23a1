// Ambient occlusion by the world field: traced at some pixels, then spread over all.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class FieldOcclusionPass {
public:
  explicit FieldOcclusionPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::occlusionTraced, which must have been made. The frame must have a world field.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> programs_[2][2]; ///< cones one after the other or side by side; counting or not
};

class OcclusionSpreadPass {
public:
  explicit OcclusionSpreadPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::occlusion.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_, countingProgram_;
};

} // namespace brickfield
