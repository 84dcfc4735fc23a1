// The flags of `bench shadows`.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command to `bench`; parsing it sets `chosen`.
void addShadowBench(CLI::App& bench, CommandAction& chosen);

} // namespace brickfield
