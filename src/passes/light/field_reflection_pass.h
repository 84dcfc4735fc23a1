// Reflections by the world field: what reflected rays meet, then how bright it is.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class FieldReflectionPass {
public:
  explicit FieldReflectionPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::reflectionHit, which must have been made. The frame must have an exact world field.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_, countingProgram_;
};

class ReflectionShadePass {
public:
  explicit ReflectionShadePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::reflection.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
