// Output goes through files in a folder of its own: no pipe can fill up and stall.
#include "tests/support/program.h"

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

} // namespace

ProgramResult runBrickfield(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                            int interruptAfterMilliseconds) {
  const TemporaryFolder streams;
  const std::filesystem::path output = streams / "output", messages = streams / "messages";
  std::vector<std::string> words{std::string(BRICKFIELD_BINARY_DIR) + "/brickfield"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  const pid_t child = ::fork();
  if (child == 0) becomeProgram(pointers, folder, output, messages);
  if (interruptAfterMilliseconds > 0) {
    ::usleep(static_cast<useconds_t>(interruptAfterMilliseconds) * 1000);
    ::kill(child, SIGINT);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ProgramResult result;
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.output = textOf(output);
  result.messages = textOf(messages);
  EXPECT_NE(result.exitCode, 127) << words[0] << " could not be started";
  return result;
}

} // namespace brickfield::test
