// From seeds to the coarse field, by jump flooding.
#pragma once

#include "gpu/shader_library.h"
#include "passes/pass.h"
#include "passes/world_field/rtsdf_field.h"

namespace brickfield {

class RtsdfJumpFloodPass {
public:
  explicit RtsdfJumpFloodPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Offsets n/2, n/4, ... 1, from one half of the seeds to the other and back.
  void record(RtsdfField& field);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
