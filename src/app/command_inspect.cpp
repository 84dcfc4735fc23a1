// Figures on stdout and, on request, as .json; a slice as .png; the error against the mesh.
#include "app/command_inspect.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/field_report.h"
#include "app/image_io.h"
#include "app/mesh_choice.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/session.h"
#include "core/error.h"
#include "core/files.h"
#include "field/brick_layout.h"
#include "field/bricks_file.h"
#include "field/slice.h"
#include "scene/gltf_import.h"
#ifdef BRICKFIELD_BAKERS
#include "bakers/bake_error.h"
#endif

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
  std::optional<std::size_t> level; ///< of the slice
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
          {"thin_share", static_cast<double>(field.thinParts.perTenThousand) / ThinParts::kWhole},
          {"thin_resolution", field.thinParts.resolution},
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

RgbImage sliceOf(const InspectOptions& options, const BrickField& field) {
  const std::size_t level = options.level.value_or(0);
  if (level >= field.levels.size())
    throw BadInput("--level", fmt::format("{}", level), fmt::format("of {}, from 0, the finest", field.levels.size()));
  const auto [axis, position] = *options.slice;
  const float first = field.boundsObject.min[axis], last = field.boundsObject.max[axis];
  if (!(position >= first && position <= last))
    throw BadInput("--slice", fmt::format("{}:{:g}", "xyz"[axis], position),
                   fmt::format("misses the field, which reaches from {:g} to {:g}", first, last));
  // Lines every whole voxel need some pixels between them.
  constexpr int kPixelsPerVoxel = 8, kLeastPixels = 512, kMostPixels = 4096;
  const glm::vec3 voxels = field.boundsObject.extent() / field.levels[level].voxelSizeObject;
  const float longer = std::max(voxels[(axis + 1) % 3], voxels[(axis + 2) % 3]);
  const int pixels = std::clamp(static_cast<int>(longer) * kPixelsPerVoxel, kLeastPixels, kMostPixels);
  const SliceImage cut = cutField(field, {axis, position, false, level, pixels});
  RgbImage image{glm::uvec2(cut.size), {}};
  for (std::size_t i = 0; i + 2 < cut.rgb.size(); i += 3)
    image.pixels.push_back(glm::vec3(cut.rgb[i], cut.rgb[i + 1], cut.rgb[i + 2]) / 255.0f);
  return image;
}

#ifdef BRICKFIELD_BAKERS
nlohmann::json jsonOf(const LevelError& error) {
  return {{"samples", error.samples},          {"mean_voxels", error.mean},
          {"rms_voxels", error.rms},           {"p999_voxels", error.p999},
          {"max_voxels", error.max},           {"signed_samples", error.signedSamples},
          {"wrong_signs", error.wrongSigns},   {"farthest_wrong_sign_voxels", error.farthestWrongSign},
          {"open_samples", error.openSamples}, {"open_rms_voxels", error.openRms},
          {"open_max_voxels", error.openMax}};
}

void print(std::size_t number, const LevelError& error) {
  fmt::print("level {}:", number);
  if (error.signedSamples > 0)
    fmt::print(" max {:.4f}, rms {:.4f}, 99.9 % {:.4f} voxels over {} samples, {} of {} signs wrong", error.max,
               error.rms, error.p999, error.samples, error.wrongSigns, error.signedSamples);
  if (error.wrongSigns > 0) fmt::print(", up to {:.2f} voxels away", error.farthestWrongSign);
  if (error.openSamples > 0)
    fmt::print("{} beside open parts, unsigned: max {:.4f}, rms {:.4f} over {}", error.signedSamples > 0 ? ";" : "",
               error.openMax, error.openRms, error.openSamples);
  fmt::print("\n");
}

nlohmann::json errorAgainst(const InspectOptions& options, const BrickField& field) {
  constexpr std::uint64_t kMostSamples = 200000; // of a level: under a second, and a mean to well below a hundredth
  const Scene scene = importGltf(options.against);
  checkSceneFiles(scene, outputsOf(options));
  const Pose pose = poseScene(scene, {});
  const BakeError error =
      measureBakeError(field, bakeInputOf(scene, chooseMesh(scene, pose, options.node), pose), kMostSamples);
  fmt::print("against {}: {} triangles, {} of them closed; {} open and {} non-manifold edges\n",
             options.against.string(), error.triangles, error.closedTriangles, error.openEdges, error.nonManifoldEdges);
  if (field.thinParts.resolution > 0)
    fmt::print(
        "parts thinner than a voxel may be drawn thicker: {:.1f} % of the closed surface, resolution {} would do\n",
        100.0 * field.thinParts.perTenThousand / ThinParts::kWhole, field.thinParts.resolution);
  nlohmann::json levels = nlohmann::json::array();
  for (const LevelError& level : error.levels) {
    print(levels.size(), level);
    levels.push_back(jsonOf(level));
  }
  return {{"mesh", options.against.string()},
          {"triangles", error.triangles},
          {"closed_triangles", error.closedTriangles},
          {"open_edges", error.openEdges},
          {"non_manifold_edges", error.nonManifoldEdges},
          {"levels", levels}};
}
#endif

int inspect(const InspectOptions& options) {
  checkOutputs(outputsOf(options), {options.bricks, options.against});
  if (options.slice.has_value() == options.output.empty())
    throw BadInput(options.output.empty() ? "--slice" : "-o", "",
                   options.output.empty() ? "needs -o" : "needs --slice");
  if (options.level && !options.slice) throw BadInput("--level", "", "needs --slice");
  if (!options.node.empty() && options.against.empty()) throw BadInput("--node", "", "needs --against");
  if (!options.against.empty()) checkInputPath(options.against, {".gltf", ".glb"});
  const BrickField field = readBricksFile(options.bricks);
  std::optional<RgbImage> slice;
  if (options.slice) slice = sliceOf(options, field);
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
  addValue(command, "--level", "Level of the slice, from 0, the finest and default", [&](auto& flag, auto& text) {
    options.level = static_cast<std::size_t>(parseWhole(flag, text, 0, kMaxLevels - 1));
  })->type_name("N");
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
