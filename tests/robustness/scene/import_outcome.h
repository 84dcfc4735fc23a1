// One import in a process of its own, so that a crash, a hang or an allocation without bound is an outcome like any
// other and names the file.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "scene/gltf_import.h"

namespace brickfield::test {

enum class Ending { Loaded, Refused, Crashed, Hung };

struct ImportOutcome {
  Ending ending = Ending::Crashed;
  std::string message; ///< of BadInput, or what went wrong
  double seconds = 0.0;
  std::uint64_t peakBytes = 0; ///< resident
};

inline const char* name(Ending ending) {
  switch (ending) {
  case Ending::Loaded:
    return "loaded";
  case Ending::Refused:
    return "refused";
  case Ending::Crashed:
    return "crashed";
  default:
    return "hung";
  }
}

inline ImportOutcome importApart(const std::filesystem::path& path, int secondsAllowed = 10) {
  int pipeEnds[2];
  if (::pipe(pipeEnds) != 0) return {};
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipeEnds[0]);
    std::string report;
    try {
      importGltf(path);
      report = "L";
    } catch (const BadInput& error) {
      report = std::string("R") + error.what();
    } catch (const std::exception& error) {
      report = std::string("X") + error.what();
    }
    const ssize_t written = ::write(pipeEnds[1], report.data(), report.size());
    ::_exit(written == static_cast<ssize_t>(report.size()) ? 0 : 1);
  }
  ::close(pipeEnds[1]);
  std::string report;
  ImportOutcome outcome;
  const auto deadline = start + std::chrono::seconds(secondsAllowed);
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd waiting{pipeEnds[0], POLLIN, 0};
    if (left.count() <= 0 || ::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) {
      outcome.ending = Ending::Hung;
      ::kill(child, SIGKILL);
      break;
    }
    char buffer[4096];
    const ssize_t count = ::read(pipeEnds[0], buffer, sizeof buffer);
    if (count <= 0) break;
    report.append(buffer, static_cast<std::size_t>(count));
  }
  ::close(pipeEnds[0]);
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.peakBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  if (outcome.ending == Ending::Hung) return outcome;
  const bool isWell = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !report.empty();
  if (isWell && report[0] == 'L') outcome.ending = Ending::Loaded;
  if (isWell && report[0] == 'R') outcome.ending = Ending::Refused;
  outcome.message = report.empty() ? "ended without a word" : report.substr(1);
  return outcome;
}

} // namespace brickfield::test
