// Shadows of the first lights from their shadow maps.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class MapShadowPass {
public:
  explicit MapShadowPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::shadow. The frame must have shadow maps.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
