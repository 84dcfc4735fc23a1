// Per scene: the truth of all lights at once, then each method with a renderer of its own, a light at a time.
#include "app/bench_shadows.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "app/bench_tables.h"
#include "app/frame_medians.h"
#include "app/image_io.h"
#include "app/memory_limit.h"
#include "app/progress_bar.h"
#include "app/scene_fields.h"
#include "app/session.h"
#include "app/shadow_bricks.h"
#include "app/shadow_errors.h"
#include "app/shadow_methods.h"
#include "app/shadow_truth.h"
#include "core/error.h"
#include "core/files.h"
#include "gpu/gl.h"
#include "renderer/renderer.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BenchedLight {
  std::string name;
  PosedLight light;
};

// A slab under the scene, three times as wide.
void putFloor(Scene& scene, const Pose& pose) {
  const Box& bounds = pose.boundsWorld;
  const float half = 1.5f * std::max(bounds.extent().x, bounds.extent().z), thick = 0.02f * half;
  Primitive slab;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const auto first = static_cast<std::uint32_t>(slab.positions.size());
      glm::vec3 normal(0), right(0), up(0);
      normal[axis] = side, right[(axis + 1) % 3] = side, up[(axis + 2) % 3] = 1;
      for (const glm::vec3 corner :
           {normal - right - up, normal + right - up, normal + right + up, normal - right + up}) {
        slab.positions.push_back(corner * glm::vec3(half, 0.5f * thick, half));
        slab.normals.push_back(normal);
      }
      for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) slab.indices.push_back(first + corner);
    }
  Node node;
  node.name = "Floor";
  node.mesh = static_cast<int>(scene.meshes.size());
  node.translation = {bounds.center().x, bounds.min.y - 0.5f * thick, bounds.center().z};
  scene.meshes.push_back({"Floor", {std::move(slab)}, {}});
  scene.scenes[static_cast<std::size_t>(std::max(scene.defaultScene, 0))].nodes.push_back(
      static_cast<int>(scene.nodes.size()));
  scene.nodes.push_back(std::move(node));
}

std::vector<BenchedLight> lightsOf(const ShadowBenchRequest& request, const Pose& pose) {
  glm::vec3 travels(0.5f, -1.0f, -0.7f);
  const auto sun = std::ranges::find(pose.lights, LightKind::Sun, [](const PosedLight& l) { return l.light.kind; });
  if (sun != pose.lights.end()) travels = sun->directionWorld;
  travels = request.sunTravels.value_or(travels);
  std::vector<BenchedLight> lights;
  for (const double degrees : request.sunDegrees)
    lights.push_back(
        {fmt::format("sun {:g}", degrees),
         makeLighting(pose, {{fmt::format("sun:{},{},{}:{}:3.14159", travels.x, travels.y, travels.z, degrees)}, {}})
             .lights.front()});
  if (request.sphereRadius <= 0) return lights;
  const Box& bounds = pose.boundsWorld;
  const glm::vec3 place = request.sphereWorld.value_or(
      glm::vec3(bounds.center().x, bounds.min.y + 0.8f * bounds.extent().y, bounds.center().z));
  lights.push_back(
      {fmt::format("sphere {:g}", request.sphereRadius),
       makeLighting(pose, {{fmt::format("sphere:{},{},{}:{}:10", place.x, place.y, place.z, request.sphereRadius)}, {}})
           .lights.front()});
  return lights;
}

std::vector<BenchedShadows> methodsOf(const ShadowBenchRequest& request) {
  if (request.methods.empty()) return benchedShadows();
  std::vector<BenchedShadows> methods;
  for (const std::string& name : request.methods) {
    const BenchedShadows* method = findBenchedShadows(name);
    if (!method) {
      std::string known;
      for (const BenchedShadows& other : benchedShadows()) known += (known.empty() ? "" : ", ") + other.name;
      throw BadInput("--methods", fmt::format("\"{}\"", name), "is none of " + known);
    }
    methods.push_back(*method);
  }
  return methods;
}

RendererSettings settingsOf(const ShadowBenchRequest& request, const BenchedShadows& method) {
  RendererSettings settings;
  settings.shadows = method.settings;
  settings.shadowMaps = method.maps;
  settings.worldField.method = method.field;
  settings.worldField.shape = shapeOfSize(request.fieldSize);
  setRtsdfSize(settings.worldField.rtsdf, request.fieldSize);
  settings.worldField.rtsdf.bias = 0; // the kindest
  return settings;
}

struct Measured {
  FrameLayers layers;
  std::optional<ShadowErrors> errors;
  std::vector<std::uint8_t> counts; ///< pixels, where there is a truth
  double readsMean = 0;
  std::uint32_t readsP95 = 0; ///< of pixels that show a surface
  std::vector<PassTime> passes;

  double shadowMilliseconds() const {
    double sum = 0;
    for (const PassTime& pass : passes)
      if (pass.name.find("shadow") != std::string::npos) sum += pass.milliseconds;
    return sum;
  }
};

class SceneBench {
public:
  SceneBench(const ShadowBenchRequest& request, const ContextInfo& device, const fs::path& path)
      : request_(request), device_(device), path_(path), scene_(importGltf(path)) {
    pose_ = poseScene(scene_, request.scene.pose);
    if (pose_.boundsWorld.isEmpty()) throw BadInput(scene_.name, "", "has no triangle that could cast a shadow");
    view_ = makeView(scene_, pose_, request.camera);
    lights_ = lightsOf(request, pose_);
    if (request.hasFloor) {
      putFloor(scene_, pose_);
      pose_ = poseScene(scene_, request.scene.pose);
    }
    printWarnings(scene_);
    bakeBricks();
    takeTruth();
  }

  Json run() {
    fmt::print("\n{}: {}x{}, field of size {}{}\n", path_.filename().string(), view_.sizePixels.x, view_.sizePixels.y,
               request_.fieldSize,
               truth_ ? fmt::format(", truth of {} samples", request_.samples)
                      : std::string(", no errors: this build has no Embree"));
    fmt::print("{:<18}{:<12}{:>8}{:>9}{:>11}{:>9}{:>8}{:>6}{:>11}  passes, ms\n", "method", "light", "rmse", "mean",
               "speckled", "leaking", "reads", "95 %", "shadow ms");
    Json json{{"scene", path_.filename().string()}, {"methods", Json::array()}};
    for (const BenchedShadows& method : methodsOf(request_)) {
      Json entry{{"method", method.name}, {"lights", Json::array()}};
      for (Measured& measured : measure(method)) {
        const std::string& light = lights_[entry["lights"].size()].name;
        entry["lights"].push_back(report(method, light, measured));
        rows_.push_back(std::move(measured));
      }
      json["methods"].push_back(std::move(entry));
    }
    if (!request_.plates.empty()) writePng(request_.plates / (path_.stem().string() + ".png"), plate());
    return json;
  }

private:
  void bakeBricks() {
    const fs::path cache = request_.scene.cacheFolder.value_or(defaultCacheFolder());
    ProgressBar bar;
    SceneFieldsResult baked = bakeSceneFields(
        scene_, pose_, sdfNodes(scene_, request_.scene.sdf, request_.scene.threads), cache, bar.progress());
    for (const std::string& warning : baked.warnings) printWarning(warning);
    fields_ = std::move(baked.fields);
    withBricks_ = fields_;
    const std::vector<BenchedShadows> methods = methodsOf(request_);
    if (std::ranges::none_of(methods, &BenchedShadows::wantsBricks)) return;
    const ShadowBrickRequest bricks{request_.brickVoxels, request_.scene.sdf.memoryBytes.value_or(defaultMemoryBytes()),
                                    request_.scene.threads, cache};
    for (const std::string& warning : addShadowBricks(scene_, pose_, bricks, withBricks_, bar.progress()))
      printWarning(warning);
  }

  void takeTruth() {
    Lighting lighting;
    for (const BenchedLight& benched : lights_) lighting.lights.push_back(benched.light);
    lighting.environment = {{1, 1}, {glm::vec3(0)}};
    const fs::path folder = request_.truthFolder.empty() ? defaultCacheFolder() / "shadow-truth" : request_.truthFolder;
    truth_ = shadowTruth(
        {scene_, pose_, view_, lighting, request_.samples, request_.scene.threads, folder, path_.stem().string()});
  }

  std::vector<Measured> measure(const BenchedShadows& method) {
    Renderer renderer(device_);
    renderer.setScene(scene_, method.wantsBricks ? withBricks_ : fields_);
    renderer.setPose(pose_);
    RendererSettings settings = settingsOf(request_, method);
    std::vector<Measured> all;
    for (const BenchedLight& benched : lights_) {
      renderer.setLighting({{benched.light}, {{1, 1}, {glm::vec3(0)}}});
      settings.countersOn = true;
      renderer.setSettings(settings);
      for (int frame = 0; frame < (all.empty() ? method.fieldFrames : 1); ++frame) {
        throwIfInterrupted();
        renderer.render(view_);
      }
      all.push_back(judge(renderer, method, benched));
      settings.countersOn = false;
      renderer.setSettings(settings);
      timeFrames(renderer, all.back());
    }
    return all;
  }

  Measured judge(Renderer& renderer, const BenchedShadows& method, const BenchedLight& benched) const {
    Measured measured;
    measured.layers = renderer.readLayers();
    std::vector<std::uint32_t> reads, all;
    if (marchesField(method.settings.method)) all = renderer.readShadowReads();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (measured.layers.kind[i] != SurfaceKind::None) reads.push_back(all[i]);
    std::sort(reads.begin(), reads.end());
    if (!reads.empty()) {
      for (const std::uint32_t count : reads) measured.readsMean += count;
      measured.readsMean /= static_cast<double>(reads.size());
      measured.readsP95 = reads[reads.size() * 95 / 100];
    }
    if (!truth_) return measured;
    measured.counts = comparableShadowPixels(measured.layers, *truth_, view_, benched.light);
    measured.errors = shadowErrors(measured.layers.shadow.front(), truthOf(benched), *truth_, measured.counts);
    return measured;
  }

  void timeFrames(Renderer& renderer, Measured& measured) const {
    const auto draw = [&](int) {
      throwIfInterrupted();
      renderer.render(view_);
      glFinish();
    };
    if (device_.isSoftware)
      draw(0); // compiles
    else
      warmUp(draw);
    FrameMedians medians;
    for (int frame = 0; frame < request_.frames; ++frame) {
      draw(frame);
      medians.add(renderer.passTimes());
    }
    measured.passes = medians.passes();
  }

  const std::vector<float>& truthOf(const BenchedLight& benched) const {
    return truth_->shadow[static_cast<std::size_t>(&benched - lights_.data())];
  }

  static Json report(const BenchedShadows& method, const std::string& light, const Measured& measured) {
    std::string errors = fmt::format("{:>37}", "-"), passes;
    Json json{{"light", light}, {"reads", {{"mean", measured.readsMean}, {"p95", measured.readsP95}}}};
    if (measured.errors) {
      const ShadowErrors& e = *measured.errors;
      errors = fmt::format("{:>8.4f}{:>+9.4f}{:>9.3f} %{:>7.2f} %", e.rmse, e.mean, 100 * e.speckled, 100 * e.leaking);
      json["errors"] = {
          {"rmse", e.rmse}, {"mean", e.mean}, {"speckled", e.speckled}, {"leaking", e.leaking}, {"pixels", e.pixels}};
    }
    for (const PassTime& pass : measured.passes) {
      json["passes_ms"][pass.name] = pass.milliseconds;
      if (pass.milliseconds >= 0.005) passes += fmt::format(" {} {:.2f}", pass.name, pass.milliseconds);
    }
    json["shadow_ms"] = measured.shadowMilliseconds();
    fmt::print("{:<18}{:<12}{}{:>8.1f}{:>6}{:>11.3f} {}\n", method.name, light, errors, measured.readsMean,
               measured.readsP95, measured.shadowMilliseconds(), passes);
    std::fflush(stdout);
    return json;
  }

  /// A row a method, a column a light; beside each picture its heat map. The first row is the truth.
  RgbImage plate() const {
    const glm::uvec2 tile = view_.sizePixels;
    const auto columns = static_cast<std::uint32_t>(lights_.size()) * (truth_ ? 2u : 1u);
    const auto rows = static_cast<std::uint32_t>(rows_.size() / lights_.size()) + (truth_ ? 1u : 0u);
    RgbImage image{{columns * tile.x, rows * tile.y}, {}};
    if (std::uint64_t{image.size.x} * image.size.y > kLargestImagePixels)
      throw BadInput("--plates", "", "would be larger than pictures may be; give a smaller --size");
    image.pixels.assign(std::size_t{image.size.x} * image.size.y, glm::vec3(1));
    const auto put = [&](std::uint32_t column, std::uint32_t row, const RgbImage& part) {
      for (std::uint32_t y = 0; y < tile.y; ++y)
        std::copy_n(part.pixels.begin() + y * tile.x, tile.x,
                    image.pixels.begin() + (std::size_t{row} * tile.y + y) * image.size.x + column * tile.x);
    };
    const std::uint32_t step = truth_ ? 2 : 1;
    for (std::uint32_t light = 0; truth_ && light < lights_.size(); ++light)
      put(step * light, 0, shadowPicture(truth_->shadow[light], tile));
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
      const auto light = i % static_cast<std::uint32_t>(lights_.size());
      const std::uint32_t row = i / static_cast<std::uint32_t>(lights_.size()) + (truth_ ? 1u : 0u);
      const std::vector<float>& shadow = rows_[i].layers.shadow.front();
      put(step * light, row, shadowPicture(shadow, tile));
      if (truth_) put(step * light + 1, row, shadowHeatMap(shadow, truth_->shadow[light], tile, rows_[i].counts));
    }
    return image;
  }

  const ShadowBenchRequest& request_;
  const ContextInfo& device_;
  fs::path path_;
  Scene scene_;
  Pose pose_;
  View view_;
  std::vector<BenchedLight> lights_;
  SceneFields fields_, withBricks_;
  std::optional<FrameLayers> truth_;
  std::vector<Measured> rows_;
};

} // namespace

void runShadowBench(const ShadowBenchRequest& request) {
  std::vector<fs::path> scenes = request.more;
  scenes.insert(scenes.begin(), request.scene.path);
  checkOutputs({{"--json", request.json, {".json"}}}, scenes);
  checkCamera(request.camera);
  for (const fs::path& path : scenes) checkInputPath(path, {".gltf", ".glb"});
  for (const fs::path& path : scenes)
    if (!request.plates.empty())
      checkOutputPath(request.plates / (path.stem().string() + ".png"), "--plates", {".png"});
  for (const BenchedShadows& method : methodsOf(request)) fmt::print("{:<18}{}\n", method.name, method.meaning);
  const std::unique_ptr<Context> context = Context::createHeadless(request.device);
  fmt::print("{}, {}\n", context->info().renderer, context->info().version);
  Json json{{"gpu", context->info().renderer},
            {"driver", context->info().version},
            {"size", {request.camera.sizePixels.x, request.camera.sizePixels.y}},
            {"field_size", request.fieldSize},
            {"samples", request.samples},
            {"scenes", Json::array()}};
  for (const fs::path& path : scenes) json["scenes"].push_back(SceneBench(request, context->info(), path).run());
  if (const std::vector<std::string> errors = context->takeGlErrors(); !errors.empty())
    throw Failure("OpenGL: " + errors.front());
  if (!request.json.empty()) writeFile(request.json, json.dump(2) + "\n");
}

} // namespace brickfield
