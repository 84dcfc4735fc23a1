// The paper's table 1: the renderer draws whole frames, once with each method's field.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "app/bench_tables.h"
#include "app/frame_medians.h"
#include "app/rtsdf_published.h"
#include "app/session.h"
#include "gpu/gl.h"
#include "renderer/renderer.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kRows = published::kFrame.size();
constexpr std::size_t kOthers = 5, kTotal = 6; ///< rows of the table

struct FrameColumn {
  std::array<double, kRows> gpu{}, cpu{}; // by published::kFrame; the processor's time is that of recording
  double framesPerSecond = 0;
};

// The exact field has no voxels, floods or rays; its three stages stand where they take the place of those.
std::size_t rowOf(const std::string& pass) {
  static constexpr std::array<std::array<std::string_view, 7>, 5> kPasses{
      {{"clear", "sdf_cull", "mesh", "depth_copy", "sdf_box", "sdf_screen_boxes", "sdf_tiles"},
       {"rtsdf_voxelize", "field_splat"},
       {"rtsdf_jump_flood", "field_candidates"},
       {"rtsdf_rays", "hierarchy_refit", "field_resolve"},
       {"lighting"}}};
  for (std::size_t row = 0; row < kPasses.size(); ++row)
    if (std::find(kPasses[row].begin(), kPasses[row].end(), pass) != kPasses[row].end()) return row;
  return kOthers;
}

FrameColumn timeFrames(const BenchedScene& scene, const FieldSettings& field) {
  const FieldBenchRequest& request = scene.setting.request;
  Renderer renderer(scene.setting.device);
  renderer.setScene(scene.scene, {});
  RendererSettings settings;
  settings.worldField = field;
  settings.worldField.always = true;
  renderer.setSettings(settings);
  renderer.setPose(scene.rest);
  renderer.setLighting(makeLighting(scene.rest, {{"sun:0.4,-1,-0.3:0.5:3.14159"}, {}}));
  const View view = makeView(scene.scene, scene.rest, request.camera);
  const PoseOfFrame poseOf = motionOf(scene.scene, scene.rest, FieldMotion::Everything);
  const auto draw = [&](int frame) {
    throwIfInterrupted();
    renderer.setPose(poseOf(frame));
    renderer.render(view);
  };
  int frame = warmUp([&](int number) {
    draw(number);
    glFinish();
  });
  FrameMedians medians;
  std::vector<double> recordings;
  for (const int end = frame + request.frames; frame < end; ++frame) {
    const Stopwatch stopwatch;
    draw(frame);
    recordings.push_back(stopwatch.milliseconds());
    medians.add(renderer.passTimes());
  }
  const Stopwatch together;
  for (const int end = frame + request.frames; frame < end; ++frame) draw(frame);
  glFinish();
  FrameColumn column;
  column.framesPerSecond = 1e3 * request.frames / together.milliseconds();
  double recorded = 0;
  for (const PassTime& pass : medians.passes()) {
    column.gpu[rowOf(pass.name)] += pass.milliseconds;
    column.cpu[rowOf(pass.name)] += pass.recordMilliseconds;
    recorded += pass.recordMilliseconds;
  }
  column.gpu[kTotal] = medians.sumMilliseconds();
  column.cpu[kTotal] = medianOf(recordings);
  column.cpu[kOthers] += std::max(column.cpu[kTotal] - recorded, 0.0); // poses, plans, uploads
  return column;
}

Json columnJson(const FrameColumn& column, bool isSoftware) {
  Json json;
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::string pass(published::kFrame[row].pass);
    json["gpu_ms"][pass] = column.gpu[row];
    json["cpu_ms"][pass] = isSoftware ? Json(nullptr) : Json(column.cpu[row]);
  }
  json["frames_per_second"] = column.framesPerSecond;
  return json;
}

// A software rasterizer draws while it records: its processor time is that of the passes.
std::string cpuText(const FrameColumn& column, std::size_t row, bool isSoftware) {
  return isSoftware ? "-" : fmt::format("{:.3f}", column.cpu[row]);
}

} // namespace

Json benchFrameTable(const BenchedScene& scene) {
  const FieldBenchRequest& request = scene.setting.request;
  const std::string& size = scene.setting.mainSize();
  FieldSettings rtsdf, exact;
  rtsdf.method = FieldMethod::Rtsdf;
  rtsdf.rtsdf = rtsdfOfSize(request, size);
  exact.method = FieldMethod::Exact;
  exact.shape = shapeOfSize(size);
  const bool isSoftware = scene.setting.device.isSoftware;
  const FrameColumn ofRtsdf = timeFrames(scene, rtsdf), ofExact = timeFrames(scene, exact);
  fmt::print("\nTable 1: a frame with one directional light, size {}, {}x{}, everything moving; rtsdf x = {}\n", size,
             request.camera.sizePixels.x, request.camera.sizePixels.y, rtsdf.rtsdf.raysPerTexel);
  fmt::print("{:<20}{:>15}{:>15}{:>12}{:>12}{:>12}{:>12}\n", "ms", "published CPU", "published GPU", "rtsdf CPU",
             "rtsdf GPU", "exact CPU", "exact GPU");
  for (std::size_t row = 0; row < kRows; ++row)
    fmt::print("{:<20}{:>15.2f}{:>15.2f}{:>12}{:>12.3f}{:>12}{:>12.3f}\n", published::kFrame[row].pass,
               published::kFrame[row].cpu, published::kFrame[row].gpu, cpuText(ofRtsdf, row, isSoftware),
               ofRtsdf.gpu[row], cpuText(ofExact, row, isSoftware), ofExact.gpu[row]);
  fmt::print("{:<20}{:>15}{:>15.0f}{:>12}{:>12.1f}{:>12}{:>12.1f}\n", "frames a second", "",
             published::kFramesPerSecond, "", ofRtsdf.framesPerSecond, "", ofExact.framesPerSecond);
  fmt::print("Exact: its keys, nearest triangles and distances stand for voxels, flood and rays. The refit of rtsdf's "
             "hierarchy counts\nas ray trace. The processor's time by pass is not measured; the lighting is ours, "
             "without the paper's marched shadows.\n");
  std::fflush(stdout);
  return {{"size", size},
          {"pixels", {request.camera.sizePixels.x, request.camera.sizePixels.y}},
          {"rays", rtsdf.rtsdf.raysPerTexel},
          {"rtsdf", columnJson(ofRtsdf, isSoftware)},
          {"exact", columnJson(ofExact, isSoftware)}};
}

} // namespace brickfield
