// The reference image: Embree primary rays against the source triangles, with the renderer's camera and materials.
// Direct light with hard shadows or without, unshadowed environment light. What the renderer is measured against.
#pragma once

#include <functional>

#include "core/progress.h"
#include "scene/frame_layers.h"
#include "scene/lighting.h"
#include "scene/view.h"

namespace brickfield {

struct ReferenceRequest {
  const Scene* scene = nullptr;
  const Pose* pose = nullptr;
  const View* view = nullptr;
  const Lighting* lighting = nullptr;
  std::function<bool(int node)> isSdf; ///< marks the `kind` layer; the geometry is the mesh all the same
  bool shadows = true;                 ///< false: lights pass through everything, as in a renderer without shadows
  int samples = 1; ///< a pixel; the first goes through the centre and alone makes all layers but colour
  std::uint64_t seed = 0;
  int threads = 0; ///< 0: all
};

/// Back faces of single-sided materials are culled, alpha masks are cut; layers as FrameLayers says.
/// error Cancelled; Failure from Embree; BadInput: the scene reaches beyond 1e11 metres, the eye beyond that
FrameLayers traceReference(const ReferenceRequest& request, const Progress& progress = {});

} // namespace brickfield
