// Gathers the triangles of the meshes that moved into one buffer of the world, and gives them pseudonormals.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class WorldTrianglesPass {
public:
  explicit WorldTrianglesPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Nothing where context.worldTriangles is null or nothing moved. Deformed vertices must stand in the pool.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> positions_;
};

/// Of the triangles that were gathered; touches nothing of them that says where they are.
class PseudonormalsPass {
public:
  explicit PseudonormalsPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> pseudonormals_;
};

} // namespace brickfield
