// Skins and morphs vertices into the mesh pool, before anything draws them.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class DeformPass {
public:
  explicit DeformPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
