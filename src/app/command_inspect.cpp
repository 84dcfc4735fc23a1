// Figures on stdout and, on request, as .json; a slice as .png; the error against the mesh.
#include "app/command_inspect.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/field_error.h"
#include "app/field_report.h"
#include "app/image_io.h"
#include "app/mesh_choice.h"
#include "app/options.h"
#include "app/session.h"
#include "core/error.h"
#include "core/files.h"
#include "field/bricks_file.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

struct InspectOptions {
  fs::path bricks;
  fs::path against;
  fs::path json;
  fs::path output;
  std::string node;
  std::optional<SlicePlane> slice;
};

std::vector<OutputPath> outputsOf(const InspectOptions& options) {
  return {{"-o", options.output, {".png"}}, {"--json", options.json, {".json"}}};
}

nlohmann::json arrayOf(glm::vec3 v) { return {v.x, v.y, v.z}; }

nlohmann::json figuresOf(const InspectOptions& options, const BrickField& field) {
  nlohmann::json levels = nlohmann::json::array();
  for (const LevelReport& level : reportLevels(field))
    levels.push_back({{"voxel_size", level.voxelSizeObject},
                      {"brick_counts", {level.brickCounts.x, level.brickCounts.y, level.brickCounts.z}},
                      {"bits", level.bits},
                      {"range_voxels", level.rangeVoxels},
                      {"cells", level.cells},
                      {"bricks", level.bricks},
                      {"empty_inside", level.emptyInside},
                      {"empty_outside", level.emptyOutside},
                      {"empty_share", level.emptyShare()},
                      {"attributes", level.hasAttributes},
                      {"bytes", level.bytes}});
  return {{"file", options.bricks.string()},
          {"file_bytes", fs::file_size(options.bricks)},
          {"bytes", fieldBytes(field)},
          {"bounds_min", arrayOf(field.boundsObject.min)},
          {"bounds_max", arrayOf(field.boundsObject.max)},
          {"source_hash", field.sourceHash.text()},
          {"levels", levels}};
}

void print(const InspectOptions& options, const BrickField& field) {
  const glm::vec3 extent = field.boundsObject.extent();
  const glm::vec3 min = field.boundsObject.min;
  fmt::print("{}: {} bytes, {} unpacked\n", options.bricks.string(), fs::file_size(options.bricks), fieldBytes(field));
  fmt::print("bounds: {:g} x {:g} x {:g} m from {:g},{:g},{:g}\n", extent.x, extent.y, extent.z, min.x, min.y, min.z);
  int number = 0;
  for (const LevelReport& level : reportLevels(field))
    fmt::print("level {}: voxel {:g} m, {} x {} x {} cells, {} bricks of {} bits over {:g} voxels, {:.1f} % empty, {} "
               "bytes{}\n",
               number++, level.voxelSizeObject, level.brickCounts.x, level.brickCounts.y, level.brickCounts.z,
               level.bricks, level.bits, level.rangeVoxels, 100.0 * level.emptyShare(), level.bytes,
               level.hasAttributes ? "" : ", no colours");
  fmt::print("source: {}\n", field.sourceHash.text());
}

#ifdef BRICKFIELD_BAKERS
nlohmann::json errorAgainst(const InspectOptions& options, const BrickField& field) {
  constexpr std::uint64_t kMostSamples = 200000; // under a second, and a mean to well below a hundredth of itself
  const Scene scene = importGltf(options.against);
  checkSceneFiles(scene, outputsOf(options));
  const Pose pose = poseScene(scene, {});
  const FieldError error =
      compareWithMesh(field, bakeInputOf(scene, chooseMesh(scene, pose, options.node)), kMostSamples);
  fmt::print("against {}: mean {:.4g}, rms {:.4g}, max {:.4g} voxels over {} samples, magnitudes only\n",
             options.against.string(), error.meanVoxels, error.rmsVoxels, error.maxVoxels, error.samples);
  return {{"mesh", options.against.string()},
          {"samples", error.samples},
          {"mean_voxels", error.meanVoxels},
          {"rms_voxels", error.rmsVoxels},
          {"max_voxels", error.maxVoxels}};
}
#endif

int inspect(const InspectOptions& options) {
  checkOutputs(outputsOf(options), {options.bricks, options.against});
  if (options.slice.has_value() == options.output.empty())
    throw BadInput(options.output.empty() ? "--slice" : "-o", "",
                   options.output.empty() ? "needs -o" : "needs --slice");
  if (!options.node.empty() && options.against.empty()) throw BadInput("--node", "", "needs --against");
  if (!options.against.empty()) checkInputPath(options.against, {".gltf", ".glb"});
  const BrickField field = readBricksFile(options.bricks);
  std::optional<RgbImage> slice;
  if (options.slice) slice = sliceField(field, *options.slice);
  nlohmann::json figures = figuresOf(options, field);
  print(options, field);
#ifdef BRICKFIELD_BAKERS
  if (!options.against.empty()) figures["against"] = errorAgainst(options, field);
#endif
  throwIfInterrupted();
  if (slice) writePng(options.output, *slice);
  if (!options.json.empty()) writeFile(options.json, figures.dump(2) + "\n");
  return 0;
}

void addOptions(CLI::App& command, InspectOptions& options) {
  addPath(command, "BRICKS", "The .bricks file", options.bricks)->required();
  addValue(command, "--slice", "Cut at a place along an axis in metres, such as x:0.25; with -o",
           [&](auto& flag, auto& text) { options.slice = parseSlice(flag, text); })
      ->type_name("AXIS:POS");
  addPath(command, "-o,--output", "The slice as .png", options.output);
  addPath(command, "--json", "The figures as .json", options.json);
#ifdef BRICKFIELD_BAKERS
  addPath(command, "--against", "Error against the mesh in this glTF file", options.against);
  addName(command, "--node", "Which node's mesh of it, by name or number", options.node);
#endif
}

} // namespace

void addInspectCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("inspect", "Say what a .bricks file holds");
  const auto options = std::make_shared<InspectOptions>();
  addOptions(command, *options);
  command.callback([options, &chosen] { chosen = [options] { return inspect(*options); }; });
}

} // namespace brickfield
