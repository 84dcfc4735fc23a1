// Nearest and farthest depths over squares of the shadow maps' texels, a pyramid for questions about wide lights.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class ShadowRangePass {
public:
  explicit ShadowRangePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// The frame must have shadow maps with ranges.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
