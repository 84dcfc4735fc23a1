// brickfield render: a frame of a scene to a picture and its layers. Drawing itself is behind run_render.h.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addRenderCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
