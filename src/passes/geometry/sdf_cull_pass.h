// Chooses the visible SDF objects and writes the draw commands of their boxes.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class SdfCullPass {
public:
  explicit SdfCullPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
