// `bench shadows` as a stranger runs it.
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

class BenchShadowsCommand : public CommandLine {};

nlohmann::json jsonFrom(const fs::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  return nlohmann::json::parse(reinterpret_cast<const char*>(bytes.data()),
                               reinterpret_cast<const char*>(bytes.data()) + bytes.size());
}

TEST_F(BenchShadowsCommand, RefusesWhatItCannotMeasure) {
  expectRefused({"bench", "shadows"}, {"SCENE"});
  expectRefused({"bench", "shadows", "absent.glb"}, {"absent.glb", "no such file"});
  expectRefused({"bench", "shadows", "scene.gltf", "absent.glb"}, {"absent.glb", "no such file"});
  const auto expectFlag = [&](const std::string& flag, const std::string& text) {
    expectRefused({"bench", "shadows", "scene.gltf", flag, text}, {flag, text});
  };
  expectFlag("--methods", "best");
  expectFlag("--suns", "91");
  expectFlag("--sun-travels", "0,0,0");
  expectFlag("--sphere-radius", "-1");
  expectFlag("--samples", "0");
  expectFlag("--field-size", "XL");
  expectFlag("--shadow-bricks", "10");
  expectFlag("--frames", "0");
  expectFlag("--json", "absent/a.json");
  expectFlag("--plates", "absent");
  folder_.write("empty.gltf", R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
  expectRefused({"bench", "shadows", "empty.gltf"}, {"empty.gltf", "no triangle"});
}

// Two boxes on a floor: each method has figures of each light; the second run reads the truth and finds the same.
TEST_F(BenchShadowsCommand, MeasuresEachMethodAndLightAgainstAKeptTruth) {
  fs::create_directory("plates");
  const std::vector<std::string> command{
      "bench",     "shadows", "scene.gltf", "--floor",    "--size",       "48x32", "--suns",          "8",
      "--frames",  "1",       "--methods",  "field,hard", "--field-size", "S",     "--shadow-bricks", "128",
      "--samples", "16",      "--truth",    "truth",      "--cache",      "cache", "--plates",        "plates",
      "--json",    "a.json"};
  const ProgramResult first = run(command);
  ASSERT_EQ(first.exitCode, 0) << first.messages;
  const nlohmann::json figures = jsonFrom("a.json"), &methods = figures.at("scenes")[0].at("methods");
  ASSERT_EQ(methods.size(), 2u);
  for (const nlohmann::json& method : methods) {
    ASSERT_EQ(method.at("lights").size(), 2u);
    for (const nlohmann::json& light : method.at("lights")) {
      EXPECT_GT(light.at("errors").at("pixels"), 100);
      EXPECT_GT(light.at("reads").at("mean"), 0.0);
      EXPECT_GT(light.at("passes_ms").at("field_shadow"), 0.0);
    }
  }
  const auto rmse = [&](std::size_t method) {
    return methods[method].at("lights")[0].at("errors").at("rmse").get<double>();
  };
  EXPECT_LT(rmse(0), 0.1) << "soft shadows of two boxes";
  EXPECT_NE(rmse(1), rmse(0)) << "hard ones are others";
  EXPECT_TRUE(fs::is_regular_file("plates/scene.png"));
  ASSERT_EQ(std::distance(fs::directory_iterator("truth"), fs::directory_iterator{}), 1);
  const auto written = fs::last_write_time(fs::directory_iterator("truth")->path());
  ASSERT_EQ(run(command).exitCode, 0);
  EXPECT_EQ(fs::last_write_time(fs::directory_iterator("truth")->path()), written) << "traced once";
  EXPECT_EQ(jsonFrom("a.json").at("scenes")[0].at("methods")[0].at("lights")[0].at("errors"),
            methods[0].at("lights")[0].at("errors"));
}

// Shadow maps read no field; with one they read less of it than without.
TEST_F(BenchShadowsCommand, MeasuresShadowMapsBesideTheField) {
  const ProgramResult result =
      run({"bench",        "shadows", "scene.gltf",      "--floor", "--size",    "48x32",
           "--suns",       "8",       "--frames",        "1",       "--methods", "field,csm+field,csm-pcf",
           "--field-size", "S",       "--shadow-bricks", "128",     "--samples", "16",
           "--truth",      "truth",   "--sphere-radius", "0",       "--cache",   "cache",
           "--json",       "a.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json figures = jsonFrom("a.json"), &methods = figures.at("scenes")[0].at("methods");
  const auto sun = [&](std::size_t method) { return methods.at(method).at("lights")[0]; };
  EXPECT_LT(sun(1).at("reads").at("mean"), sun(0).at("reads").at("mean"));
  EXPECT_GT(sun(1).at("passes_ms").at("shadow_range"), 0.0);
  for (std::size_t method = 1; method < 3; ++method) {
    EXPECT_GT(sun(method).at("passes_ms").at("shadow_map"), 0.0);
    EXPECT_LT(sun(method).at("errors").at("rmse"), 0.3);
    if (method > 1) {
      EXPECT_EQ(sun(method).at("reads").at("mean"), 0.0);
    }
  }
  EXPECT_NE(sun(1).at("errors"), sun(2).at("errors"));
}

} // namespace
} // namespace brickfield::test
