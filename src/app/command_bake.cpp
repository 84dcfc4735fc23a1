// Chooses the node, merges its extras with the flags, bakes and writes.
#ifdef BRICKFIELD_BAKERS
#include "app/command_bake.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/image_io.h"
#include "app/mesh_choice.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/progress_bar.h"
#include "app/scene_fields.h"
#include "app/session.h"
#include "bakers/sign_census.h"
#include "core/error.h"
#include "core/files.h"
#include "field/bricks_file.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

struct BakeRequest {
  std::filesystem::path meshPath;
  std::filesystem::path output;
  std::filesystem::path stats;
  std::string node;
  SdfRequest sdf; // resolution and memory only
  std::optional<int> bits;
  std::optional<int> mips;
  std::optional<SignMethod> sign;
  std::optional<float> thickness;
  int threads = 0;
};

nlohmann::json signsJson(const SignCensus& census) {
  return {
      {"samples", census.samples},    {"by_closed", census.byClosed},         {"by_open", census.byOpen},
      {"by_sheets", census.bySheets}, {"sureness_mean", census.meanSureness}, {"sureness_least", census.leastSureness},
      {"doubtful", census.doubtful},  {"overruled", census.overruled}};
}

nlohmann::json statsJson(const BakeRequest& request, const BakeSettings& settings, const BakeResult& result) {
  nlohmann::json levels = nlohmann::json::array();
  for (const BrickLevel& level : result.field.levels)
    levels.push_back({{"voxel_size", level.voxelSizeObject},
                      {"bricks", level.brickCount()},
                      {"cells", level.indirection.size()},
                      {"range_voxels", level.rangeVoxels}});
  const BakeStats& stats = result.stats;
  return {{"mesh", request.meshPath.string()},
          {"settings",
           {{"resolution", settings.resolution},
            {"bits", settings.bits},
            {"mips", settings.mips},
            {"thickness", settings.thickness},
            {"threads", settings.threads}}},
          {"triangles", stats.triangles},
          {"degenerate_triangles", stats.degenerateTriangles},
          {"open_edges", stats.openEdges},
          {"non_manifold_edges", stats.nonManifoldEdges},
          {"sheet_triangles", stats.sheetTriangles},
          {"sign", stats.sign},
          {"bricks", stats.bricks},
          {"bytes", stats.bytes},
          {"seconds", stats.seconds},
          {"source_hash", result.field.sourceHash.text()},
          {"levels", levels}};
}

int bake(const BakeRequest& request) {
  const std::vector<OutputPath> outputs{{"-o", request.output, {".bricks"}}, {"--stats", request.stats, {".json"}}};
  checkOutputs(outputs, {request.meshPath});
  checkInputPath(request.meshPath, {".gltf", ".glb"});
  const Scene scene = importGltf(request.meshPath);
  checkSceneFiles(scene, outputs);
  const Pose pose = poseScene(scene, {});
  const PosedInstance& instance = chooseMesh(scene, pose, request.node);
  BakeSettings settings =
      bakeSettingsOf(scene.nodes[static_cast<std::size_t>(instance.node)], request.sdf, request.threads);
  settings.bits = request.bits.value_or(settings.bits);
  settings.mips = request.mips.value_or(settings.mips);
  settings.sign = request.sign.value_or(settings.sign);
  settings.thickness = request.thickness.value_or(settings.thickness);
  printWarnings(scene);

  const BakeInput input = bakeInputOf(scene, instance, pose);
  BakeResult result;
  {
    ProgressBar bar;
    result = bakeField(input, settings, bar.progress());
  }
  throwIfInterrupted();
  const std::string label = nodeLabel(scene, instance.node);
  if (const std::string warning = thinPartsWarning(label, result.field, settings); !warning.empty())
    printWarning(warning);
  writeBricksFile(request.output, result.field);
  if (!request.stats.empty()) {
    nlohmann::json stats = statsJson(request, settings, result);
    stats["signs"] = signsJson(takeSignCensus(input, settings, result.field));
    writeFile(request.stats, stats.dump(2) + "\n");
  }
  fmt::print("{}: {} triangles, {} bricks in {} levels, {:.2f} MiB, sign by {}, {:.2f} s\n", request.output.string(),
             result.stats.triangles, result.stats.bricks, result.field.levels.size(),
             static_cast<double>(result.stats.bytes) / (1024.0 * 1024.0), result.stats.sign, result.stats.seconds);
  return 0;
}

void addOptions(CLI::App& command, BakeRequest& request) {
  addPath(command, "MESH", "glTF 2.0 file (.gltf or .glb)", request.meshPath)->required();
  addPath(command, "-o,--output", "The .bricks file to write", request.output)->required();
  addName(command, "--node", "Which node's mesh, by name or number; absent: the only one", request.node);
  addValue(command, "--resolution", "Voxels along the longest side, 8 to 1024; 128 by default",
           [&](auto& flag, auto& text) { request.sdf.resolution = static_cast<int>(parseWhole(flag, text, 8, 1024)); })
      ->type_name("N");
  addValue(command, "--bits", "Bits of a distance, 8 or 16; 8 by default", [&](auto& flag, auto& text) {
    if (text != "8" && text != "16") throw BadInput(flag, "\"" + text + "\"", "is neither 8 nor 16");
    request.bits = text == "8" ? 8 : 16;
  })->type_name("8|16");
  addValue(command, "--mips", "Levels of resolution, 1 to 4; 3 by default", [&](auto& flag, auto& text) {
    request.mips = static_cast<int>(parseWhole(flag, text, 1, 4));
  })->type_name("N");
  addValue(command, "--sign", "What is inside: auto, winding, parity, pseudonormal or two-sided",
           [&](auto& flag, auto& text) { request.sign = parseSign(flag, text); })
      ->type_name("METHOD");
  addValue(command, "--thickness", "Of two-sided sheets, metres of object space; 0: one voxel",
           [&](auto& flag, auto& text) { request.thickness = static_cast<float>(parseNumber(flag, text, 0, 1e6)); })
      ->type_name("M");
  addMemoryOption(command, request.sdf);
  addValue(command, "--threads", "0: all", [&](auto& flag, auto& text) {
    request.threads = static_cast<int>(parseWhole(flag, text, 0, 1024));
  })->type_name("N");
  addPath(command, "--stats", "Figures of the bake as .json", request.stats);
}

} // namespace

void addBakeCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("bake", "Bake the mesh of one node to a .bricks file");
  const auto request = std::make_shared<BakeRequest>();
  addOptions(command, *request);
  command.callback([request, &chosen] { chosen = [request] { return bake(*request); }; });
}

} // namespace brickfield
#endif
