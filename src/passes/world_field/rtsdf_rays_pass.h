// The fine field: random rays near surfaces, equation 1 of the paper, votes for the sign, the bias.
#pragma once

#include "gpu/shader_library.h"
#include "passes/pass.h"
#include "passes/world_field/rtsdf_field.h"
#include "resident/triangle_hierarchy.h"

namespace brickfield {

/// What one frame of rays cost.
struct RtsdfCounts {
  std::uint64_t texels = 0; ///< that sent rays
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;
  std::uint64_t nodeVisits = 0;
  std::uint64_t triangleTests = 0;
};

class RtsdfRaysPass {
public:
  explicit RtsdfRaysPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Makes the field of one frame and counts it as finished.
  ///
  /// bound      directions depend on seed, frame, texel and number of the ray alone: the same bytes in every run
  /// proved by  tests/oracle/passes/rtsdf_test.cpp
  void record(RtsdfField& field, const TriangleHierarchy& hierarchy, const Buffer& triangles);
  /// The same with counting, which is slower; waits for the GPU.
  RtsdfCounts recordCounting(RtsdfField& field, const TriangleHierarchy& hierarchy, const Buffer& triangles);

private:
  static void dispatch(Program& program, RtsdfField& field, const TriangleHierarchy& hierarchy,
                       const Buffer& triangles);

  std::shared_ptr<Program> program_, countingProgram_;
};

} // namespace brickfield
