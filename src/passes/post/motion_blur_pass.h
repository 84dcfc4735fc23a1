// Smears what moves, the camera's motion too.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class MotionBlurPass {
public:
  explicit MotionBlurPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Renews FrameTargets::color. The frame must have temporal antialiasing, whose older history is written over.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> tilesProgram_, blurProgram_;
  Texture tiles_; ///< RG16F: the longest way of 16 x 16 pixels
};

} // namespace brickfield
