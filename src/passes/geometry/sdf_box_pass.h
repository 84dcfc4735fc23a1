// SDF objects as boxes whose fragments sphere-trace bricks and write conservative depth: one indirect draw for all.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class SdfBoxPass {
public:
  explicit SdfBoxPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
  std::shared_ptr<Program> countingProgram_; ///< the same with counters, which cost early rejection
};

} // namespace brickfield
