// Draws the shadow maps: meshes, deformed and masked ones too, and SDF objects, traced through their boxes from the
// light.
#pragma once

#include "gpu/shader_library.h"
#include "passes/frame_context.h"
#include "passes/pass.h"

namespace brickfield {

class ShadowMapPass {
public:
  explicit ShadowMapPass(ShaderLibrary& shaders);
  static PassDeclaration declare();
  /// The frame must have shadow maps. Leaves the camera's view as the frame's.
  void record(const FrameContext& context);

private:
  void drawMeshes(const FrameContext& context, int layer);
  void drawBoxes(const FrameContext& context, int layer);

  std::shared_ptr<Program> opaque_, masked_, cull_, boxes_, countingBoxes_;
};

} // namespace brickfield
