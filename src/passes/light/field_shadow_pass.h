// Soft shadows of the first lights by marching the world field.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class FieldShadowPass {
public:
  explicit FieldShadowPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::shadow. The frame must have a world field.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_, countingProgram_;
};

} // namespace brickfield
