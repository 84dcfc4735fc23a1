// Triangle meshes into the G-buffer, by the fixed function's rasterizer.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class MeshPass {
public:
  explicit MeshPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
  std::shared_ptr<Program> motionProgram_; ///< the same with motion vectors
};

/// Empties the G-buffer: far depth, no object.
class ClearPass {
public:
  static PassDeclaration declare();
  void record(const FrameContext& context);
};

/// Copies the depth of what has been drawn for the rays of SDF objects to end at.
class DepthCopyPass {
public:
  static PassDeclaration declare();
  void record(const FrameContext& context);
};

} // namespace brickfield
