// Makes the exact world field of posed scenes without a renderer, and reads it back.
#pragma once

#include <bit>
#include <filesystem>

#include "passes/geometry/deform_pass.h"
#include "passes/world_field/exact_passes.h"
#include "passes/world_field/world_field.h"
#include "passes/world_field/world_triangles_pass.h"

namespace brickfield::test {

/// The field of one cascade on the CPU, in the window's order: x fastest, from its first texel on.
struct FieldSnapshot {
  FieldWindow window;
  glm::dvec3 anchorWorld{0};
  std::vector<float> distances;     ///< texels
  std::vector<std::uint32_t> nodes; ///< node + 1, 0 for none

  glm::ivec3 latticeOf(std::size_t texel) const;
  glm::dvec3 centerAnchored(std::size_t texel) const { return (glm::dvec3(latticeOf(texel)) + 0.5) * window.texelSize; }
  bool operator==(const FieldSnapshot&) const = default;
};

class WorldFieldStage {
public:
  WorldFieldStage(const Scene& scene, const SceneFields& fields, const FieldShape& shape);

  /// One frame; only what moved since the last is made anew.
  void frame(const Pose& pose, glm::dvec3 eyeWorld);
  /// Moments of posing by seconds; negative: the rest pose.
  void frameAt(double seconds, glm::dvec3 eyeWorld = glm::dvec3(0));

  FieldSnapshot read(std::size_t cascade = 0) const;
  const WorldField& field() const { return field_; }
  const WorldTriangles& triangles() const { return triangles_; }

private:
  const Scene& scene_;
  ResidentScene resident_;
  WorldTriangles triangles_;
  WorldField field_;
  ShaderLibrary shaders_;
  DeformPass deform_;
  FieldClearPass clear_;
  WorldTrianglesPass gather_;
  PseudonormalsPass pseudonormals_;
  FieldSplatPass splat_;
  FieldCandidatesPass candidates_;
  FieldResolvePass resolve_;
};

} // namespace brickfield::test
