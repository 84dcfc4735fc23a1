// What every command shares: the messages of the program on stderr and the flag that Ctrl-C sets. The only room that
// prints; results go to stdout, everything else to stderr.
#pragma once

#include <atomic>
#include <string_view>

#include "core/progress.h"
#include "scene/scene.h"

namespace brickfield {

/// True after SIGINT or SIGTERM; what Progress::cancelled points to.
const std::atomic<bool>& isInterrupted();

/// The first SIGINT or SIGTERM sets isInterrupted, the second ends the process as usual.
void catchInterrupts();

/// One line on stderr: "brickfield: TEXT".
void printError(std::string_view text);
void printWarning(std::string_view text);

/// What the importer left out or repaired, a line each. Called when all input is checked, right before the long work,
/// so that a command that refuses its input says one line and no more.
void printWarnings(const Scene& scene);

/// error Cancelled after Ctrl-C
void throwIfInterrupted();

} // namespace brickfield
