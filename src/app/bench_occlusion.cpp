// One renderer a scene, one truth a radius.
#include "app/bench_occlusion.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/frame_medians.h"
#include "app/image_io.h"
#include "app/progress_bar.h"
#include "app/scene_fields.h"
#include "app/session.h"
#include "core/error.h"
#include "core/files.h"
#include "renderer/renderer.h"
#include "scene/gltf_import.h"
#ifdef BRICKFIELD_BAKERS
#include "bakers/reference.h"
#endif

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

struct OcclusionError {
  std::size_t pixels = 0; ///< where both see the same node
  double rmse = 0, mean = 0;
};

struct OcclusionCost {
  double milliseconds = 0, tracing = 0, readsPerPixel = 0; ///< tracing: the first of the two passes
};

class OcclusionBench {
public:
  OcclusionBench(const OcclusionBenchRequest& request, const ContextInfo& device, const std::filesystem::path& path)
      : request_(request),
        scene_(importGltf(path)),
        pose_(poseScene(scene_, {})),
        view_(makeView(scene_, pose_, request.camera)),
        renderer_(device) {
    const auto sdf = sdfNodes(scene_, request.sdf, 0);
    ProgressBar bar;
    fields_ = bakeSceneFields(scene_, pose_, sdf, request.cache.empty() ? defaultCacheFolder() : request.cache,
                              bar.progress())
                  .fields;
    renderer_.setScene(scene_, fields_);
    renderer_.setPose(pose_);
    renderer_.setLighting(makeLighting(pose_, {{"none"}, {}}));
  }

  Json measure() {
    Json json = Json::array();
    for (const float radius : request_.radii) {
      const FrameLayers truth = traceTruth(radius);
      for (const OcclusionForm form : request_.forms) {
        if (form != OcclusionForm::Cones && !std::isfinite(radius)) continue;
        for (const int scale : request_.scales) json.push_back(measureOne(radius, form, scale, truth));
      }
    }
    return json;
  }

private:
  /// Without layers in a build without bakers, or where no errors are asked for.
  FrameLayers traceTruth(float radius) const {
#ifdef BRICKFIELD_BAKERS
    if (request_.samples > 0) {
      const Lighting darkness = makeLighting(pose_, {{"none"}, {}});
      ReferenceRequest request;
      request.scene = &scene_, request.pose = &pose_, request.view = &view_, request.lighting = &darkness;
      request.samples = request_.samples;
      request.shadows = false;
      request.ambientOcclusionMetres = radius;
      ProgressBar bar;
      return traceReference(request, bar.progress());
    }
#endif
    static_cast<void>(radius);
    return {};
  }

  Json measureOne(float radius, OcclusionForm form, int scale, const FrameLayers& truth) {
    RendererSettings settings;
    settings.worldField = request_.field.settings;
    settings.occlusion.form = form;
    settings.occlusion.radiusMetres = radius;
    settings.occlusion.scale = scale;
    const OcclusionCost cost = measureCost(settings);
    const FrameLayers layers = renderer_.readLayers();
    fmt::print("{:<28}{:<8}{:>8}{:>8g}{:>9.1f}{:>9.3f}{:>9.3f}", scene_.name.substr(scene_.name.rfind('/') + 1),
               occlusionFormName(form), scale, radius, cost.readsPerPixel, cost.tracing, cost.milliseconds);
    Json json{{"form", occlusionFormName(form)},
              {"every_nth_pixel", scale},
              {"radius", std::isfinite(radius) ? Json(radius) : Json("inf")},
              {"reads_per_pixel", cost.readsPerPixel},
              {"milliseconds", cost.milliseconds}};
    if (!truth.ambientOcclusion.empty()) {
      const OcclusionError error = errorOf(layers, truth);
      fmt::print("{:>9.4f}{:>+9.4f}{:>10}", error.rmse, error.mean, error.pixels);
      json.update({{"rmse", error.rmse}, {"mean_error", error.mean}, {"pixels", error.pixels}});
    }
    fmt::print("\n");
    std::fflush(stdout);
    return json;
  }

  OcclusionCost measureCost(RendererSettings& settings) {
    renderer_.setSettings(settings);
    const auto draw = [&](int) {
      throwIfInterrupted();
      renderer_.render(view_);
      return renderer_.passTimes(); // waits
    };
    int frame = warmUp(draw);
    FrameMedians medians;
    for (const int end = frame + request_.frames; frame < end; ++frame) medians.add(draw(frame));
    OcclusionCost cost;
    for (const PassTime& pass : medians.passes()) {
      if (pass.name == "field_occlusion") cost.tracing = pass.milliseconds;
      if (pass.name == "field_occlusion" || pass.name == "occlusion_spread") cost.milliseconds += pass.milliseconds;
    }
    settings.countersOn = true;
    renderer_.setSettings(settings);
    renderer_.render(view_);
    const std::size_t pixels = std::size_t{view_.sizePixels.x} * view_.sizePixels.y;
    cost.readsPerPixel = renderer_.stats().counters.occlusionReads / static_cast<double>(pixels);
    return cost;
  }

  static OcclusionError errorOf(const FrameLayers& layers, const FrameLayers& truth) {
    OcclusionError error;
    double squares = 0;
    for (std::size_t i = 0; i < truth.id.size(); ++i) {
      if (truth.id[i] < 0 || truth.id[i] != layers.id[i]) continue;
      const double difference = double{layers.ambientOcclusion[i]} - double{truth.ambientOcclusion[i]};
      squares += difference * difference, error.mean += difference;
      ++error.pixels;
    }
    const double count = static_cast<double>(std::max<std::size_t>(error.pixels, 1));
    error.rmse = std::sqrt(squares / count), error.mean /= count;
    return error;
  }

  const OcclusionBenchRequest& request_;
  Scene scene_;
  Pose pose_;
  View view_;
  SceneFields fields_;
  Renderer renderer_;
};

} // namespace

void runOcclusionBench(const OcclusionBenchRequest& request) {
  checkOutputs({{"--json", request.json, {".json"}}}, request.scenes);
  checkCamera(request.camera);
  for (const std::filesystem::path& path : request.scenes) checkInputPath(path, {".gltf", ".glb"});
  const std::unique_ptr<Context> context = Context::createHeadless(request.device);
  fmt::print("{}, {}\n{}x{}, medians of {} frames; errors against {} samples a pixel\n", context->info().renderer,
             context->info().version, request.camera.sizePixels.x, request.camera.sizePixels.y, request.frames,
             request.samples);
  fmt::print("{:<28}{:<8}{:>8}{:>8}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}\n", "scene", "form", "1 in", "radius", "reads/px",
             "traced", "ms", "rmse", "mean", "pixels");
  Json json{{"gpu", context->info().renderer}, {"driver", context->info().version}};
  json["size"] = {request.camera.sizePixels.x, request.camera.sizePixels.y};
  for (const std::filesystem::path& path : request.scenes)
    json["scenes"].push_back(
        {{"scene", path.filename().string()}, {"figures", OcclusionBench(request, context->info(), path).measure()}});
  if (const std::vector<std::string> errors = context->takeGlErrors(); !errors.empty())
    throw Failure("OpenGL: " + errors.front());
  if (!request.json.empty()) writeFile(request.json, json.dump(2) + "\n");
}

} // namespace brickfield
