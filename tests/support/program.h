// Runs the built brickfield program as a user would.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace brickfield::test {

struct ProgramResult {
  int exitCode = -1;    ///< -1: ended by a signal
  std::string output;   ///< stdout
  std::string messages; ///< stderr
};

/// arguments without the program's name
/// folder    working folder
/// interruptAfterMilliseconds SIGINT is sent then; 0: never
ProgramResult runBrickfield(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                            int interruptAfterMilliseconds = 0);

} // namespace brickfield::test
