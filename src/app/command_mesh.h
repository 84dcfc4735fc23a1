// brickfield mesh: the surface that a .bricks file holds, as triangles in a .glb.
#pragma once

#include "app/command.h"

namespace brickfield {

void addMeshCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
