// Light through SDF objects, and how thick they are.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class TranslucencyPass {
public:
  explicit TranslucencyPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::translucent and thickness, which must have been made.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_, countingProgram_;
};

} // namespace brickfield
