// Averages the frame with those before it, along motion vectors.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class TaaPass {
public:
  explicit TaaPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// The frame must have FrameContext::temporal.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
