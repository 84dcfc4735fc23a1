// Deferred light: direct, image-based, emission, sky.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class LightingPass {
public:
  explicit LightingPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
