// brickfield bench frame: its flags.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addFrameBench(CLI::App& bench, CommandAction& chosen);

} // namespace brickfield
