// Output goes through files in a folder of its own: no pipe can fill up and stall.
#include "tests/support/program.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace brickfield::test {

namespace {

std::string textOf(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

[[noreturn]] void becomeProgram(std::vector<char*>& arguments, const std::filesystem::path& folder,
                                const std::filesystem::path& output, const std::filesystem::path& messages) {
  const int out = ::open(output.c_str(), O_WRONLY | O_CREAT, 0600);
  const int err = ::open(messages.c_str(), O_WRONLY | O_CREAT, 0600);
  if (out < 0 || err < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0 || ::chdir(folder.c_str()) != 0) ::_exit(126);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

using Clock = std::chrono::steady_clock;
constexpr std::chrono::minutes kLongest{2};

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Whether a process has a handler of its own for a signal: on a busy machine it takes its time to get there.
bool catches(pid_t process, int signal) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:")) return std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1;
  return false;
}

/// Waits for the child, sending the interrupt on its way.
int waitFor(pid_t child, const Interrupt& interrupt, ProgramResult& result) {
  const Clock::time_point start = Clock::now();
  Clock::time_point countedFrom = start;
  bool isPending = interrupt.afterMilliseconds > 0, isKilled = false;
  bool isAwaited = isPending;
  int status = 0;
  struct rusage usage {};
  while (::wait4(child, &status, WNOHANG, &usage) == 0) {
    ::usleep(2000);
    const bool isThere = interrupt.awaited.empty() || std::filesystem::exists(interrupt.awaited);
    if (isAwaited && isThere && catches(child, interrupt.signal)) {
      isAwaited = false;
      countedFrom = Clock::now();
    }
    if (isPending && !isAwaited && secondsSince(countedFrom) * 1e3 >= interrupt.afterMilliseconds) {
      isPending = false;
      countedFrom = Clock::now();
      ::kill(child, interrupt.signal);
    }
    if (isKilled || Clock::now() - start < kLongest) continue;
    isKilled = true;
    ADD_FAILURE() << "the program did not end";
    ::kill(child, SIGKILL);
  }
  result.seconds = secondsSince(countedFrom);
  result.cpuSeconds = cpuSecondsOf(usage);
  result.peakBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return status;
}

} // namespace

double cpuSecondsOf(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

ProgramResult runBrickfield(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                            const Interrupt& interrupt) {
  const TemporaryFolder streams;
  const std::filesystem::path output = streams / "output", messages = streams / "messages";
  std::vector<std::string> words{std::string(BRICKFIELD_BINARY_DIR) + "/brickfield"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  const pid_t child = ::fork();
  if (child == 0) becomeProgram(pointers, folder, output, messages);
  ProgramResult result;
  const int status = waitFor(child, interrupt, result);
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.output = textOf(output);
  result.messages = textOf(messages);
  EXPECT_NE(result.exitCode, 127) << words[0] << " could not be started";
  return result;
}

} // namespace brickfield::test
