// Motion vectors of all that moves as a whole.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class MotionPass {
public:
  explicit MotionPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills Temporal::motion but where MeshPass has drawn it.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
