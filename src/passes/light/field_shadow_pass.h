// Soft shadows of the first lights by marching the world field, and bricks where objects have any.
#pragma once

#include <array>

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class FieldShadowPass {
public:
  explicit FieldShadowPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// Fills FrameTargets::shadow. The frame must have a world field.
  void record(const FrameContext& context);

private:
  enum Source : std::size_t { kField, kBricks, kPublished, kSources };
  Program& choose(const FrameContext& context, bool counts);
  void fill(const FrameContext& context, Program& marching, bool counts);
  std::shared_ptr<Program> load(Source source, bool mapsDecide, bool counts) const;

  ShaderLibrary* shaders_;
  std::array<std::array<std::shared_ptr<Program>, 4>, kSources> programs_; ///< by variant; made when first used
  std::array<std::shared_ptr<Program>, 2> fillPrograms_;                   ///< with counts the second; the same
};

} // namespace brickfield
