// Rounded to single precision once.
#include "passes/view_params.h"

namespace brickfield {

void setViewParams(shared::FrameParams& params, const View& view) {
  params.clipFromEye = glm::mat4(clipFromEye(view));
  params.worldFromView = view.worldFromView;
  params.eyeWorld = glm::vec4(view.eyeWorld, view.nearDistance);
  params.projection.x = view.clipFromView[0][0];
  params.projection.y = view.clipFromView[1][1];
  params.projection.z = view.orthographic ? 1.0f : 0.0f;
  params.jitter = glm::vec4(view.jitterNdc, 0, 0);
  params.size.x = view.sizePixels.x;
  params.size.y = view.sizePixels.y;
}

} // namespace brickfield
