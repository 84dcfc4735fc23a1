// A view as the shaders' frame parameters tell it; the same for the camera and for the views of shadow maps.
#pragma once

#include "scene/view.h"
#include "shared/frame_params.h"

namespace brickfield {

/// Fills what depends on the view alone: matrices, eye, projection, size.
void setViewParams(shared::FrameParams& params, const View& view);

} // namespace brickfield
