// From a request to files: load, pose, bake, draw, read back, write.
#include "app/run_render.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "app/field_error_view.h"
#include "app/image_io.h"
#include "app/layers_io.h"
#include "app/memory_limit.h"
#include "app/progress_bar.h"
#include "app/render_stats.h"
#include "app/scene_fields.h"
#include "app/session.h"
#include "app/shadow_bricks.h"
#include "core/error.h"
#include "core/files.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

bool showsFieldError(const RenderRequest& request) {
  return fieldErrorView() && request.view == fieldErrorView()->name;
}

class Stopwatch {
public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

SceneFieldsResult bakeFields(const RenderRequest& request, const Scene& scene, const Pose& pose) {
  const auto settings = sdfNodes(scene, request.scene.sdf, request.scene.threads);
  const std::filesystem::path cache = request.scene.cacheFolder ? *request.scene.cacheFolder : defaultCacheFolder();
  ProgressBar bar;
  SceneFieldsResult result = bakeSceneFields(scene, pose, settings, cache, bar.progress());
  result.fields.triplanarOfNode = triplanarNodes(scene, request.scene.sdf);
  if (request.fieldShadows.brickVoxels > 0) {
    const ShadowBrickRequest bricks{request.fieldShadows.brickVoxels,
                                    request.scene.sdf.memoryBytes.value_or(defaultMemoryBytes()), request.scene.threads,
                                    cache};
    for (std::string& warning : addShadowBricks(scene, pose, bricks, result.fields, bar.progress()))
      result.warnings.push_back(std::move(warning));
  }
  for (const std::string& warning : result.warnings) printWarning(warning);
  return result;
}

RgbImage displayImage(const FrameLayers& layers, const std::vector<std::uint8_t>& picture) {
  RgbImage image{layers.size, {}};
  image.pixels.reserve(picture.size() / 3);
  for (std::size_t i = 0; i + 2 < picture.size(); i += 3)
    image.pixels.push_back(glm::vec3(picture[i], picture[i + 1], picture[i + 2]) / 255.0f);
  return image;
}

// Renders all frames. Times are taken where statistics are asked for: each frame then ends by waiting for the GPU.
std::vector<FrameTime> drawFrames(const RenderRequest& request, const LoadedRender& loaded, Renderer& renderer) {
  std::vector<FrameTime> times;
  for (int frame = 0; frame < request.frames; ++frame) {
    throwIfInterrupted();
    const Stopwatch stopwatch;
    drawFrame(request, loaded, frame, renderer);
    if (request.stats.empty()) continue;
    const double cpuMilliseconds = stopwatch.seconds() * 1e3;
    times.push_back({cpuMilliseconds, renderer.passTimes(), renderer.fieldStats()});
  }
  return times;
}

} // namespace

std::vector<OutputPath> outputsOf(const RenderRequest& request) {
  return {{"-o", request.output, {".png", ".exr"}},
          {"--layers", request.layers, {".exr"}},
          {"--stats", request.stats, {".json"}}};
}

RendererSettings rendererSettingsOf(const RenderRequest& request) {
  RendererSettings settings;
  settings.exposureEv = request.exposureEv;
  settings.sdfTracing = request.trace == TraceChoice::Tiles ? SdfTracing::Tiles : SdfTracing::Boxes;
  settings.view = showsFieldError(request) ? "field" : request.view;
  settings.worldField = request.field.settings;
  settings.shadows = request.fieldShadows.settings;
  settings.shadows.seed = static_cast<std::uint32_t>(request.scene.seed ^ request.scene.seed >> 32) + 1;
  settings.shadows.method = shadowMethodOf(request.shadows);
  settings.shadowMaps = request.shadowMaps.settings;
  settings.taa = request.taa;
  settings.occlusion = request.occlusion.settings;
  settings.translucency = request.translucency.settings;
  settings.reflections = request.reflections.settings;
  settings.brdf = request.brdf;
  settings.fieldSlice = request.field.slice;
  return settings;
}

LoadedRender loadRender(const RenderRequest& request, const std::vector<OutputPath>& outputs) {
  LoadedRender loaded;
  Stopwatch stopwatch;
  loaded.scene = importGltf(request.scene.path);
  checkSceneFiles(loaded.scene, outputs);
  loaded.loadSeconds = stopwatch.seconds();
  loaded.pose = poseScene(loaded.scene, request.scene.pose);
  loaded.view = makeView(loaded.scene, loaded.pose, request.camera); // refuses a bad camera before the bake
  loaded.lighting = makeLighting(loaded.pose, request.light);        // and bad lights
  sdfNodes(loaded.scene, request.scene.sdf, request.scene.threads);
  loaded.context = Context::createHeadless(request.device);
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (std::max(request.camera.sizePixels.x, request.camera.sizePixels.y) > static_cast<std::uint32_t>(largest))
    throw BadInput("--size", "", "larger than this device's pictures, " + std::to_string(largest) + " pixels a side");
  printWarnings(loaded.scene);
  stopwatch = {};
  loaded.baked = bakeFields(request, loaded.scene, loaded.pose);
  loaded.bakeSeconds = stopwatch.seconds();
  return loaded;
}

// Poses, lights and camera follow the scene's time.
void drawFrame(const RenderRequest& request, const LoadedRender& loaded, int frame, Renderer& renderer) {
  Pose pose = loaded.pose;
  const int before = request.frames - 1 - frame;
  if (before > 0 && request.scene.pose.seconds) {
    PoseRequest earlier = request.scene.pose;
    earlier.seconds = *earlier.seconds - before / 60.0; // clamped to the keys by the pose
    pose = poseScene(loaded.scene, earlier);
  }
  renderer.setPose(pose);
  if (frame == 0 || before == 0 || !loaded.scene.animations.empty())
    renderer.setLighting(makeLighting(pose, request.light));
  renderer.render(makeView(loaded.scene, pose, request.camera));
}

void settleTrace(RenderRequest& request, const LoadedRender& loaded, Renderer& renderer) {
  if (std::ranges::all_of(loaded.baked.fields.fieldOfNode, [](int field) { return field < 0; }))
    request.trace = TraceChoice::Boxes; // there is nothing to trace
  if (request.trace != TraceChoice::Auto) return;
  constexpr std::uint32_t kWidth = 640;
  constexpr int kFrames = 3;
  CameraRequest camera = request.camera;
  glm::uvec2& size = camera.sizePixels;
  const std::uint32_t longest = std::max(size.x, size.y);
  if (longest > kWidth) size = glm::max(glm::uvec2(1), size * kWidth / longest);
  const View view = makeView(loaded.scene, loaded.pose, camera);
  renderer.setPose(loaded.pose);
  renderer.setLighting(loaded.lighting);
  const auto fastest = [&](SdfTracing tracing) {
    RendererSettings settings;
    settings.worldField.method = FieldMethod::Off;
    settings.sdfTracing = tracing;
    renderer.setSettings(settings);
    double least = std::numeric_limits<double>::infinity();
    for (int frame = 0; frame <= kFrames; ++frame) {
      throwIfInterrupted();
      glFinish();
      const Stopwatch stopwatch;
      renderer.render(view);
      glFinish();
      if (frame > 0) least = std::min(least, stopwatch.seconds()); // the first compiles
    }
    return least;
  };
  const double boxes = fastest(SdfTracing::Boxes), tiles = fastest(SdfTracing::Tiles);
  request.trace = tiles < boxes ? TraceChoice::Tiles : TraceChoice::Boxes;
}

FrameStats countFrame(const RenderRequest& request, const View& view, Renderer& renderer) {
  RendererSettings settings = rendererSettingsOf(request);
  settings.countersOn = true;
  renderer.setSettings(settings);
  renderer.render(view);
  return renderer.stats();
}

void runRender(RenderRequest request) {
  const LoadedRender loaded = loadRender(request, outputsOf(request));
  const Scene& scene = loaded.scene;
  RenderRun run;
  run.loadSeconds = loaded.loadSeconds, run.bakeSeconds = loaded.bakeSeconds;
  run.view = loaded.view;
  run.baked = loaded.baked.baked;
  const Stopwatch stopwatch;
  Renderer renderer(loaded.context->info());
  renderer.setScene(scene, loaded.baked.fields);
  settleTrace(request, loaded, renderer);
  renderer.setSettings(rendererSettingsOf(request));
  run.frames = drawFrames(request, loaded, renderer);
  const FrameLayers layers = renderer.readLayers();
  run.drawSeconds = stopwatch.seconds();
  RgbImage picture = displayImage(layers, renderer.readPicture());
  if (showsFieldError(request))
    picture = fieldErrorPicture(renderer.readWorldField(), renderer.fieldPicture(), layers.size, scene, loaded.pose,
                                loaded.baked.fields.fieldOfNode);
  if (!request.stats.empty()) run.last = countFrame(request, run.view, renderer);
  if (const std::vector<std::string> errors = loaded.context->takeGlErrors(); !errors.empty())
    throw Failure("OpenGL: " + errors.front());
  throwIfInterrupted();
  if (!request.layers.empty()) writeLayers(request.layers, layers);
  if (!request.stats.empty()) {
    run.request = &request, run.scene = &scene, run.pose = &loaded.pose;
    run.lighting = &loaded.lighting, run.fields = &loaded.baked.fields, run.device = &loaded.context->info();
    writeFile(request.stats, renderStatsJson(run).dump(2) + "\n");
  }
  // The same radiance, so that an EXR is linear and whole; a PNG is the frame's own picture or view.
  if (extensionOf(request.output) == ".exr")
    writeExr(request.output, {layers.size, layers.color});
  else
    writePng(request.output, picture);
}

} // namespace brickfield
