// Shows the world field instead of the picture: cut by a plane, or its surface from the camera.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class FieldViewPass {
public:
  explicit FieldViewPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// context.field must not be null.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
