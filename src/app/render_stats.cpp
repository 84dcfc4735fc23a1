// One object, a function each part; names of counts as in FrameStats.
#include "app/render_stats.h"

#include <algorithm>
#include <cmath>

#include <sys/resource.h>

#include "bakers/bake.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(glm::vec3 v) { return {v.x, v.y, v.z}; }

template <typename Value>
Json valueOr(const std::optional<Value>& value, const char* absent) {
  return value ? Json(*value) : Json(absent);
}

std::string cacheFolderOf(const RenderRequest& request) {
  return (request.scene.cacheFolder ? *request.scene.cacheFolder : defaultCacheFolder()).string();
}

/// The middle value; of an even count the lower of the two in the middle.
double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double leastOf(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

Json fieldSettingsJson(const FieldSettings& field) {
  Json json{{"method", fieldMethodName(field.method)}};
  if (field.method == FieldMethod::Exact) {
    json["cascades"] = field.shape.isWhole ? 1 : field.shape.cascades;
    json["texels"] = field.shape.texels;
    json["texel_metres"] = field.shape.texelSize > 0 ? Json(field.shape.texelSize) : Json("covers the scene");
    json["whole_scene"] = field.shape.isWhole;
  } else if (field.method == FieldMethod::Rtsdf) {
    const RtsdfSettings& rtsdf = field.rtsdf;
    const glm::ivec3 extent = rtsdfExtent(rtsdf);
    json["texels"] = {extent.x, extent.y, extent.z};
    json["brute_force"] = rtsdf.bruteForce;
    json["rays"] = rtsdf.raysPerTexel;
    if (!rtsdf.bruteForce) {
      json["coarse_texels"] = rtsdf.coarseSize;
      json["alpha"] = rtsdf.decay;
      json["mask"] = std::isfinite(rtsdf.maskWidth) ? Json(rtsdf.maskWidth) : Json("inf");
      json["beta"] = rtsdfBeta(rtsdf);
    }
    json["bias"] = rtsdf.bias;
  }
  return json;
}

Json occlusionSettingsJson(const OcclusionSettings& occlusion) {
  Json json{{"form", occlusionFormName(occlusion.form)}};
  if (occlusion.form == OcclusionForm::Off) return json;
  json["radius"] = std::isfinite(occlusion.radiusMetres) ? Json(occlusion.radiusMetres) : Json("inf");
  json["every_nth_pixel"] = occlusion.scale;
  if (occlusion.form == OcclusionForm::Cones) json["cones"] = occlusion.cones;
  return json;
}

// What was asked for, or what holds where nothing was.
Json settingsJson(const RenderRun& run) {
  const RenderRequest& request = *run.request;
  const CameraRequest& camera = request.camera;
  const SdfRequest& sdf = request.scene.sdf;
  Json json;
  json["size"] = {camera.sizePixels.x, camera.sizePixels.y};
  json["camera"] = camera.eye ? "--eye" : camera.camera.empty() ? "first, else auto" : camera.camera;
  json["eye"] = vectorJson(run.view.eyeWorld);
  json["forward"] = vectorJson(-glm::vec3(run.view.worldFromView[2]));
  json["up"] = vectorJson(glm::vec3(run.view.worldFromView[1]));
  if (run.view.orthographic)
    json["height_metres"] = 2.0f / run.view.clipFromView[1][1];
  else
    json["fov_degrees"] = glm::degrees(2.0f * std::atan(1.0f / run.view.clipFromView[1][1]));
  json["near"] = run.view.nearDistance;
  json["time"] = valueOr(request.scene.pose.seconds, "rest pose");
  json["animation"] = request.scene.pose.animation;
  json["frames"] = request.frames;
  json["trace"] = request.trace == TraceChoice::Tiles ? "tiles" : "boxes"; // auto is settled
  json["sdf"] = sdf.patterns.empty() ? Json("extras") : Json(sdf.patterns);
  json["resolution"] = valueOr(sdf.resolution, "extras");
  json["triplanar"] = valueOr(sdf.triplanarMetres, "extras");
  json["shadows"] = shadowName(request.shadows);
  if (marchesField(shadowMethodOf(request.shadows))) {
    const ShadowSettings& shadows = request.fieldShadows.settings;
    json["field_shadows"] = {{"estimator", estimatorName(shadows.estimator)},
                             {"rays", shadows.penumbraRays},
                             {"softness", shadows.softness},
                             {"resolution", shadows.halfResolution ? "half" : "full"},
                             {"bricks", !shadows.nearBricks ? Json("off")
                                        : request.fieldShadows.brickVoxels == 0
                                            ? Json("objects")
                                            : Json(request.fieldShadows.brickVoxels)}};
  }
  if (drawsMaps(shadowMethodOf(request.shadows))) json["shadow_maps"]["size"] = request.shadowMaps.settings.size;
  if (request.shadows == ShadowChoice::Csm)
    json["shadow_maps"]["filter"] = shadowFilterName(request.shadowMaps.settings.filter);
  json["taa"] = {{"on", request.taa.on}, {"sharpness", request.taa.sharpness}, {"shutter", request.taa.shutter}};
  json["ao"] = occlusionSettingsJson(request.occlusion.settings);
  json["translucency"] = {{"what", translucencyText(request.translucency.settings)},
                          {"wrap", request.translucency.settings.wrap}};
  const ReflectionSettings& reflections = request.reflections.settings;
  json["reflections"] = {{"method", reflectionMethodName(reflections.method)}, {"every_nth_pixel", reflections.scale}};
  json["brdf"] = brdfModelName(request.brdf);
  json["light"] = request.light.texts.empty() ? Json("scene") : Json(request.light.texts);
  json["environment"] = request.light.environment.empty() ? "sky" : request.light.environment.string();
  json["exposure"] = request.exposureEv;
  json["world_field"] = fieldSettingsJson(request.field.settings);
  json["view"] = request.view.empty() ? "picture" : request.view;
  json["seed"] = request.scene.seed;
  json["threads"] = request.scene.threads;
  if (request.device >= 0)
    json["device"] = request.device;
  else
    json["device"] = "first that works";
  return json;
}

Json sceneJson(const RenderRun& run) {
  std::size_t triangles = 0;
  for (const PosedInstance& instance : run.pose->instances)
    for (const Primitive& primitive : run.scene->meshes[static_cast<std::size_t>(instance.mesh)].primitives)
      triangles += primitive.indices.size() / 3;
  return {{"nodes", run.scene->nodes.size()},           {"meshes", run.scene->meshes.size()},
          {"instances", run.pose->instances.size()},    {"triangles", triangles},
          {"materials", run.scene->materials.size()},   {"images", run.scene->images.size()},
          {"animations", run.scene->animations.size()}, {"cameras", run.pose->cameraNodes.size()},
          {"lights", run.lighting->lights.size()},      {"fields", run.fields->fields.size()}};
}

// Each pass by name: what the frames that had it took.
std::vector<std::pair<std::string, std::vector<double>>> timesOfPasses(const std::vector<FrameTime>& frames) {
  std::vector<std::pair<std::string, std::vector<double>>> times;
  for (const FrameTime& frame : frames)
    for (const PassTime& pass : frame.passes) {
      auto known = std::ranges::find(times, pass.name, [](const auto& entry) { return entry.first; });
      if (known == times.end()) known = times.insert(times.end(), {pass.name, {}});
      known->second.push_back(pass.milliseconds);
    }
  return times;
}

double gpuMillisecondsOf(const FrameTime& frame) {
  double sum = 0;
  for (const PassTime& pass : frame.passes)
    if (pass.depth == 0) sum += pass.milliseconds;
  return sum;
}

Json timesJson(const RenderRun& run) {
  std::vector<double> cpu, gpu;
  for (const FrameTime& frame : run.frames) {
    cpu.push_back(frame.cpuMilliseconds);
    gpu.push_back(gpuMillisecondsOf(frame));
  }
  Json passes, least, median;
  for (const PassTime& pass : run.frames.back().passes) passes[pass.name] = pass.milliseconds;
  for (const auto& [name, times] : timesOfPasses(run.frames)) {
    least[name] = leastOf(times);
    median[name] = medianOf(times);
  }
  return {{"frame", gpu.back()},
          {"passes", passes},
          {"passes_min", least},
          {"passes_median", median},
          {"frames_gpu", gpu},
          {"frames_gpu_min", leastOf(gpu)},
          {"frames_gpu_median", medianOf(gpu)},
          {"frames_cpu", cpu},
          {"frames_cpu_min", leastOf(cpu)},
          {"frames_cpu_median", medianOf(cpu)}};
}

Json timersJson(const ContextInfo& device) {
  if (!device.isSoftware) return {{"kind", "queries"}, {"meaning", "GPU timestamps around each pass"}};
  return {{"kind", "software"},
          {"meaning", "glFinish and the CPU's clock around each pass: timer queries mean nothing on a software "
                      "rasterizer, and frames_cpu holds the drawing too"}};
}

Json countsJson(const FrameStats& stats) {
  return {{"sdf_instances", stats.sdfInstances},
          {"sdf_visible", stats.sdfVisible},
          {"sdf_near_plane", stats.sdfInside},
          {"mesh_draws", stats.meshDraws},
          {"mesh_visible", stats.meshVisible},
          {"bricks", stats.bricks},
          {"fragments", stats.counters.fragments},
          {"hits", stats.counters.hits},
          {"steps", stats.counters.steps},
          {"brick_reads", stats.counters.brickReads},
          {"promise_broken", stats.counters.promiseBroken},
          {"out_of_steps", stats.counters.outOfSteps},
          {"shadow_reads", stats.counters.shadowReads},
          {"ao_reads", stats.counters.occlusionReads},
          {"inside_steps", stats.counters.insideSteps},
          {"reflection_reads", stats.counters.reflectionReads},
          {"shadow_map_layers", stats.shadowMapLayers},
          {"shadow_map_draws", stats.shadowMapDraws},
          {"shadow_map_boxes", stats.shadowMapBoxes},
          {"shadow_map_fragments", stats.counters.mapFragments},
          {"shadow_map_steps", stats.counters.mapSteps}};
}

// Of the last frame; tiles are those of the exact field.
Json fieldJson(const FieldStats& field) {
  Json json{{"made", field.method != FieldMethod::Off}};
  if (field.method == FieldMethod::Off) return json;
  json["cascades"] = field.cascades;
  json["triangles"] = field.triangles;
  json["moved_instances"] = field.movedInstances;
  if (field.method == FieldMethod::Exact)
    json["tiles"] = {{"all", field.tiles},
                     {"keys", field.keyTiles},
                     {"candidates", field.candidateTiles},
                     {"values", field.valueTiles}};
  const FieldStats::Bytes& bytes = field.bytes;
  json["bytes"] = {
      {"all", bytes.triangles + bytes.hierarchy + bytes.distances + bytes.nodes + bytes.objects + bytes.work},
      {"triangles", bytes.triangles},
      {"hierarchy", bytes.hierarchy},
      {"distances", bytes.distances},
      {"nodes", bytes.nodes},
      {"objects", bytes.objects},
      {"work", bytes.work}};
  return json;
}

std::size_t peakHostBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024; // Linux counts KiB
}

Json bytesJson(const GpuBytes& gpu) {
  return {{"scene", gpu.bricks + gpu.meshes + gpu.textures + gpu.tables},
          {"bricks", gpu.bricks},
          {"meshes", gpu.meshes},
          {"textures", gpu.textures},
          {"tables", gpu.tables},
          {"targets", gpu.targets},
          {"shadow_maps", gpu.shadowMaps},
          {"temporal", gpu.temporal},
          {"host_peak", peakHostBytes()}};
}

} // namespace

nlohmann::ordered_json renderStatsJson(const RenderRun& run) {
  const RenderRequest& request = *run.request;
  Json json;
  json["scene"] = request.scene.path.string();
  json["size"] = {request.camera.sizePixels.x, request.camera.sizePixels.y};
  json["frames"] = request.frames;
  json["seed"] = request.scene.seed;
  json["settings"] = settingsJson(run);
  json["scene_counts"] = sceneJson(run);
  json["gpu"] = {{"renderer", run.device->renderer}, {"vendor", run.device->vendor},
                 {"version", run.device->version},   {"glsl", run.device->glslVersion},
                 {"platform", run.device->platform}, {"software", run.device->isSoftware}};
  json["timers"] = timersJson(*run.device);
  json["seconds"] = {{"load", run.loadSeconds}, {"bake", run.bakeSeconds}, {"draw", run.drawSeconds}};
  json["cache"] = {
      {"folder", cacheFolderOf(request)}, {"hits", run.fields->fields.size() - run.baked}, {"misses", run.baked}};
  json["milliseconds"] = timesJson(run);
  json["counts"] = countsJson(run.last);
  json["world_field"] = fieldJson(run.frames.back().field);
  json["bytes"] = bytesJson(run.last.bytes);
  return json;
}

} // namespace brickfield
