// The program's face: parses the command line, runs one command, turns every outcome into an exit code.
#pragma once

#include <string>
#include <vector>

namespace brickfield {

/// Exit codes; others script against them. A comparison over its tolerance is kOurFailure. After SIGINT it is 130,
/// after SIGTERM 143.
enum ExitCode : int { kDone = 0, kOurFailure = 1, kBadInput = 2 };

/// Runs the program.
///
/// arguments without the program's name
/// returns   an ExitCode; on failure one line has gone to stderr: "brickfield: FILE: ELEMENT: reason"
/// proved by tests/robustness/app/cli_test.cpp
int runCommandLine(std::vector<std::string> arguments);

} // namespace brickfield
