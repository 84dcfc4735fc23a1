// brickfield reference: the same picture traced on the CPU against the source triangles.
#pragma once

#include "app/command.h"

namespace brickfield {

/// Adds the command; parsing it sets `chosen`.
void addReferenceCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
