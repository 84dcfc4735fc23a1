// The renderer makes the fields, as it does for pictures.
#include "app/bench_errors.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/bench_tables.h"
#include "app/session.h"
#include "core/error.h"
#include "renderer/renderer.h"
#ifdef BRICKFIELD_BAKERS
#include "bakers/field_accuracy.h"
#endif

namespace brickfield {

using Json = nlohmann::ordered_json;

#ifdef BRICKFIELD_BAKERS

namespace {

constexpr int kRtsdfRays[] = {1, 5, 10};

class ErrorBench {
public:
  ErrorBench(const FieldBenchSetting& setting, SceneFields fields)
      : setting_(setting), fields_(std::move(fields)), oracle_(setting.scene, setting.pose) {}

  void measureExact(const std::string& size) {
    FieldSettings settings;
    settings.method = FieldMethod::Exact;
    settings.shape = shapeOfSize(size);
    const bool hasObjects = !fields_.fields.empty();
    measure(size, hasObjects ? "exact, with SDF objects" : "exact", settings, fields_, {1}, SheetMeaning::Thick);
  }
  void measureRtsdf(const std::string& size, int rays) {
    FieldSettings settings;
    settings.method = FieldMethod::Rtsdf;
    settings.rtsdf = rtsdfOfSize(setting_.request, size);
    settings.rtsdf.raysPerTexel = rays;
    settings.rtsdf.bias = 0;
    measure(size, fmt::format("rtsdf x={}", rays), settings, {}, setting_.request.errorFrames, SheetMeaning::Unsigned);
  }
  Json takeJson() { return std::move(json_); }

private:
  void measure(const std::string& size, const std::string& name, const FieldSettings& field, const SceneFields& fields,
               std::vector<int> frames, SheetMeaning sheets) {
    std::sort(frames.begin(), frames.end());
    Renderer renderer(setting_.device);
    renderer.setScene(setting_.scene, fields);
    RendererSettings settings;
    settings.worldField = field;
    settings.worldField.always = true;
    renderer.setSettings(settings);
    renderer.setPose(setting_.pose);
    renderer.setLighting(makeLighting(setting_.pose, {{"none"}, {}}));
    CameraRequest camera;
    camera.camera = "auto";
    camera.sizePixels = {8, 8};
    const View view = makeView(setting_.scene, setting_.pose, camera);
    int drawn = 0;
    for (const int until : frames) {
      for (; drawn < until; ++drawn) {
        throwIfInterrupted();
        renderer.render(view);
      }
      const FieldVolumes volumes = renderer.readWorldField();
      report(size, name, drawn,
             measureAccuracy(volumes.cascades.front(), volumes.anchorWorld, oracle_, sheets,
                             setting_.request.errorSamples));
    }
  }

  void report(const std::string& size, const std::string& name, int frames, const FieldAccuracy& error) {
    if (error.texels == 0)
      throw BadInput(setting_.scene.name, "", "has no surface that texels lie near to: there is no error to measure");
    fmt::print("{:<2} {:<24}{:>7}{:>9.4f}{:>9.4f}{:>9.3f}{:>9.3f}{:>9.3f}{:>10.4f} %{:>9.2f}{:>10}{:>9}\n", size, name,
               frames, error.rms, error.p999, error.worst, error.farAbove, error.farBelow, 100 * error.wrongSigns,
               error.farthestWrongSign, error.overlaps, error.texels);
    std::fflush(stdout);
    json_.push_back(
        {{"size", size},
         {"case", name},
         {"frames", frames},
         {"near", {{"texels", error.texels}, {"rms", error.rms}, {"p999", error.p999}, {"worst", error.worst}}},
         {"beyond", {{"above", error.farAbove}, {"below", error.farBelow}, {"mean", error.farMean}}},
         {"signs",
          {{"texels", error.signedTexels},
           {"wrong", error.wrongSigns},
           {"farthest", error.farthestWrongSign},
           {"overlaps", error.overlaps}}}});
  }

  const FieldBenchSetting& setting_;
  SceneFields fields_;
  FieldOracle oracle_;
  Json json_ = Json::array();
};

} // namespace

Json benchErrors(const FieldBenchSetting& setting) {
  fmt::print("\nErrors against exact distances of the triangles, in texels: within 4 of a surface; beyond; signs of "
             "closed surfaces\n(overlaps: where parts reach into each other and no nearest surface tells the side). "
             "rtsdf without its bias.\n");
  fmt::print("{:<2} {:<24}{:>7}{:>9}{:>9}{:>9}{:>9}{:>9}{:>12}{:>9}{:>10}{:>9}\n", "", "", "frames", "rms", "99.9 %",
             "worst", "above", "below", "wrong sign", "farthest", "overlaps", "texels");
  ErrorBench bench(setting, bakeBenchFields(setting));
  for (const std::string& size : setting.request.sizes) {
    bench.measureExact(size);
    std::vector<int> rays = setting.request.rays;
    if (rays.empty()) rays.assign(std::begin(kRtsdfRays), std::end(kRtsdfRays));
    for (const int count : rays) bench.measureRtsdf(size, count);
  }
  return bench.takeJson();
}

#else

Json benchErrors(const FieldBenchSetting&) {
  fmt::print("\nErrors against exact distances need the full build: this one has no Embree.\n");
  return nullptr;
}

#endif

} // namespace brickfield
