// brickfield render: a frame of a scene to a picture and its layers. Drawing itself is behind run_render.h.
#pragma once

#include "app/command.h"

namespace brickfield {

struct RenderRequest;

/// What a frame is made of: scene, camera, light, exposure, frames, shadows, occlusion and all else but what is
/// written.
void addFrameOptions(CLI::App& command, RenderRequest& request);
/// Checks what flags can be told of each other, settles what follows.
/// error BadInput
void settleFrameOptions(RenderRequest& request);

/// Adds the command; parsing it sets `chosen`.
void addRenderCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
