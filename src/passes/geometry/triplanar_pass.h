// Textures of SDF objects that have no attributes of their own, projected along the axes of object space.
#pragma once

#include "gpu/shader_library.h"
#include "gpu/vertex_array.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class TriplanarPass {
public:
  explicit TriplanarPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Renews base colour, material, emission and shading normal where SceneFields::triplanarOfNode asks for it.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
  VertexArray vertexArray_;
};

} // namespace brickfield
