// Exposure, filmic tone curve and sRGB: radiance to the picture.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class TonePass {
public:
  explicit TonePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
