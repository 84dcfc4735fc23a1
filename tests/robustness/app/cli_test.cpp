// The program against wrong input of every kind: exit code 2, one line that names what is wrong, nothing written.
#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/command_line.h"
#include "core/files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Two boxes of one mesh, "Left" and "Right", and nothing else: no file beside it, no camera.
void writeScene(const fs::path& path) {
  static const std::vector<float> corners{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                          -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
  static const std::vector<std::uint16_t> triangles{0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                                    3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5};
  nlohmann::json scene = {
      {"asset", {{"version", "2.0"}}},
      {"scenes", {{{"nodes", {0, 1}}}}},
      {"scene", 0},
      {"nodes", {{{"name", "Left"}, {"mesh", 0}}, {{"name", "Right"}, {"mesh", 0}, {"translation", {3, 0, 0}}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"buffers", {{{"byteLength", 168}, {"uri", "scene.bin"}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", 96}}, {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}}}},
      {"accessors",
       {{{"bufferView", 0},
         {"componentType", 5126},
         {"count", 8},
         {"type", "VEC3"},
         {"min", {-1, -1, -1}},
         {"max", {1, 1, 1}}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}}}}};
  writeFile(path, scene.dump());
  std::string bytes(reinterpret_cast<const char*>(corners.data()), corners.size() * sizeof(float));
  bytes.append(reinterpret_cast<const char*>(triangles.data()), triangles.size() * sizeof(std::uint16_t));
  writeFile(path.parent_path() / "scene.bin", bytes);
}

class CommandLine : public ::testing::Test {
protected:
  void SetUp() override {
    fs::current_path(folder_.path());
    writeScene(folder_ / "scene.gltf");
    folder_.write("text.txt", "no scene");
    folder_.write("text.png", "no picture");
    folder_.write("text.exr", "no picture");
    folder_.write("text.hdr", "no picture");
    folder_.write("text.bricks", "no bricks");
    folder_.write("text.glb", "no scene");
    folder_.write("kept.png", "kept");
    fs::create_directory(folder_ / "folder.png");
  }

  void TearDown() override { fs::current_path("/"); }

  ProgramResult run(const std::vector<std::string>& arguments) const {
    return test::runBrickfield(arguments, folder_.path());
  }

  /// Expects exit code 2 and one line with all `parts`, and a folder as before. In this process: starting the program
  /// some two hundred times would cost a minute; the tests that do start it prove that the exit code comes through.
  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    SCOPED_TRACE(line);
    const std::vector<std::string> before = files();
    ProgramResult result;
    ::testing::internal::CaptureStderr();
    result.exitCode = runCommandLine(arguments);
    result.messages = ::testing::internal::GetCapturedStderr();
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.messages, StartsWith("brickfield: "));
    EXPECT_EQ(std::count(result.messages.begin(), result.messages.end(), '\n'), 1) << result.messages;
    for (const std::string& part : parts) EXPECT_THAT(result.messages, HasSubstr(part));
    EXPECT_EQ(files(), before);
    EXPECT_EQ(readFile(folder_ / "kept.png").size(), 4u);
  }

  /// Hidden ones too: half-written files would be such.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  test::TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpAndVersionAreDone) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"--version"}, {"render", "--help"}, {"bake", "-h"}, {"list", "--help"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.output, HasSubstr("brickfield"));
    EXPECT_EQ(result.messages, "");
  }
}

TEST_F(CommandLine, ProgramEndsWithTheExitCodeAndOneLine) {
  const ProgramResult result = run({"render", "absent.glb", "-o", "a.png"});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_EQ(result.messages, "brickfield: absent.glb: no such file\n");
  EXPECT_EQ(result.output, "");
}

TEST_F(CommandLine, RefusesUnknownCommandsAndFlags) {
  expectRefused({}, {"no command"});
  expectRefused({""}, {"brickfield"});
  expectRefused({"frobnicate"}, {"frobnicate", "render", "bake"});
  expectRefused({"--frob"}, {"--frob"});
  expectRefused({"render", "scene.gltf", "-o", "a.png", "--frob", "3"}, {"render", "--frob"});
  expectRefused({"render", "scene.gltf", "-o", "a.png", "more"}, {"render", "more"});
  expectRefused({"list"}, {"list", "views"});
  expectRefused({"list", "frobs"}, {"list", "frobs"});
}

TEST_F(CommandLine, RefusesMissingAndRepeatedArguments) {
  expectRefused({"render"}, {"render", "SCENE"});
  expectRefused({"render", "scene.gltf"}, {"render", "-o"});
  expectRefused({"render", "scene.gltf", "-o"}, {"-o"});
  expectRefused({"render", "scene.gltf", "-o", "a.png", "-o", "b.png"}, {"render", "output"});
  expectRefused({"bake", "scene.gltf"}, {"bake", "-o"});
  expectRefused({"compare", "text.png"}, {"compare", "B"});
  expectRefused({"list", "cameras"}, {"SCENE"});
}

TEST_F(CommandLine, RefusesInputsThatAreNoScene) {
  for (const char* command : {"render", "reference"}) {
    expectRefused({command, "absent.glb", "-o", "a.png"}, {"absent.glb", "no such file"});
    expectRefused({command, ".", "-o", "a.png"}, {"."});
    expectRefused({command, "text.glb", "-o", "a.png"}, {"text.glb"});
    expectRefused({command, "text.txt", "-o", "a.png"}, {"text.txt"});
    expectRefused({command, "", "-o", "a.png"}, {"SCENE"});
  }
  expectRefused({"bake", "absent.glb", "-o", "a.bricks"}, {"absent.glb", "no such file"});
  expectRefused({"bake", "text.glb", "-o", "a.bricks"}, {"text.glb"});
  expectRefused({"list", "cameras", "absent.glb"}, {"absent.glb"});
  expectRefused({"inspect", "absent.bricks"}, {"absent.bricks", "no such file"});
  expectRefused({"inspect", "text.bricks"}, {"text.bricks"});
  expectRefused({"inspect", "."}, {"."});
}

TEST_F(CommandLine, RefusesOutputsThatCannotBeWritten) {
  for (const char* command : {"render", "reference"}) {
    expectRefused({command, "scene.gltf", "-o", "nowhere/a.png"}, {"nowhere/a.png", "folder does not exist"});
    expectRefused({command, "scene.gltf", "-o", "a.gif"}, {"a.gif", ".png"});
    expectRefused({command, "scene.gltf", "-o", "a"}, {"a", "extension"});
    expectRefused({command, "scene.gltf", "-o", "folder.png"}, {"folder.png", "folder"});
    expectRefused({command, "scene.gltf", "-o", ""}, {"-o"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--layers", "b.png"}, {"b.png", ".exr"});
    expectRefused({command, "scene.gltf", "-o", "a.exr", "--layers", "a.exr"}, {"a.exr", "--layers"});
  }
  expectRefused({"render", "scene.gltf", "-o", "a.png", "--stats", "s.txt"}, {"s.txt", ".json"});
  expectRefused({"bake", "scene.gltf", "-o", "a.glb", "--node", "Left"}, {"a.glb", ".bricks"});
  if (::geteuid() != 0) { // root may write anywhere
    fs::create_directory(folder_ / "locked");
    fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    expectRefused({"render", "scene.gltf", "-o", "locked/a.png"}, {"locked/a.png", "cannot be written"});
  }
}

TEST_F(CommandLine, RefusesValuesOutOfRange) {
  const auto refuse = [&](const char* command, const char* flag, const char* value) {
    const char* output = command == std::string("bake") ? "a.bricks" : "kept.png";
    expectRefused({command, "scene.gltf", "-o", output, flag, value}, {flag});
  };
  for (const char* command : {"render", "reference"}) {
    for (const char* size : {"", "12", "0x5", "5x0", "16385x5", "-4x4", "axb", "1x2x3"})
      refuse(command, "--size", size);
    for (const char* vector : {"1,2", "1,2,3,4", "a,b,c", "1,2,nan", ""}) refuse(command, "--eye", vector);
    for (const char* angle : {"0", "180", "-1", "nan", "wide"}) refuse(command, "--fov", angle);
    for (const char* time : {"nan", "inf", "soon"}) refuse(command, "--time", time);
    for (const char* resolution : {"7", "1025", "1.5", "many"}) refuse(command, "--resolution", resolution);
    for (const char* threads : {"-1", "1025", "x"}) refuse(command, "--threads", threads);
    for (const char* seed : {"-1", "x", "99999999999999999999"}) refuse(command, "--seed", seed);
    for (const char* exposure : {"65", "nan", "x"}) refuse(command, "--exposure", exposure);
    for (const char* light : {"sun", "sun:0,0,0:1:1", "moon:1,2,3:1:1", "sphere:1,2,3:-1:1", ""})
      refuse(command, "--light", light);
    for (const char* pattern : {"Cat*", "", "all,Left"}) refuse(command, "--sdf", pattern);
  }
  for (const char* frames : {"0", "-1", "x", "100001"}) refuse("render", "--frames", frames);
  for (const char* trace : {"", "rays"}) refuse("render", "--trace", trace);
  for (const char* device : {"-1", "x"}) refuse("render", "--device", device);
  for (const char* view : {"sideways"}) refuse("render", "--view", view);
  for (const char* samples : {"0", "65537", "x"}) refuse("reference", "--samples", samples);
  for (const char* resolution : {"7", "1025"}) refuse("bake", "--resolution", resolution);
  for (const char* bits : {"9", "0", "x"}) refuse("bake", "--bits", bits);
  for (const char* mips : {"0", "5"}) refuse("bake", "--mips", mips);
  for (const char* sign : {"", "maybe"}) refuse("bake", "--sign", sign);
  for (const char* thickness : {"-1", "nan"}) refuse("bake", "--thickness", thickness);
}

TEST_F(CommandLine, RefusesCamerasThatAreNot) {
  for (const char* command : {"render", "reference"}) {
    expectRefused({command, "scene.gltf", "-o", "a.png", "--eye", "1,2,3"}, {"--eye", "--target"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--target", "1,2,3"}, {"--target", "--eye"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--eye", "1,2,3", "--target", "1,2,3"}, {"same point"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--camera", "seven"}, {"seven"});
    expectRefused({command, "scene.gltf", "-o", "a.png", "--animation", "Dance", "--time", "1"}, {"Dance"});
  }
}

TEST_F(CommandLine, RefusesEnvironmentsThatAreNone) {
  for (const char* command : {"render", "reference"})
    for (const char* file : {"absent.hdr", "text.hdr", "text.exr", "text.png", ".", ""})
      expectRefused({command, "scene.gltf", "-o", "a.png", "--environment", file},
                    {*file ? std::string(file) : "--environment"});
}

TEST_F(CommandLine, RefusesMeshesThatAreNotClear) {
  expectRefused({"bake", "scene.gltf", "-o", "a.bricks"}, {"--node", "Left", "Right"});
  expectRefused({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Middle"}, {"--node", "Middle"});
}

TEST_F(CommandLine, RefusesPicturesThatCannotBeCompared) {
  expectRefused({"compare", "text.png", "absent.png"}, {"absent.png"});
  expectRefused({"compare", "text.png", "text.png"}, {"text.png"});
  expectRefused({"compare", "text.exr", "text.exr"}, {"text.exr"});
  expectRefused({"compare", "text.png", "text.exr"}, {"text.exr"});
  expectRefused({"compare", "text.txt", "text.txt"}, {"text.txt"});
  expectRefused({"compare", "text.png", "text.png", "--metric", "psnr"}, {"--metric", "psnr"});
  expectRefused({"compare", "text.png", "text.png", "--tolerance", "-1"}, {"--tolerance"});
  expectRefused({"compare", "text.png", "text.png", "--heatmap", "h.exr"}, {"h.exr"});
}

TEST_F(CommandLine, BakesInspectsTracesAndCompares) {
  const auto expectDone = [&](const std::vector<std::string>& arguments) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
    return result.output;
  };
  expectDone({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Left", "--resolution", "16", "--stats", "bake.json"});
  const std::vector<std::byte> stats = readFile(folder_ / "bake.json");
  EXPECT_EQ(nlohmann::json::parse(reinterpret_cast<const char*>(stats.data()),
                                  reinterpret_cast<const char*>(stats.data() + stats.size()))["triangles"],
            12);
  EXPECT_THAT(expectDone({"inspect", "a.bricks", "--slice", "x:0", "-o", "slice.png", "--json", "i.json", "--against",
                          "scene.gltf", "--node", "Left"}),
              HasSubstr("against scene.gltf"));
  expectRefused({"inspect", "a.bricks", "--slice", "x:9", "-o", "b.png"}, {"--slice", "x:9"});
  expectRefused({"inspect", "a.bricks", "--slice", "w:0", "-o", "b.png"}, {"--slice", "w:0"});
  expectRefused({"inspect", "a.bricks", "--slice", "x:0"}, {"--slice", "-o"});
  expectRefused({"inspect", "a.bricks", "-o", "b.png"}, {"-o", "--slice"});

  expectDone({"reference", "scene.gltf", "-o", "a.exr", "--layers", "la.exr", "--size", "32x16"});
  expectDone({"reference", "scene.gltf", "-o", "b.exr", "--layers", "lb.exr", "--size", "32x16", "--light", "none"});
  expectDone({"reference", "scene.gltf", "-o", "small.exr", "--size", "16x16"});
  EXPECT_THAT(expectDone({"compare", "a.exr", "a.exr", "--tolerance", "0"}), HasSubstr("color: rmse 0,"));
  expectDone({"compare", "la.exr", "lb.exr", "--layer", "depth", "--layer", "id", "--tolerance", "0"});
  const ProgramResult over = run({"compare", "la.exr", "lb.exr", "--tolerance", "1e-3", "--heatmap", "heat.png"});
  EXPECT_EQ(over.exitCode, 1);
  EXPECT_THAT(over.output, HasSubstr("over tolerance"));
  EXPECT_TRUE(fs::exists(folder_ / "heat.png"));
  expectRefused({"compare", "a.exr", "small.exr"}, {"small.exr", "size"});
  expectRefused({"compare", "la.exr", "lb.exr", "--layer", "shadow"}, {"la.exr", "shadow"});
}

TEST_F(CommandLine, InterruptLeavesNothingBehind) {
  const std::vector<std::string> before = files();
  // Far more work than fits into the time before the signal, on any machine.
  const ProgramResult result = test::runBrickfield(
      {"reference", "scene.gltf", "-o", "kept.png", "--samples", "65536", "--size", "4096x4096"}, folder_.path(), 1500);
  EXPECT_EQ(result.exitCode, 130) << result.messages;
  EXPECT_EQ(result.messages, "brickfield: cancelled\n");
  EXPECT_EQ(files(), before);
  EXPECT_EQ(readFile(folder_ / "kept.png").size(), 4u);
}

TEST_F(CommandLine, FullDeviceIsNoSuccess) {
  if (!fs::exists("/dev/full")) GTEST_FAIL() << "this machine has no /dev/full";
  const ProgramResult done = run({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Left", "--resolution", "16"});
  ASSERT_EQ(done.exitCode, 0) << done.messages;
  fs::create_symlink("/dev/full", folder_ / "full.json");
  const ProgramResult result = run({"inspect", "a.bricks", "--json", "full.json"});
  EXPECT_NE(result.exitCode, 0);
  EXPECT_THAT(result.messages, HasSubstr("full.json"));
}

} // namespace
} // namespace brickfield
