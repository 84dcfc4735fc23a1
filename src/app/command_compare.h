// brickfield compare: how far two pictures, or the layers of two files, are apart.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addCompareCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
