// brickfield bake: the mesh of one node to a .bricks file.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addBakeCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
