// Reflections by the world field: which pixels trace a ray, what these meet, how bright it is, what the others take of
// it.
#pragma once

#include <array>

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class ReflectionPlacesPass {
public:
  explicit ReflectionPlacesPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::reflectionList, which must have been made, and FrameTargets::reflectionHit of all pixels that
  /// are not in it.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

class FieldReflectionPass {
public:
  explicit FieldReflectionPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::reflectionHit of the listed pixels. The frame must have an exact world field.
  void record(const FrameContext& context);

private:
  Program& choose(bool hasBricks, bool counts);

  ShaderLibrary* shaders_;
  std::array<std::shared_ptr<Program>, 4> programs_; ///< by variant; made when first used
};

class ReflectionShadePass {
public:
  explicit ReflectionShadePass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::reflection of the listed pixels.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

class ReflectionSpreadPass {
public:
  explicit ReflectionSpreadPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::reflection of all others.
  void record(const FrameContext& context);

private:
  std::shared_ptr<Program> program_;
};

} // namespace brickfield
