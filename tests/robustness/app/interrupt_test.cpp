// Ctrl-C and a polite kill in the middle of every long work: the program ends soon with the signal's code, says so in
// one line, and leaves no file that was not there before.
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

/// Work goes on between two looks at the flag for a brick batch, a pixel or a frame, each well below a second; the rest
/// is room for a machine that is busy with other things. The work itself would take far longer than this and the signal
/// together.
constexpr double kSoonSeconds = 10.0;

class Interrupted : public CommandLine {
protected:
  void expectEndsSoon(const std::vector<std::string>& arguments, Interrupt interrupt) {
    SCOPED_TRACE(arguments.front() + " and signal " + std::to_string(interrupt.signal));
    const std::vector<std::string> before = files();
    const ProgramResult result = runBrickfield(arguments, folder_.path(), interrupt);
    EXPECT_EQ(result.exitCode, 128 + interrupt.signal) << result.messages;
    EXPECT_EQ(result.messages, "brickfield: cancelled\n");
    EXPECT_LT(result.seconds, kSoonSeconds);
    EXPECT_EQ(files(), before);
    EXPECT_EQ(readFile(folder_ / "kept.png").size(), 4u);
  }
};

TEST_F(Interrupted, ReferenceEndsSoon) {
  const std::vector<std::string> arguments{"reference", "scene.gltf", "-o",     "kept.png",
                                           "--samples", "65536",      "--size", "4096x4096"};
  expectEndsSoon(arguments, {1500, SIGINT, {}});
  expectEndsSoon(arguments, {1500, SIGTERM, {}});
}

TEST_F(Interrupted, BakeEndsSoon) {
  const std::vector<std::string> arguments{"bake", "scene.gltf",   "-o",  "a.bricks",  "--node",
                                           "Left", "--resolution", "600", "--threads", "1"};
  expectEndsSoon(arguments, {700, SIGINT, {}});
  expectEndsSoon(arguments, {700, SIGTERM, {}});
}

TEST_F(Interrupted, RenderEndsSoonWhileItBakes) {
  fs::create_directory(folder_ / "cache");
  const std::vector<std::string> arguments{"render",       "scene.gltf", "-o",      "kept.png", "--sdf",     "all",
                                           "--resolution", "600",        "--cache", "cache",    "--threads", "1"};
  expectEndsSoon(arguments, {1500, SIGTERM, {}});
  EXPECT_TRUE(fs::is_empty(folder_ / "cache")) << "no half entry, no temporary file";
}

TEST_F(Interrupted, RenderEndsSoonBetweenFrames) {
  fs::create_directory(folder_ / "cache");
  const std::vector<std::string> arguments{"render",       "scene.gltf", "-o",      "kept.png", "--stats",  "s.json",
                                           "--layers",     "l.exr",      "--sdf",   "all",      "--frames", "100000",
                                           "--resolution", "16",         "--cache", "cache",    "--size",   "320x180"};
  expectEndsSoon(arguments, {1500, SIGINT, {}});
  expectEndsSoon(arguments, {1500, SIGTERM, {}});
}

} // namespace
} // namespace brickfield::test
