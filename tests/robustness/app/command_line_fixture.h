// A folder with a small scene and files that are no scene, and commands that are refused in it.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "core/files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {

namespace fs = std::filesystem;

/// Two boxes of one mesh, "Left" and "Right", and nothing else: no file beside it, no camera.
inline void writeScene(const fs::path& path) {
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
    return runBrickfield(arguments, folder_.path());
  }

  /// The same in this process, standard output left alone: starting the program some hundred times would cost a minute;
  /// the tests that do start it prove that the exit code comes through.
  static ProgramResult runHere(const std::vector<std::string>& arguments) {
    ProgramResult result;
    struct rusage before {};
    ::getrusage(RUSAGE_SELF, &before);
    const auto start = std::chrono::steady_clock::now();
    ::testing::internal::CaptureStderr();
    result.exitCode = runCommandLine(arguments);
    result.messages = ::testing::internal::GetCapturedStderr();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
    result.cpuSeconds = cpuSecondsOf(usage) - cpuSecondsOf(before);
    result.peakBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // of all until now
    return result;
  }

  /// Expects exit code 2 and one line with all `parts`, and a folder as before.
  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    SCOPED_TRACE(line);
    const std::vector<std::string> before = files();
    const ProgramResult result = runHere(arguments);
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.messages, ::testing::StartsWith("brickfield: "));
    EXPECT_EQ(std::count(result.messages.begin(), result.messages.end(), '\n'), 1) << result.messages;
    for (const std::string& part : parts) EXPECT_THAT(result.messages, ::testing::HasSubstr(part));
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

  TemporaryFolder folder_;
};

} // namespace brickfield::test
