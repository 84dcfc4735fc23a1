// From bricks to triangles and back by the program, and bakes that are refused for their memory.
#include "field/bricks_file.h"
#include "scene/gltf_import.h"
#include "tests/robustness/app/command_line_fixture.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield::test {
namespace {

class MeshCommand : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    expectDone({"bake", "scene.gltf", "-o", "a.bricks", "--node", "Left", "--resolution", "32", "--mips", "2"});
  }
  static std::string jsonText(const fs::path& path) {
    const std::vector<std::byte> bytes = readFile(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  static void expectDone(const std::vector<std::string>& arguments) {
    ::testing::internal::CaptureStdout();
    const ProgramResult result = runHere(arguments);
    ::testing::internal::GetCapturedStdout();
    EXPECT_EQ(result.exitCode, 0) << result.messages;
    EXPECT_EQ(result.messages, "");
  }
};

TEST_F(MeshCommand, WritesWhatBakesAgain) {
  expectDone({"mesh", "a.bricks", "-o", "a.glb"});
  expectDone({"bake", "a.glb", "-o", "again.bricks", "--resolution", "32", "--mips", "2", "--stats", "again.json"});
  const nlohmann::json stats = nlohmann::json::parse(jsonText(folder_ / "again.json"));
  EXPECT_EQ(stats["open_edges"], 0);
  EXPECT_EQ(stats["non_manifold_edges"], 0);
  EXPECT_GT(stats["triangles"], 1000);
  // The box of edge 2 against what was made of its first bake: off where its edges were cut, within a voxel.
  expectDone({"inspect", "again.bricks", "--against", "scene.gltf", "--node", "Left", "--json", "error.json"});
  const nlohmann::json error = nlohmann::json::parse(jsonText(folder_ / "error.json"))["against"];
  EXPECT_EQ(error["triangles"], 12);
  EXPECT_EQ(error["closed_triangles"], 12);
  EXPECT_LT(error["levels"][0]["max_voxels"], 0.8);
  EXPECT_LT(error["levels"][0]["rms_voxels"], 0.1);
  expectDone({"mesh", "a.bricks", "-o", "coarse.glb", "--level", "1", "--iso", "-0.02"});
  EXPECT_LT(fs::file_size(folder_ / "coarse.glb"), fs::file_size(folder_ / "a.glb"));
}

TEST_F(MeshCommand, WritesWhatTheSurfaceEmitsInTheMean) {
  BrickField field = fieldOf(sphereBody(), 48, 8, 2);
  addAttributes(field, [](glm::vec3 p) {
    SurfaceAttributes a;
    a.emission = (p.x - kCenter.x + kRadius) / kRadius * glm::vec3(4, 0.5f, 0); // twice that on one side, dark opposite
    return a;
  });
  writeBricksFile(folder_ / "lamp.bricks", field);
  for (const char* level : {"0", "1"}) {
    expectDone({"mesh", "lamp.bricks", "-o", "lamp.glb", "--level", level});
    const Scene scene = importGltf(folder_ / "lamp.glb");
    const glm::vec3 emission = materialOf(scene, scene.meshes[0].primitives[0]).emission;
    EXPECT_NEAR(emission.x, 4, 0.1f); // vertices are spread over the sphere nearly evenly
    EXPECT_NEAR(emission.y, 0.5f, 0.0125f);
    EXPECT_EQ(emission.z, 0);
  }
}

TEST_F(MeshCommand, RefusesWrongInput) {
  expectRefused({"mesh"}, {"BRICKS"});
  expectRefused({"mesh", "a.bricks"}, {"--output"});
  expectRefused({"mesh", "absent.bricks", "-o", "a.glb"}, {"absent.bricks", "no such file"});
  expectRefused({"mesh", "text.bricks", "-o", "a.glb"}, {"text.bricks", "header"});
  expectRefused({"mesh", "a.bricks", "-o", "a.png"}, {"a.png", "-o", ".glb"});
  expectRefused({"mesh", "a.bricks", "-o", "absent/a.glb"}, {"absent/a.glb", "-o"});
  expectRefused({"mesh", "a.bricks", "-o", "a.glb", "--level", "2"}, {"--level", "a.bricks has 2"});
  expectRefused({"mesh", "a.bricks", "-o", "a.glb", "--level", "-1"}, {"--level", "-1"});
  expectRefused({"mesh", "a.bricks", "-o", "a.glb", "--iso", "1"}, {"--iso", "0.9 voxels"});
  expectRefused({"mesh", "a.bricks", "-o", "a.glb", "--iso", "nan"}, {"--iso", "nan"});
  expectRefused({"mesh", "a.bricks", "-o", "a.glb", "--level", "0", "--level", "1"}, {"mesh", "--level", "once"});
}

TEST_F(MeshCommand, InspectRefusesLevelsThatAreNotThere) {
  expectRefused({"inspect", "a.bricks", "--slice", "x:0", "-o", "b.png", "--level", "2"}, {"--level", "2"});
  expectRefused({"inspect", "a.bricks", "--level", "1"}, {"--level", "--slice"});
  expectDone({"inspect", "a.bricks", "--slice", "x:0", "-o", "b.png", "--level", "1"});
}

TEST_F(MeshCommand, BakesThatNeedMoreMemoryAreRefused) {
  for (const char* text : {"2", "2GB", "0MiB", "-1GiB", "many"})
    expectRefused({"bake", "scene.gltf", "-o", "b.bricks", "--node", "Left", "--memory", text}, {"--memory", text});
  expectRefused({"bake", "scene.gltf", "-o", "b.bricks", "--node", "Left", "--resolution", "256", "--memory", "20MiB"},
                {"node 0 \"Left\"", "level 0", "needs", "more than 20 MiB", "lower the resolution"});
  expectRefused({"render", "scene.gltf", "-o", "b.png", "--sdf", "all", "--resolution", "256", "--cache", "cache",
                 "--memory", "20MiB"},
                {"node 0 \"Left\"", "needs", "more than 20 MiB"});
  expectDone({"bake", "scene.gltf", "-o", "b.bricks", "--node", "Left", "--resolution", "32", "--memory", "20MiB"});
}

} // namespace
} // namespace brickfield::test
