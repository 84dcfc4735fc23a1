// `bench world-field` as a stranger runs it.
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

class BenchCommand : public CommandLine {};

TEST_F(BenchCommand, RefusesWhatItCannotMeasure) {
  expectRefused({"bench"}, {"bench", "world-field"});
  expectRefused({"bench", "nothing"}, {"bench", "nothing"});
  expectRefused({"bench", "world-field"}, {"SCENE"});
  expectRefused({"bench", "world-field", "absent.glb"}, {"absent.glb", "no such file"});
  expectRefused({"bench", "world-field", "scene.gltf", "--sizes", "XL"}, {"--sizes", "XL"});
  expectRefused({"bench", "world-field", "scene.gltf", "--rays", "65"}, {"--rays", "65"});
  expectRefused({"bench", "world-field", "scene.gltf", "--frames", "0"}, {"--frames", "0"});
  expectRefused({"bench", "world-field", "scene.gltf", "--json", "absent/a.json"}, {"--json", "absent"});
  expectRefused({"bench", "world-field", "scene.gltf", "--json", "scene.bin"}, {"scene.bin"});
}

TEST_F(BenchCommand, WritesTheTimesOfBothMethods) {
  const ProgramResult result = run(
      {"bench", "world-field", "scene.gltf", "--sizes", "S", "--rays", "0", "--frames", "1", "--json", "times.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const std::vector<std::byte> bytes = readFile("times.json");
  const nlohmann::json figures = nlohmann::json::parse(reinterpret_cast<const char*>(bytes.data()),
                                                       reinterpret_cast<const char*>(bytes.data()) + bytes.size());
  EXPECT_EQ(figures.at("triangles"), 24 + 6000);
  const nlohmann::json& results = figures.at("results");
  ASSERT_EQ(results.size(), 4u);
  const auto isTimed = [&](std::size_t i, const char* pass) { return results[i].at("passes_ms").at(pass) > 0.0; };
  EXPECT_TRUE(isTimed(0, "field_splat") && isTimed(0, "field_candidates") && isTimed(0, "field_resolve"));
  EXPECT_TRUE(isTimed(3, "rtsdf_voxelize") && isTimed(3, "rtsdf_jump_flood") && isTimed(3, "rtsdf_rays"));
  // One mover makes less anew than everything, and stillness nothing.
  EXPECT_LT(results[1].at("tiles").at("keys"), results[0].at("tiles").at("keys"));
  EXPECT_EQ(results[2].at("tiles").at("values"), 0);
}

} // namespace
} // namespace brickfield::test
