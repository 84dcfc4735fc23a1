// `bench frame` as a stranger runs it.
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

class BenchFrameCommand : public CommandLine {};

TEST_F(BenchFrameCommand, RefusesWhatItCannotMeasure) {
  expectRefused({"bench", "frame"}, {"SCENE"});
  expectRefused({"bench", "frame", "absent.glb"}, {"absent.glb", "no such file"});
  expectRefused({"bench", "frame", "scene.gltf", "--beside", "paper"}, {"--beside", "paper"});
  expectRefused({"bench", "frame", "scene.gltf", "--frames", "0"}, {"--frames", "0"});
  expectRefused({"bench", "frame", "scene.gltf", "--json", "absent/a.json"}, {"absent"});
  expectRefused({"bench", "frame", "scene.gltf", "--size", "16x16", "--frames", "1", "--beside", "thesis"},
                {"--beside", "0 SDF objects"});
}

// What it prints is what it writes: each pass of the frame, their sum, and what a pixel of it read.
TEST_F(BenchFrameCommand, MeasuresEachPassAndCountsAPixel) {
  const ProgramResult result =
      run({"bench", "frame", "scene.gltf", "--size", "32x32", "--frames", "3", "--shadows", "csm+field", "--ao",
           "cones", "--field-texels", "64", "--shadow-size", "64", "--json", "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const std::vector<std::byte> bytes = readFile("a.json");
  const nlohmann::json figures = nlohmann::json::parse(reinterpret_cast<const char*>(bytes.data()),
                                                       reinterpret_cast<const char*>(bytes.data()) + bytes.size());
  const nlohmann::json &times = figures.at("milliseconds"), &passes = times.at("passes_median");
  EXPECT_EQ(times.at("frames_gpu").size(), 3u);
  for (const char* pass : {"mesh", "shadow_map", "shadow_range", "field_shadow", "field_occlusion", "lighting"}) {
    EXPECT_TRUE(passes.contains(pass)) << pass;
    EXPECT_LE(times.at("passes_min").at(pass), passes.at(pass));
  }
  const double pixels = 32.0 * 32, reads = figures.at("counts").at("ao_reads");
  EXPECT_GT(reads, 0.0);
  EXPECT_NEAR(figures.at("per_pixel").at("ao_reads").get<double>(), reads / pixels, 1e-9);
  EXPECT_NEAR(figures.at("per_pixel").at("bytes_marched").get<double>(),
              16 * (reads + figures.at("counts").at("shadow_reads").get<double>()) / pixels, 1e-6);
}

} // namespace
} // namespace brickfield::test
