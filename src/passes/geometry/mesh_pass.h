// Triangle meshes into the G-buffer, by the fixed function's rasterizer.
#pragma once

#include <map>
#include <memory>
#include <string>

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
  struct Programs {
    Programs(ShaderLibrary& shaders, const char* label, const char* maskedLabel,
             std::map<std::string, std::string> defines);
    std::shared_ptr<Program> opaque, masked;
  };
  void draw(const FrameContext& context, const DrawRun& run);

  Programs still_, moving_; ///< without and with motion vectors
  static constexpr int kNoMaterial = -2;
  int boundMaterial_ = kNoMaterial; ///< of this record, as the next
  const Program* used_ = nullptr;
  bool hasMotion_ = false; ///< something draws motion vectors
};

/// Empties the G-buffer: far depth, no object.
class ClearPass {
public:
  explicit ClearPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

/// Copies the depth of what has been drawn for the rays of SDF objects to end at.
class DepthCopyPass {
public:
  static PassDeclaration declare();
  void record(const FrameContext& context);
};

} // namespace brickfield
