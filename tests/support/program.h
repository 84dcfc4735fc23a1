// Runs the built brickfield program as a user would.
#pragma once

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace brickfield::test {

struct ProgramResult {
  int exitCode = -1;    ///< -1: ended by a signal
  std::string output;   ///< stdout
  std::string messages; ///< stderr
  double seconds = 0;   ///< after an interrupt: from there to the end
  /// Of all threads, user and system together: whatever else the machine does meanwhile. No less than `seconds` on an
  /// idle machine, unless the program waits.
  double cpuSeconds = 0;
  std::uint64_t peakBytes = 0;
};

/// User and system time of a process.
double cpuSecondsOf(const rusage& usage);

/// A signal that is sent while the program works.
struct Interrupt {
  int afterMilliseconds = 0; ///< from when the program catches the signal; 0: never
  int signal = SIGINT;
  std::filesystem::path awaited; ///< counted only once this file or folder is there as well; empty: at once
};

/// Runs it to its end; what does not end within two minutes is killed, with a failure of the test.
///
/// arguments without the program's name
/// folder    working folder
ProgramResult runBrickfield(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                            const Interrupt& interrupt = {});

} // namespace brickfield::test
