// Outputs are judged before the long work: what cannot be written, what is no file, and what would overwrite an input.
#include <fstream>

#include <sys/stat.h>

#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

using ::testing::HasSubstr;

class Output : public CommandLine {
protected:
  struct Flag {
    std::vector<std::string> command; ///< that takes the flag last
    std::string extension;
  };

  /// Every flag that names a file to write.
  std::vector<Flag> flags() const {
    return {{{"render", "scene.gltf", "-o"}, ".png"},
            {{"render", "scene.gltf", "-o"}, ".exr"},
            {{"render", "scene.gltf", "-o", "a.png", "--layers"}, ".exr"},
            {{"render", "scene.gltf", "-o", "a.png", "--stats"}, ".json"},
            {{"reference", "scene.gltf", "-o"}, ".exr"},
            {{"reference", "scene.gltf", "-o", "a.png", "--layers"}, ".exr"},
            {{"bake", "scene.gltf", "--node", "Left", "-o"}, ".bricks"},
            {{"bake", "scene.gltf", "--node", "Left", "-o", "a.bricks", "--stats"}, ".json"},
            {{"compare", "a.exr", "b.exr", "--heatmap"}, ".png"},
            {{"inspect", "text.bricks", "--slice", "x:0", "-o"}, ".png"},
            {{"inspect", "text.bricks", "--json"}, ".json"}};
  }

  void expectRefusedAt(const Flag& flag, const std::string& path, const std::string& reason) {
    std::vector<std::string> arguments = flag.command;
    arguments.push_back(path);
    expectRefused(arguments, {"brickfield: " + path + ": " + flag.command.back() + ": ", reason});
  }
};

TEST_F(Output, EveryFlagRefusesWhatCannotBeWritten) {
  for (const Flag& flag : flags()) {
    const std::string end = flag.extension;
    const std::string pipe = "pipe" + end, socket = "socket" + end, folder = "a_folder" + end;
    ::mkfifo((folder_ / pipe).c_str(), 0600);
    ::mknod((folder_ / socket).c_str(), S_IFSOCK | 0600, 0);
    fs::create_directory(folder_ / folder);
    expectRefusedAt(flag, pipe, "is a named pipe");
    expectRefusedAt(flag, socket, "is a socket");
    expectRefusedAt(flag, folder, "names a folder");
    expectRefusedAt(flag, "nowhere/a" + end, "folder does not exist");
    expectRefusedAt(flag, "text.txt/a" + end, "folder does not exist");
    expectRefusedAt(flag, std::string(300, 'a') + end, "File name too long");
    expectRefusedAt(flag, "/proc/a" + end, "cannot be written");
    expectRefusedAt(flag, "a.gif", "extension");
    expectRefusedAt(flag, "extensionless", "has no extension");
  }
}

TEST_F(Output, FilesOfTheSceneAreKept) {
  nlohmann::json scene = nlohmann::json::parse(std::ifstream(folder_ / "scene.gltf"));
  scene["images"] = {{{"uri", "not%20used.png"}}, {{"uri", "data:image/png;base64,AAAA"}}, {{"uri", "missing.png"}}};
  scene["buffers"][0]["uri"] = "bytes.bricks";
  writeFile(folder_ / "scene.gltf", scene.dump());
  fs::rename(folder_ / "scene.bin", folder_ / "bytes.bricks");
  folder_.write("not used.png", "no material uses it, and yet it is the scene's");
  fs::create_symlink("not used.png", folder_ / "link.png");
  fs::create_directory(folder_ / "inner");
  for (const char* command : {"render", "reference"})
    for (const char* path : {"not used.png", "./not used.png", "link.png", "inner/../not used.png", "missing.png"})
      expectRefused({command, "scene.gltf", "-o", path}, {std::string(path) + ": -o: is a file of scene.gltf"});
  expectRefused({"bake", "scene.gltf", "--node", "Left", "-o", "bytes.bricks"}, {"bytes.bricks: -o: is a file of"});
  EXPECT_EQ(readFile(folder_ / "not used.png").size(), 46u);
}

TEST_F(Output, InputsAreKeptUnderEveryName) {
  fs::create_hard_link(folder_ / "text.hdr", folder_ / "hard.exr");
  fs::create_symlink("text.hdr", folder_ / "soft.exr");
  for (const char* command : {"render", "reference"})
    for (const char* path : {"hard.exr", "soft.exr"})
      expectRefused({command, "scene.gltf", "-o", path, "--environment", "text.hdr"}, {path, "is a file that is read"});
  expectRefused({"compare", "kept.png", "kept.png", "--heatmap", "kept.png"}, {"kept.png: --heatmap: is a file that"});
  expectRefused({"reference", "scene.gltf", "-o", "new.exr", "--layers", "./new.exr"}, {"is the file of -o too"});
}

TEST_F(Output, DevicesAreWrittenAndStay) {
  const std::vector<std::string> before = files();
  const ProgramResult result =
      run({"reference", "scene.gltf", "-o", "/dev/null", "--layers", "/dev/null", "--size", "8x8"});
  EXPECT_EQ(result.exitCode, 0) << result.messages;
  EXPECT_EQ(run({"bake", "scene.gltf", "--node", "Left", "--resolution", "8", "-o", "/dev/null"}).exitCode, 0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(files(), before);
}

TEST_F(Output, StandardOutputTakesStatistics) {
  const ProgramResult result = run({"render", "scene.gltf", "-o", "a.png", "--size", "8x8", "--stats", "/dev/stdout"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  EXPECT_TRUE(nlohmann::json::accept(result.output)) << result.output;
  EXPECT_TRUE(fs::exists(fs::symlink_status("/dev/stdout")));
}

TEST_F(Output, StandardOutputThatIsFullIsNoSuccess) {
  const std::string full = std::string(BRICKFIELD_BINARY_DIR) + "/brickfield list views > /dev/full 2>/dev/null";
  const int status = std::system(full.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

} // namespace
} // namespace brickfield::test
