// `bench world-field` as a stranger runs it.
#include "app/bench_world_field.h"
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

class BenchCommand : public CommandLine {};

TEST_F(BenchCommand, RefusesWhatItCannotMeasure) {
  expectRefused({"bench"}, {"bench", "world-field"});
  expectRefused({"bench", "nothing"}, {"bench", "nothing"});
  expectRefused({"bench", "world-field"}, {"SCENE"});
  expectRefused({"bench", "world-field", "absent.glb"}, {"absent.glb", "no such file"});
  const auto expectFlag = [&](const std::string& flag, const std::string& text) {
    expectRefused({"bench", "world-field", "scene.gltf", flag, text}, {flag, text});
  };
  expectFlag("--sizes", "XL");
  expectFlag("--sizes", "");
  expectFlag("--show", "table2");
  expectFlag("--rays", "65");
  expectRefused({"bench", "world-field", "scene.gltf", "--rays", "1,"}, {"--rays", "no whole number"});
  expectFlag("--masks", "-1");
  expectFlag("--frames", "0");
  expectFlag("--movers", "0");
  expectFlag("--movers", "all");
  expectFlag("--field-cascades", "9");
  expectFlag("--field-texels", "96");
  expectRefused({"bench", "world-field", "scene.gltf", "--field-texels", "128"},
                {"--field-texels", "requires --movers"});
  expectRefused({"bench", "world-field", "scene.gltf", "--movers", "5", "--show", "table3"}, {"--movers", "--show"});
  expectFlag("--error-frames", "0");
  expectFlag("--error-samples", "0");
  expectFlag("--bandwidth", "0");
  expectFlag("--tera-operations", "nan");
  expectRefused({"bench", "world-field", "scene.gltf", "--json", "absent/a.json"}, {"--json", "absent"});
  expectRefused({"bench", "world-field", "scene.gltf", "--json", "scene.bin"}, {"scene.bin"});
  expectRefused({"bench", "world-field", "scene.gltf", "--movers", "5"}, {"scene.gltf", "no SDF object", "--sdf"});
  folder_.write("empty.gltf", R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
  expectRefused({"bench", "world-field", "empty.gltf"}, {"empty.gltf", "no triangle"});
  expectRefused({"bench", "world-field", "scene.gltf", "--sdf", "Nobody"}, {"--sdf", "Nobody"});
}

nlohmann::json jsonFrom(const fs::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  return nlohmann::json::parse(reinterpret_cast<const char*>(bytes.data()),
                               reinterpret_cast<const char*>(bytes.data()) + bytes.size());
}

TEST_F(BenchCommand, TableOfSizesHasBothMethodsBesideThePublished) {
  const ProgramResult result =
      run({"bench", "world-field", "scene.gltf", "--show", "table3", "--sizes", "S", "--rays", "0,2", "--frames", "1",
           "--json", "times.json", "--bandwidth", "20", "--tera-operations", "0.1"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json figures = jsonFrom("times.json");
  EXPECT_EQ(figures.at("triangles"), 24 + 6000);
  EXPECT_FALSE(figures.contains("table1") || figures.contains("table4") || figures.contains("errors"));
  const nlohmann::json& rows = figures.at("table3");
  ASSERT_EQ(rows.size(), 5u);
  const auto isTimed = [&](std::size_t i, const char* pass) { return rows[i].at("passes_ms").at(pass) > 0.0; };
  EXPECT_TRUE(isTimed(0, "rtsdf_voxelize") && isTimed(0, "rtsdf_jump_flood") && isTimed(0, "rtsdf_rays"));
  EXPECT_TRUE(isTimed(2, "field_splat") && isTimed(2, "field_candidates") && isTimed(2, "field_resolve"));
  EXPECT_EQ(rows[0].at("published_ms").at("rtsdf_rays"), 0.14);
  EXPECT_TRUE(rows[1].at("published_ms").at("rtsdf_rays").is_null()) << "the paper has no x = 2";
  EXPECT_THAT(result.output, ::testing::ContainsRegex("jump flood +published +0.28 +0.28"));
  EXPECT_THAT(result.output, ::testing::ContainsRegex("ray trace +published +0.14 +-"));
  // One mover makes less anew than everything, and stillness nothing.
  EXPECT_LT(rows[3].at("tiles").at("keys"), rows[2].at("tiles").at("keys"));
  EXPECT_EQ(rows[4].at("tiles").at("values"), 0);
  EXPECT_EQ(rows[2].at("floor").at("bytes"), rows[2].at("tiles").at("keys").get<double>() * 512 * 4 +
                                                 rows[2].at("tiles").at("values").get<double>() * 512 * 6 +
                                                 64 * (24 + 6000));
  EXPECT_GT(rows[2].at("floor").at("times_over"), 1.0);
  EXPECT_THAT(result.output, ::testing::HasSubstr("at 20 GB/s and 0.1 T/s; the update takes"));
}

TEST_F(BenchCommand, TableOfFramesIsMeasuredByTheRenderer) {
  const ProgramResult result = run({"bench", "world-field", "scene.gltf", "--show", "table1", "--sizes", "S",
                                    "--frames", "1", "--size", "32x18", "--json", "times.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json figures = jsonFrom("times.json"), &table = figures.at("table1");
  for (const char* method : {"rtsdf", "exact"}) {
    const nlohmann::json& passes = table.at(method).at("gpu_ms");
    double sum = 0;
    for (const char* pass : {"G-buffer", "voxelization", "jump flood", "ray trace", "deferred lighting"}) {
      EXPECT_GT(passes.at(pass), 0.0) << method << " " << pass;
      sum += passes.at(pass).get<double>();
    }
    EXPECT_NEAR(passes.at("total").get<double>(), sum + passes.at("others").get<double>(), 1e-6) << method;
    EXPECT_GT(table.at(method).at("frames_per_second"), 0.0);
  }
  EXPECT_THAT(result.output, ::testing::ContainsRegex("ray trace +1.05 +4.60 "));
  EXPECT_THAT(result.output, ::testing::ContainsRegex("total +9.56 +10.22 "));
}

TEST_F(BenchCommand, TableOfMasksHasThePaperBesideIt) {
  const ProgramResult result = run({"bench", "world-field", "scene.gltf", "--show", "table4", "--sizes", "S", "--rays",
                                    "1", "--masks", "0.01,0.2,inf", "--frames", "1", "--json", "times.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json rows = jsonFrom("times.json").at("table4").at("rows");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("published_ms"), 0.8);
  EXPECT_TRUE(rows[1].at("published_ms").is_null());
  EXPECT_EQ(rows[2].at("published_ms"), 4.08);
  EXPECT_EQ(rows[2].at("mask"), "inf");
  EXPECT_GT(rows[2].at("rays_ms"), rows[0].at("rays_ms")) << "rays from every texel take longer";
  EXPECT_THAT(result.output, ::testing::ContainsRegex("x = 1 +published +0.80 +- +4.08"));
}

// Two boxes are closed and of twelve triangles each: exact is exact, and RTSDF what it is.
TEST_F(BenchCommand, ErrorsAreThoseOfBothMethods) {
  const ProgramResult result = run({"bench", "world-field", "scene.gltf", "--show", "errors", "--sizes", "S", "--rays",
                                    "2", "--error-frames", "1,2", "--error-samples", "50000", "--json", "errors.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json rows = jsonFrom("errors.json").at("errors");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].at("case"), "exact");
  EXPECT_GT(rows[0].at("near").at("texels"), 1000);
  EXPECT_LE(rows[0].at("near").at("rms"), 0.01);
  EXPECT_LE(rows[0].at("beyond").at("above"), 0.05);
  EXPECT_EQ(rows[0].at("signs").at("wrong"), 0.0);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(rows[i].at("case"), "rtsdf x=2");
    EXPECT_EQ(rows[i].at("frames"), i);
    EXPECT_GT(rows[i].at("near").at("rms"), 0.3) << "its coarse distances are too short";
    EXPECT_LT(rows[i].at("near").at("rms"), 0.64) << "without its bias, which is as large";
  }
  EXPECT_NE(rows[1], rows[2]);
}

// What the SDF objects' bricks leave of exactness is in the errors, against their meshes.
TEST_F(BenchCommand, ErrorsOfSdfObjectsAreAgainstTheirMeshes) {
  const ProgramResult result =
      run({"bench", "world-field",    "scene.gltf", "--show",          "errors",     "--sizes", "S",    "--rays",
           "0",     "--error-frames", "1",          "--error-samples", "50000",      "--sdf",   "Left", "--resolution",
           "32",    "--cache",        "cache",      "--json",          "errors.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json rows = jsonFrom("errors.json").at("errors");
  EXPECT_EQ(rows[0].at("case"), "exact, with SDF objects");
  EXPECT_GT(rows[0].at("near").at("rms"), 0.01);
  EXPECT_LT(rows[0].at("near").at("rms"), 0.5);
  EXPECT_LE(rows[0].at("beyond").at("above"), 0.05);
}

TEST_F(BenchCommand, MoversAreTimedInCascades) {
  const ProgramResult result =
      run({"bench", "world-field", "scene.gltf", "--movers", "3", "--field-cascades", "2", "--field-texels", "64",
           "--sdf", "all", "--resolution", "16", "--cache", "cache", "--frames", "1", "--json", "movers.json"});
  ASSERT_EQ(result.exitCode, 0) << result.messages;
  const nlohmann::json rows = jsonFrom("movers.json").at("movers");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("movers"), 3);
  EXPECT_EQ(rows[0].at("sdf_objects"), 3);
  EXPECT_EQ(rows[0].at("cascades"), 2);
  EXPECT_EQ(rows[0].at("texels"), 64);
  EXPECT_GT(rows[0].at("update_ms"), 0.0);
  EXPECT_GT(rows[0].at("tiles").at("values"), 0) << "all move";
  EXPECT_EQ(rows[0].at("floor").at("bytes"), 3 * 144 + rows[0].at("tiles").at("values").get<double>() * 512 * 6);
  EXPECT_LE(rows[0].at("tiles").at("values"), 2 * 512);
  EXPECT_THAT(result.output, ::testing::HasSubstr("in 2 cascades of 64^3"));
  const FieldShape usual = FieldBenchRequest().moverShape;
  EXPECT_EQ(std::pair(usual.cascades, usual.texels), std::pair(4, 128)) << "what the figures are of";
}

} // namespace
} // namespace brickfield::test
