// brickfield inspect: what a .bricks file holds, a slice through it, its error against the mesh.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addInspectCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
