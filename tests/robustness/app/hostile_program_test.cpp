// The whole program over the folder of hostile scenes and over damaged .bricks: exit code 0 or 2, in time and memory,
// and exactly one error line where it is 2. What each file's outcome has to be is the importer's test
// (robustness/scene).
#include <cstdio>
#include <fstream>
#include <random>

#include "tests/robustness/app/command_line_fixture.h"
#include "tests/support/data.h"

namespace brickfield::test {
namespace {

/// The process alone, with its libraries and a driver, takes about 135 MiB, with a frame on llvmpipe about 265 MiB.
constexpr std::uint64_t kMemoryAllowed = std::uint64_t{1} << 30;
/// Processor time: what else the machine does meanwhile is no fault of the program. Threads that work side by side only
/// make it stricter.
constexpr double kCpuSecondsAllowed = 10.0;
/// Against waiting for what never comes, which takes no processor time; room for a machine that is busy five times
/// over.
constexpr double kSecondsAllowed = 60.0;

std::vector<fs::path> hostileScenes() {
  std::vector<fs::path> files;
  for (const auto& found : fs::recursive_directory_iterator(dataFile("hostile")))
    if (found.path().extension() == ".gltf" || found.path().extension() == ".glb") files.push_back(found.path());
  std::sort(files.begin(), files.end());
  return files;
}

class HostileProgram : public CommandLine {
protected:
  void TearDown() override {
    CommandLine::TearDown();
    std::printf("%d runs, %d done, slowest %.2f s of processor time (%s), largest %.0f MiB (%s)\n", runs_, done_,
                slowest_.cpuSeconds, slowestName_.c_str(), static_cast<double>(largest_.peakBytes) / (1 << 20),
                largestName_.c_str());
  }

  void expectDoneOrRefused(const ProgramResult& result, const std::string& name) {
    SCOPED_TRACE(name);
    EXPECT_LT(result.cpuSeconds, kCpuSecondsAllowed);
    EXPECT_LT(result.seconds, kSecondsAllowed);
    EXPECT_LT(result.peakBytes, kMemoryAllowed);
    std::istringstream lines(result.messages);
    int errors = 0, warnings = 0;
    for (std::string line; std::getline(lines, line);) {
      EXPECT_TRUE(line.starts_with("brickfield: ")) << line;
      (line.starts_with("brickfield: warning: ") ? warnings : errors) += 1;
    }
    EXPECT_TRUE(result.exitCode == 0 || result.exitCode == 2) << result.exitCode << ": " << result.messages;
    EXPECT_EQ(errors, result.exitCode == 0 ? 0 : 1) << result.messages;
    if (result.exitCode == 2) {
      EXPECT_EQ(warnings, 0) << "what is refused says one line and no more: " << result.messages;
      EXPECT_THAT(result.messages, ::testing::HasSubstr(name + ": "));
    }
    EXPECT_THAT(result.messages, ::testing::Not(::testing::HasSubstr("json.exception")));
    count(result, name);
  }

private:
  void count(const ProgramResult& result, const std::string& name) {
    ++runs_;
    done_ += result.exitCode == 0;
    if (result.cpuSeconds > slowest_.cpuSeconds) slowest_ = result, slowestName_ = name;
    if (result.peakBytes > largest_.peakBytes) largest_ = result, largestName_ = name;
  }

  int runs_ = 0, done_ = 0;
  ProgramResult slowest_, largest_;
  std::string slowestName_, largestName_;
};

/// Every scene through import, pose, lights, triangles and rays; all in this process, which a crash would end.
TEST_F(HostileProgram, EveryScene) {
  BRICKFIELD_NEEDS_DATA("hostile/README.md");
  for (const fs::path& file : hostileScenes())
    expectDoneOrRefused(runHere({"reference", file.string(), "-o", "x.png", "--size", "4x4"}), file.string());
}

/// A dozen that load, each odd in another way, through bake, upload and frame as well.
TEST_F(HostileProgram, OddScenesThatAreDrawn) {
  BRICKFIELD_NEEDS_DATA("hostile/README.md");
  for (const char* file :
       {"asset_generator_negative/Mesh_NoPosition/Mesh_NoPosition_00.gltf",
        "assimp/boxbadnormals-gltf-binary/BoxBadNormals.glb", "assimp/issue_3269/texcoord_crash.gltf",
        "assimp/testnorootnode/SceneWithoutNodes.gltf", "cgltf_fuzz/Box.glb", "cgltf_fuzz/TriangleWithoutIndices.gltf",
        "sharpgltf/Invalid_EmptyArray.gltf", "tinygltf/regression/issue-492.glb", "validator/mesh/uv.gltf",
        "validator/mesh_data/colors_non_clamped.gltf", "validator/node/rotation_non_unit.gltf",
        "validator/skin/no_joints_in_scene.gltf"}) {
    const std::string path = dataFile("hostile/" + std::string(file)).string();
    expectDoneOrRefused(run({"render", path, "-o", "x.png", "--size", "64x36", "--sdf", "all", "--cache", "cache"}),
                        path);
  }
}

TEST_F(HostileProgram, DamagedBricks) {
  ASSERT_EQ(run({"bake", "scene.gltf", "--node", "Left", "--resolution", "24", "-o", "whole.bricks"}).exitCode, 0);
  const std::vector<std::byte> whole = readFile(folder_ / "whole.bricks");
  std::mt19937 random(20240229); // the same damage in every run
  for (int i = 0; i < 40; ++i) {
    std::vector<std::byte> damaged = whole;
    if (i % 3 == 0) {
      damaged.resize(random() % whole.size());
    } else { // half of the flips in header and index
      const std::size_t offset = random() % (i % 3 == 1 ? std::min<std::size_t>(whole.size(), 400) : whole.size());
      damaged[offset] ^= std::byte(1u << random() % 8);
    }
    writeFile(folder_ / "damaged.bricks", damaged);
    expectDoneOrRefused(run({"inspect", "damaged.bricks"}), "damaged.bricks");
  }
}

} // namespace
} // namespace brickfield::test
