// `bench bake` as a stranger runs it.
#include "bakers/openvdb_band.h"
#include "tests/robustness/app/command_line_fixture.h"

namespace brickfield::test {
namespace {

class BenchBakeCommand : public CommandLine {};

TEST_F(BenchBakeCommand, RefusesWhatItCannotMeasure) {
  expectRefused({"bench", "bake"}, {"FILES"});
  expectRefused({"bench", "bake", "absent.glb"}, {"absent.glb", "no such file"});
  expectRefused({"bench", "bake", "scene.gltf", "--resolutions", "4"}, {"--resolutions", "4"});
  expectRefused({"bench", "bake", "scene.gltf", "--resolutions", "64,"}, {"--resolutions"});
  expectRefused({"bench", "bake", "scene.gltf", "--sign", "guess"}, {"--sign", "guess"});
  expectRefused({"bench", "bake", "scene.gltf", "--threads", "0"}, {"--threads", "0"});
  expectRefused({"bench", "bake", "scene.gltf", "--repeats", "0"}, {"--repeats", "0"});
  expectRefused({"bench", "bake", "scene.gltf", "--error-samples", "0"}, {"--error-samples", "0"});
  expectRefused({"bench", "bake", "scene.gltf", "--json", "absent/a.json"}, {"--json", "absent"});
  folder_.write("empty.gltf", R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
  expectRefused({"bench", "bake", "empty.gltf"}, {"empty.gltf", "no mesh"});
}

TEST_F(BenchBakeCommand, MeasuresAMeshBesideOpenVdb) {
  for (const bool isJoined : {false, true}) {
    std::vector<std::string> arguments{"bench", "bake",   "scene.gltf", "--resolutions",   "16,24", "--repeats",
                                       "1",     "--json", "bake.json",  "--error-samples", "500"};
    if (isJoined) arguments.push_back("--joined");
    const ProgramResult result = run(arguments);
    ASSERT_EQ(result.exitCode, 0) << result.messages;
    const std::vector<std::byte> bytes = readFile("bake.json");
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const nlohmann::json figures = nlohmann::json::parse(text, text + bytes.size());
    const nlohmann::json& rows = figures.at("bakes");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].at("resolution"), 16);
    for (const nlohmann::json& row : rows) {
      EXPECT_GT(row.at("seconds"), 0.0);
      EXPECT_GT(row.at("stage_seconds").at("sign"), 0.0);
      EXPECT_GT(row.at("queries_per_second"), 0.0);
      EXPECT_GT(row.at("bricks"), 0);
      EXPECT_EQ(row.at("wrong_signs"), 0);
      EXPECT_GT(row.at("full_bake_seconds"), 0.0);
      EXPECT_GT(row.at("without_sides").at("seconds"), 0.0);
      if (isBuiltWithOpenVdb()) {
        EXPECT_GT(row.at("openvdb").at("active_voxels"), 0);
        EXPECT_GT(row.at("openvdb").at("inside_voxels"), 0); // a closed mesh
        EXPECT_GT(row.at("openvdb").at("times_ours"), 0.0);
        EXPECT_GT(row.at("without_sides").at("openvdb").at("times_ours"), 0.0);
      } else {
        std::fprintf(stderr, "NOT RUN: the column of OpenVDB, this build is without it\n");
        EXPECT_EQ(row.at("openvdb"), "not built with OpenVDB");
      }
    }
  }
}

} // namespace
} // namespace brickfield::test
