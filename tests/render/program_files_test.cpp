// The program as a user runs it: render and reference of one scene, their statistics and layers, compared.
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "app/image_io.h"
#include "app/layers_io.h"
#include "core/files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {
namespace {

using ::testing::HasSubstr;

/// An octahedron of one metre and, two metres to its right, the same mesh again.
void writeScene(const std::filesystem::path& path) {
  const std::vector<float> corners{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  const std::vector<std::uint16_t> triangles{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const nlohmann::json scene = {
      {"asset", {{"version", "2.0"}}},
      {"scenes", {{{"nodes", {0, 1}}}}},
      {"scene", 0},
      {"nodes", {{{"name", "Left"}, {"mesh", 0}}, {{"name", "Right"}, {"mesh", 0}, {"translation", {2, 0, 0}}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"buffers", {{{"byteLength", 120}, {"uri", "scene.bin"}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", 72}}, {{"buffer", 0}, {"byteOffset", 72}, {"byteLength", 48}}}},
      {"accessors",
       {{{"bufferView", 0},
         {"componentType", 5126},
         {"count", 6},
         {"type", "VEC3"},
         {"min", {-1, -1, -1}},
         {"max", {1, 1, 1}}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 24}, {"type", "SCALAR"}}}}};
  writeFile(path, scene.dump());
  std::string bytes(reinterpret_cast<const char*>(corners.data()), corners.size() * sizeof(float));
  bytes.append(reinterpret_cast<const char*>(triangles.data()), triangles.size() * sizeof(std::uint16_t));
  writeFile(path.parent_path() / "scene.bin", bytes);
}

class ProgramFiles : public ::testing::Test {
protected:
  void SetUp() override { writeScene(folder_ / "scene.gltf"); }

  ProgramResult run(const std::vector<std::string>& arguments) const {
    ProgramResult result = runBrickfield(arguments, folder_.path());
    EXPECT_EQ(result.messages, "");
    return result;
  }
  ProgramResult runOn(const std::string& command, std::vector<std::string> arguments) const {
    const std::vector<std::string> shared{command,        "scene.gltf", "--size", "64x36", "--sdf",    "all",
                                          "--resolution", "32",         "--eye",  "1,1,4", "--target", "1,0,0"};
    arguments.insert(arguments.begin(), shared.begin(), shared.end());
    ProgramResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 0);
    return result;
  }
  nlohmann::json readJson(const char* name) const {
    std::ifstream file(folder_ / name);
    return nlohmann::json::parse(file);
  }

  TemporaryFolder folder_;
};

// Both nodes share one field. What is measured must not change what is drawn.
TEST_F(ProgramFiles, StatisticsTellOfTheRunAndLeaveThePictureAlone) {
  const std::vector<std::string> cache{"--cache", "cache", "--frames", "3"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), cache.begin(), cache.end());
    return more;
  };
  runOn("render", with({"-o", "first.png", "--stats", "first.json"}));
  runOn("render", with({"-o", "second.png", "--stats", "second.json"}));
  runOn("render", with({"-o", "plain.png"}));
  EXPECT_EQ(readFile(folder_ / "first.png"), readFile(folder_ / "plain.png"));
  const nlohmann::json first = readJson("first.json"), second = readJson("second.json");
  EXPECT_EQ(first["cache"]["misses"], 1);
  EXPECT_EQ(first["cache"]["hits"], 0);
  EXPECT_EQ(second["cache"]["misses"], 0);
  EXPECT_EQ(second["cache"]["hits"], 1);
  EXPECT_LT(second["seconds"]["bake"], first["seconds"]["bake"]);
  for (const char* stage : {"load", "bake", "draw"}) EXPECT_GT(first["seconds"][stage], 0.0) << stage;
  EXPECT_EQ(first["milliseconds"]["frames_cpu"].size(), 3u);
  EXPECT_EQ(first["milliseconds"]["frames_gpu"].size(), 3u);
  EXPECT_GT(first["milliseconds"]["passes_min"]["sdf_box"], 0.0);
  EXPECT_GE(first["milliseconds"]["passes_median"]["sdf_box"], first["milliseconds"]["passes_min"]["sdf_box"]);
  EXPECT_EQ(first["timers"]["kind"], first["gpu"]["software"] ? "software" : "queries");
  EXPECT_EQ(first["counts"]["sdf_visible"], 2);
  EXPECT_GT(first["counts"]["hits"], 100);
  EXPECT_GT(first["counts"]["steps"], first["counts"]["hits"]);
  EXPECT_EQ(first["settings"]["eye"], (nlohmann::json{1.0, 1.0, 4.0}));
}

// "auto" becomes the way that was faster here; by both the picture is the same.
TEST_F(ProgramFiles, TraceTellsHowObjectsWereFound) {
  for (const std::string way : {"boxes", "tiles", "auto"}) {
    runOn("render",
          {"-o", way + ".png", "--layers", way + ".exr", "--stats", way + ".json", "--trace", way, "--cache", "cache"});
    const nlohmann::json stats = readJson((way + ".json").c_str());
    const std::string told = stats["settings"]["trace"];
    EXPECT_TRUE(told == way || (way == "auto" && (told == "boxes" || told == "tiles"))) << told;
    EXPECT_EQ(stats["milliseconds"]["passes_min"].contains("sdf_tiles"), told == "tiles");
    EXPECT_EQ(stats["milliseconds"]["passes_min"].contains("sdf_box"), told == "boxes");
  }
  run({"render", "scene.gltf", "-o", "none.png", "--size", "64x36", "--stats", "none.json", "--trace", "tiles", "--sdf",
       "none"});
  EXPECT_EQ(readJson("none.json")["settings"]["trace"], "boxes") << "there is nothing to trace";
  for (const char* way : {"tiles.exr", "auto.exr"})
    EXPECT_EQ(run({"compare", way, "boxes.exr", "--layer", "depth", "--tolerance", "0"}).exitCode, 0) << way;
}

// Every layer that one has the other has, and steps, which only the renderer makes, fail no comparison.
TEST_F(ProgramFiles, LayersOfRenderAndReferenceMatch) {
  runOn("render", {"-o", "a.exr", "--layers", "la.exr", "--cache", "cache"});
  runOn("reference", {"-o", "b.exr", "--layers", "lb.exr", "--shadows", "none"});
  const FrameLayers reference = readLayers(folder_ / "lb.exr");
  EXPECT_EQ(reference.steps, std::vector<float>(64 * 36, 0.0f));
  for (const auto& [a, b] : {std::pair("la.exr", "lb.exr"), std::pair("lb.exr", "la.exr")}) {
    const ProgramResult result = run({"compare", a, b, "--tolerance", "1", "--unmatched", "0.1"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    for (const char* layer : {"color", "depth", "normal", "normal_surface", "albedo", "id", "kind", "steps"})
      EXPECT_THAT(result.output, HasSubstr(std::string(layer) + ": "));
    EXPECT_EQ(run({"compare", a, b, "--tolerance", "1", "--layer", "steps"}).exitCode, 1) << "steps asked for count";
  }
}

} // namespace
} // namespace brickfield::test
