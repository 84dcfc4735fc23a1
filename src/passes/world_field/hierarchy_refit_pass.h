// Fits the bounds of the triangle hierarchy to the triangles that moved.
#pragma once

#include "gpu/shader_library.h"
#include "passes/pass.h"
#include "resident/triangle_hierarchy.h"

namespace brickfield {

class HierarchyRefitPass {
public:
  explicit HierarchyRefitPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Does the hierarchy's schedule: a dispatch for each height that is wide, one for the rest of all trees, one for the
  /// tree over instances. With nothing moved it is the last alone, or none.
  void record(const TriangleHierarchy& hierarchy, const Buffer& triangles);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
