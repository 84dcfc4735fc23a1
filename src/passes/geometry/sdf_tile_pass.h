// SDF objects traced in compute, by tiles of pixels: the other way to what SdfBoxPass draws.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

/// Where the boxes of visible objects lie on the picture.
class ScreenBoxPass {
public:
  explicit ScreenBoxPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

/// Writes the G-buffer and FrameTargets::depthTraced.
class SdfTilePass {
public:
  explicit SdfTilePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_, countingProgram_;
};

} // namespace brickfield
