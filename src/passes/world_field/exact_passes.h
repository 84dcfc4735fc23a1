// The exact world field in four passes. Each works on the lists of ExactField::prepare and does nothing where they are
// empty: a still scene costs nothing.
#pragma once

#include "gpu/shader_library.h"
#include "passes/pass.h"
#include "passes/world_field/exact_field.h"
#include "passes/world_field/nearest_points.h"
#include "resident/resident_scene.h"

namespace brickfield {

/// Forgets the keys of the tiles that are made anew.
class FieldClearPass {
public:
  explicit FieldClearPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const ExactField& field);

private:
  std::shared_ptr<Program> clear_;
};

/// Surface keys: every triangle leaves its distance and number in the texels within kFieldSplatTexels of it.
class FieldSplatPass {
public:
  explicit FieldSplatPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const ExactField& field, const Buffer& triangles);

private:
  std::shared_ptr<Program> splat_, parts_;
};

/// Nearest triangles at half resolution, as far as the range: seeds, a distance transform in a window, a round among
/// neighbours.
class FieldCandidatesPass {
public:
  explicit FieldCandidatesPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(const ExactField& field, const Buffer& triangles);

private:
  void sweep(const ExactField& field);

  std::shared_ptr<Program> seeds_, sweep_, candidates_;
};

/// Distances and nodes: two rounds at full resolution, signs, SDF objects.
class FieldResolvePass {
public:
  explicit FieldResolvePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  void record(ExactField& field, const Buffer& triangles, const ResidentScene& scene);

private:
  void resolveBand(const ExactField& field);
  void makeSides(ExactField& field);
  void joinObjects(const ExactField& field, const ResidentScene& scene);

  std::shared_ptr<Program> evaluate_, refine_, refineListed_, farValues_, far_, sides_, objects_, objectsOfFlipped_,
      search_, store_;
  NearestPoints nearestPoints_;
};

} // namespace brickfield
