// brickfield list: the names that other commands take: views, passes, cameras of a scene, devices.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addListCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
