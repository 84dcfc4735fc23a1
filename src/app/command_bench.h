// `brickfield bench`.
#pragma once

#include "app/command.h"

namespace brickfield {

void addBenchCommand(CLI::App& program, CommandAction& chosen);

} // namespace brickfield
