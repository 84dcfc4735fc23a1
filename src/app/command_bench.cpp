// The flags of `bench world-field`, its tables beside the published ones.
#include "app/command_bench.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/field_bench.h"
#include "app/image_io.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/session.h"
#include "core/error.h"
#include "core/files.h"
#include "passes/world_field/rtsdf_settings.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

struct FieldBenchRequest {
  std::filesystem::path scene, json;
  std::vector<std::string> sizes{"S", "M", "L"};
  std::vector<int> rays{1, 5, 10};
  int frames = 30;
  int device = -1;
};

// Table 3 of the RTSDF paper (RTX 2080 Ti, hardware rays), milliseconds.
struct Published {
  const char* size;
  double voxelize, flood;
  double rays[4]; ///< x = 0, 1, 5, 10
};
constexpr Published kPublished[] = {{"S", 0.49, 0.28, {0.14, 0.16, 0.71, 1.41}},
                                    {"M", 0.49, 2.37, {0.55, 1.41, 4.51, 8.36}},
                                    {"L", 1.12, 21.89, {3.98, 9.12, 26.56, 48.32}}};

const Published& publishedOf(const std::string& size) {
  return *std::find_if(std::begin(kPublished), std::end(kPublished),
                       [&](const Published& row) { return size == row.size; });
}

FieldShape shapeOf(const std::string& size) {
  RtsdfSettings settings;
  setRtsdfSize(settings, size);
  return {1, settings.fineSize, 0, true};
}

nlohmann::json jsonOf(const FieldTimes& times) {
  nlohmann::json passes;
  for (const PassTime& pass : times.passes) passes[pass.name] = pass.milliseconds;
  return {{"passes_ms", passes},
          {"sum_ms", times.sumMilliseconds},
          {"tiles", {{"keys", times.keyTiles}, {"candidates", times.candidateTiles}, {"values", times.valueTiles}}},
          {"triangles_gathered", times.gathered},
          {"bytes", times.bytes}};
}

std::string lineOf(const FieldTimes& times) {
  std::string line;
  for (const PassTime& pass : times.passes)
    if (pass.milliseconds > 0.0005) line += fmt::format(" {} {:.3f}", pass.name, pass.milliseconds);
  return line;
}

void report(nlohmann::json& results, const std::string& size, const std::string& name, const FieldTimes& times) {
  fmt::print("{:<2} {:<26} {:8.3f} ms |{} | tiles {} keys {} values | {:.0f} MiB\n", size, name, times.sumMilliseconds,
             lineOf(times), times.keyTiles, times.valueTiles, static_cast<double>(times.bytes) / 1048576.0);
  std::fflush(stdout);
  nlohmann::json row = jsonOf(times);
  row["size"] = size, row["case"] = name;
  results.push_back(row);
}

int benchWorldField(const FieldBenchRequest& request) {
  const std::vector<OutputPath> outputs{{"--json", request.json, {".json"}}};
  checkOutputs(outputs, {request.scene});
  checkInputPath(request.scene, {".gltf", ".glb"});
  const Scene loaded = importGltf(request.scene);
  checkSceneFiles(loaded, outputs);
  if (poseScene(loaded, {}).boundsWorld.isEmpty()) throw BadInput(loaded.name, "", "has no triangle to measure with");
  const Scene scene = withMover(loaded);
  const std::unique_ptr<Context> context = Context::createHeadless(request.device);
  FieldBench bench(context->info(), scene, {});
  fmt::print("{}: {}, {} | {}\n", request.scene.filename().string(), context->info().renderer, context->info().version,
             "milliseconds: medians; a mover of 6,000 triangles is added");
  nlohmann::json results = nlohmann::json::array();
  for (const std::string& size : request.sizes) {
    const FieldShape shape = shapeOf(size);
    report(results, size, "exact, all moving", bench.timeExact(shape, FieldMotion::Everything, request.frames));
    report(results, size, "exact, mover", bench.timeExact(shape, FieldMotion::Mover, request.frames));
    report(results, size, "exact, still", bench.timeExact(shape, FieldMotion::Nothing, request.frames));
    const Published& published = publishedOf(size);
    for (const int rays : request.rays) {
      RtsdfSettings settings;
      setRtsdfSize(settings, size);
      settings.raysPerTexel = rays;
      report(results, size, fmt::format("rtsdf x={}, all moving", rays),
             bench.timeRtsdf(settings, FieldMotion::Everything, request.frames));
      const int column = rays == 0 ? 0 : rays == 1 ? 1 : rays == 5 ? 2 : rays == 10 ? 3 : -1;
      if (column >= 0)
        fmt::print("   published (RTX 2080 Ti)    {:8.3f} ms | voxelize {:.2f} jump flood {:.2f} rays {:.2f}\n",
                   published.voxelize + published.flood + published.rays[column], published.voxelize, published.flood,
                   published.rays[column]);
    }
  }
  if (const std::vector<std::string> errors = context->takeGlErrors(); !errors.empty())
    throw Failure("OpenGL: " + errors.front());
  if (!request.json.empty())
    writeFile(request.json, nlohmann::json{{"scene", request.scene.filename().string()},
                                           {"gpu", context->info().renderer},
                                           {"driver", context->info().version},
                                           {"triangles", bench.triangleCount()},
                                           {"results", results}}
                                    .dump(2) +
                                "\n");
  return 0;
}

void addWorldField(CLI::App& bench, CommandAction& chosen) {
  CLI::App& command = *bench.add_subcommand("world-field", "Times of the world field, beside the RTSDF paper's");
  const auto request = std::make_shared<FieldBenchRequest>();
  addPath(command, "SCENE", "glTF 2.0 file (.gltf or .glb)", request->scene)->required();
  addPath(command, "--json", "The figures as .json", request->json);
  command.add_option("--sizes", request->sizes, "Of S, M and L, comma separated")
      ->delimiter(',')
      ->check(CLI::IsMember({"S", "M", "L"}));
  command.add_option("--rays", request->rays, "Rays a texel of RTSDF, comma separated; 0 to 64")
      ->delimiter(',')
      ->check(CLI::Range(0, 64));
  addValue(command, "--frames", "Frames that are timed", [request](auto& flag, auto& text) {
    request->frames = static_cast<int>(parseWhole(flag, text, 1, 100000));
  })->type_name("N");
  addValue(command, "--device", "EGL device by number", [request](auto& flag, auto& text) {
    request->device = static_cast<int>(parseWhole(flag, text, 0, 255));
  })->type_name("N");
  command.callback([request, &chosen] { chosen = [request] { return benchWorldField(*request); }; });
}

} // namespace

void addBenchCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("bench", "Measure, on this machine's GPU");
  command.callback([&command] {
    if (command.get_subcommands().empty()) throw BadInput("bench", "", "needs world-field");
  });
  addWorldField(command, chosen);
}

} // namespace brickfield
