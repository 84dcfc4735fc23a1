// The averaged picture to the frame's colour, sharpened.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class TaaSharpenPass {
public:
  explicit TaaSharpenPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// The frame must have FrameContext::temporal.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
