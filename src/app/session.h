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

/// The first SIGINT or SIGTERM sets isInterrupted, the same once more ends the process at once; only then may a
/// temporary file ".brickfield-*" stay beside an output.
void catchInterrupts();

/// As shells count: 128 and the signal's number, so 130 after SIGINT and 143 after SIGTERM.
int interruptedExitCode();

/// One line on stderr: "brickfield: TEXT".
void printError(std::string_view text);
void printWarning(std::string_view text);

/// What the importer left out or repaired, a line each. Called when all input is checked, right before the long work,
/// so that a command that refuses its input says one line and no more.
void printWarnings(const Scene& scene);

/// error Cancelled after Ctrl-C
void throwIfInterrupted();

} // namespace brickfield
