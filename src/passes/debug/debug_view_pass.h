// Shows one layer of the frame instead of the picture.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class DebugViewPass {
public:
  explicit DebugViewPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

/// Counts the fragments of SDF boxes at every pixel, hidden ones too.
class BoxOverdrawPass {
public:
  explicit BoxOverdrawPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
