// Marks the coarse texels that triangles touch.
#pragma once

#include "gpu/shader_library.h"
#include "passes/pass.h"
#include "passes/world_field/rtsdf_field.h"

namespace brickfield {

class RtsdfVoxelizePass {
public:
  explicit RtsdfVoxelizePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// triangles  rows of shared::WorldTriangle; reserveTriangles(triangleCount) was called
  /// bound      every voxel that a triangle touches, and none that all miss by more than 1/4096 of its side
  /// cost       a thread a triangle, a work group one that spans more than 64 voxels
  /// proved by  tests/oracle/passes/rtsdf_coarse_test.cpp
  void record(RtsdfField& field, const Buffer& triangles, std::uint32_t triangleCount);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
