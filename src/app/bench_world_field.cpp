// Loads, then one part after the other; each prints its own figures and hands them over for the JSON.
#include "app/bench_world_field.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/bench_errors.h"
#include "app/bench_movers.h"
#include "app/bench_tables.h"
#include "app/image_io.h"
#include "app/progress_bar.h"
#include "app/scene_fields.h"
#include "app/session.h"
#include "core/error.h"
#include "core/files.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

std::size_t triangleCountOf(const Scene& scene, const Pose& pose) {
  std::size_t indices = 0;
  for (const PosedInstance& instance : pose.instances)
    for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives)
      indices += primitive.indices.size();
  return indices / 3;
}

Json measureTables(const FieldBenchSetting& setting) {
  const std::set<std::string>& shown = setting.request.shown;
  Json json;
  if (shown.contains("table1") || shown.contains("table3") || shown.contains("table4")) {
    const Scene scene = withMover(setting.scene, setting.pose);
    const Pose rest = poseScene(scene, setting.request.scene.pose);
    FieldBench bench(setting.device, scene, {});
    const std::size_t triangles = triangleCountOf(scene, rest);
    fmt::print("All nodes as meshes, a mover of 6,000 triangles added: {} triangles. Milliseconds, medians of {} "
               "frames.\n",
               triangles, setting.request.frames);
    json["triangles"] = triangles;
    const BenchedScene benched{setting, scene, rest, bench};
    if (shown.contains("table1")) json["table1"] = benchFrameTable(benched);
    if (shown.contains("table3")) json["table3"] = benchSizeTable(benched);
    if (shown.contains("table4")) json["table4"] = benchMaskTable(benched);
  }
  if (shown.contains("errors")) json["errors"] = benchErrors(setting);
  return json;
}

} // namespace

const std::string& FieldBenchSetting::mainSize() const {
  const auto found = std::find(request.sizes.begin(), request.sizes.end(), "M");
  return found == request.sizes.end() ? request.sizes.front() : *found;
}

SceneFields bakeBenchFields(const FieldBenchSetting& setting) {
  const SceneRequest& request = setting.request.scene;
  const std::filesystem::path cache = request.cacheFolder ? *request.cacheFolder : defaultCacheFolder();
  ProgressBar bar;
  SceneFieldsResult result = bakeSceneFields(
      setting.scene, setting.pose, sdfNodes(setting.scene, request.sdf, request.threads), cache, bar.progress());
  for (const std::string& warning : result.warnings) printWarning(warning);
  return std::move(result.fields);
}

void runFieldBench(const FieldBenchRequest& request) {
  const std::vector<OutputPath> outputs{{"--json", request.json, {".json"}}};
  checkOutputs(outputs, {request.scene.path});
  checkCamera(request.camera);
  checkInputPath(request.scene.path, {".gltf", ".glb"});
  const Scene scene = importGltf(request.scene.path);
  checkSceneFiles(scene, outputs);
  const Pose pose = poseScene(scene, request.scene.pose);
  if (pose.boundsWorld.isEmpty()) throw BadInput(scene.name, "", "has no triangle to measure with");
  sdfNodes(scene, request.scene.sdf, request.scene.threads); // refuses what it does not know, before the long work
  const std::unique_ptr<Context> context = Context::createHeadless(request.device);
  printWarnings(scene);
  const FieldBenchSetting setting{request, context->info(), scene, pose};
  fmt::print("{}: {}, {}\n", request.scene.path.filename().string(), context->info().renderer, context->info().version);
  Json json{{"scene", request.scene.path.filename().string()},
            {"gpu", context->info().renderer},
            {"driver", context->info().version},
            {"frames", request.frames}};
  if (request.moverCounts.empty())
    json.update(measureTables(setting));
  else
    json["movers"] = benchMovers(setting);
  if (const std::vector<std::string> errors = context->takeGlErrors(); !errors.empty())
    throw Failure("OpenGL: " + errors.front());
  if (!request.json.empty()) writeFile(request.json, json.dump(2) + "\n");
}

} // namespace brickfield
