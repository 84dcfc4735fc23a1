// The statistics of a render are the figures; here they become a table.
#include "app/bench_frame.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "app/command_render.h"
#include "app/frame_medians.h"
#include "app/render_stats.h"
#include "app/session.h"
#include "app/thesis_published.h"
#include "core/error.h"
#include "core/files.h"
#include "gpu/gl.h"

namespace brickfield {

namespace {

using Json = nlohmann::ordered_json;

// The thesis' columns, by the passes that take their place.
struct ThesisTimes {
  double frame = 0, primary = 0, field = 0, shadow = 0, occlusion = 0, shading = 0, other = 0;
};

ThesisTimes thesisTimesOf(const Json& medians) {
  static constexpr std::array<std::string_view, 8> kPrimary{"deform",     "clear",   "sdf_cull",         "mesh",
                                                            "depth_copy", "sdf_box", "sdf_screen_boxes", "sdf_tiles"};
  ThesisTimes times;
  for (const auto& [name, value] : medians.items()) {
    const double milliseconds = value;
    times.frame += milliseconds;
    if (name.find("shadow") != std::string::npos)
      times.shadow += milliseconds;
    else if (name.find("occlusion") != std::string::npos)
      times.occlusion += milliseconds;
    else if (name == "lighting")
      times.shading += milliseconds;
    else if (name.starts_with("field_") || name.starts_with("world_"))
      times.field += milliseconds;
    else if (std::ranges::find(kPrimary, name) != kPrimary.end())
      times.primary += milliseconds;
    else
      times.other += milliseconds;
  }
  return times;
}

template <typename Rows>
auto rowOf(const Rows& rows, int objects) {
  const auto row = std::ranges::find(rows, objects, [](const auto& r) { return r.objects; });
  return row == rows.end() ? nullptr : &*row;
}

// The thesis' scene that a scene stands beside: as many objects, or fewer, for its hall may be of objects too.
int thesisObjectsFor(int objects) {
  for (const int printed : {100, 80, 60, 40, 20, 15})
    if (objects >= printed) return printed;
  throw BadInput("--beside", "thesis", fmt::format("has no figures of {} SDF objects; of 15 at least", objects));
}

// By boxes or in one pass over the picture: the thesis has a row for each.
Json printThesis(int objects, bool byBoxes, const ThesisTimes& ours) {
  const int here = objects;
  objects = thesisObjectsFor(objects);
  const published::ThesisRow* paper = rowOf(published::kThesis, objects);
  const published::ThesisProgramRow* program = rowOf(published::kThesisOnH200, objects);
  fmt::print("\n{} objects, ms       {:>12}{:>22}{:>22}\n", objects, fmt::format("here, {}", here),
             "its program on H200", "thesis, GTX 980");
  Json json{{"objects", objects}, {"objects_here", here}};
  const auto print = [&](const char* what, double measured, double onH200, double printed) {
    const auto text = [](double value) { return value > 0 ? fmt::format("{:.3f}", value) : std::string("-"); };
    fmt::print("  {:<18}{:>12}{:>22}{:>22}\n", what, text(measured), text(onH200), text(printed));
    json[what] = {{"here", measured}, {"program_on_h200", onH200}, {"published", printed}};
  };
  print("frame", ours.frame, program ? program->frame : 0, paper ? paper->frame : 0);
  print("frame, shared", 0, objects == 100 ? 3.88 : 0, paper ? paper->instancedFrame : 0);
  print("primary", byBoxes ? 0 : ours.primary, program ? program->primary : 0, paper ? paper->primary : 0);
  print("primary, boxes", byBoxes ? ours.primary : 0, program ? program->boxes : 0, paper ? paper->boxes : 0);
  print("shadow", ours.shadow, program ? program->shadow : 0, paper ? paper->shadow : 0);
  print("AO", ours.occlusion, program ? program->occlusion : 0, paper ? paper->occlusion : 0);
  print("shading", ours.shading, program ? program->shading : 0, 0);
  print("world field", ours.field, 0, 0);
  print("other", ours.other, 0, 0);
  return json;
}

// Eight texels of a byte for a distance in bricks, eight of two for one in the world field, before caches.
Json pixelCountsOf(const FrameStats& stats, double pixels) {
  constexpr double kBrickReadBytes = 8, kFieldReadBytes = 16;
  const FrameCounters& counts = stats.counters;
  const double bytes =
      kBrickReadBytes * counts.brickReads +
      kFieldReadBytes * (double{1} * counts.shadowReads + counts.occlusionReads + counts.reflectionReads);
  return {{"box_fragments", counts.fragments / pixels},
          {"trace_steps", counts.steps / pixels},
          {"brick_reads", counts.brickReads / pixels},
          {"shadow_reads", counts.shadowReads / pixels},
          {"ao_reads", counts.occlusionReads / pixels},
          {"reflection_reads", counts.reflectionReads / pixels},
          {"bytes_marched", bytes / pixels}};
}

void printFigures(const Json& stats, const Json& perPixel) {
  const Json& times = stats.at("milliseconds");
  fmt::print("{}x{}, {} frames; {}, {}\n", stats.at("size")[0].get<int>(), stats.at("size")[1].get<int>(),
             stats.at("frames").get<int>(), stats.at("gpu").at("renderer").get<std::string>(),
             stats.at("gpu").at("version").get<std::string>());
  fmt::print("settings: {}\n\n{:<20}{:>12}{:>12}\n", stats.at("settings").dump(), "pass, ms", "median", "least");
  for (const auto& [name, median] : times.at("passes_median").items())
    fmt::print("{:<20}{:>12.3f}{:>12.3f}\n", name, median.get<double>(), times.at("passes_min").at(name).get<double>());
  fmt::print("{:<20}{:>12.3f}{:>12.3f}\n", "frame", times.at("frames_gpu_median").get<double>(),
             times.at("frames_gpu_min").get<double>());
  fmt::print("{:<20}{:>12.3f}{:>12.3f}\n\ncounts:", "frame, processor", times.at("frames_cpu_median").get<double>(),
             times.at("frames_cpu_min").get<double>());
  for (const auto& [name, count] : stats.at("counts").items()) fmt::print(" {} {}", name, count.get<std::uint64_t>());
  fmt::print("\na pixel:");
  for (const auto& [name, count] : perPixel.items()) fmt::print(" {} {:.2f}", name, count.get<double>());
  fmt::print("\n");
}

RenderRun measure(RenderRequest& request, const LoadedRender& loaded) {
  RenderRun run;
  Renderer renderer(loaded.context->info());
  renderer.setScene(loaded.scene, loaded.baked.fields);
  settleTrace(request, loaded, renderer);
  renderer.setSettings(rendererSettingsOf(request));
  const auto drawFirst = [&](int) {
    throwIfInterrupted();
    drawFrame(request, loaded, 0, renderer);
    renderer.passTimes(); // waits
  };
  if (loaded.context->info().isSoftware)
    drawFirst(0); // makes everything; its clock does not sleep
  else
    warmUp(drawFirst);
  for (int frame = 0; frame < request.frames; ++frame) {
    throwIfInterrupted();
    const Stopwatch stopwatch;
    drawFrame(request, loaded, frame, renderer);
    const double cpuMilliseconds = stopwatch.milliseconds();
    run.frames.push_back({cpuMilliseconds, renderer.passTimes(), renderer.fieldStats()});
    if (run.frames.back().passes.empty()) throw Failure("the GPU gave no times: it may have been reset");
  }
  run.last = countFrame(request, loaded.view, renderer);
  return run;
}

} // namespace

void runFrameBench(FrameBenchRequest request) {
  RenderRequest& render = request.render;
  const std::vector<OutputPath> outputs{{"--json", request.json, {".json"}}};
  checkOutputs(outputs, {render.scene.path, render.light.environment});
  settleFrameOptions(render);
  const LoadedRender loaded = loadRender(render, outputs);
  const auto objects =
      static_cast<int>(std::ranges::count_if(loaded.pose.instances, [&](const PosedInstance& instance) {
        return loaded.baked.fields.fieldOfNode[static_cast<std::size_t>(instance.node)] >= 0;
      }));
  if (request.besideThesis) thesisObjectsFor(objects); // refuses
  RenderRun run = measure(render, loaded);
  run.request = &render, run.scene = &loaded.scene, run.pose = &loaded.pose, run.lighting = &loaded.lighting;
  run.fields = &loaded.baked.fields, run.device = &loaded.context->info(), run.view = loaded.view;
  run.loadSeconds = loaded.loadSeconds, run.bakeSeconds = loaded.bakeSeconds, run.baked = loaded.baked.baked;
  if (const std::vector<std::string> errors = loaded.context->takeGlErrors(); !errors.empty())
    throw Failure("OpenGL: " + errors.front());
  Json json = renderStatsJson(run);
  const glm::uvec2 size = render.camera.sizePixels;
  json["per_pixel"] = pixelCountsOf(run.last, static_cast<double>(size.x) * size.y);
  printFigures(json, json.at("per_pixel"));
  if (request.besideThesis)
    json["thesis"] = printThesis(objects, render.trace == TraceChoice::Boxes,
                                 thesisTimesOf(json.at("milliseconds").at("passes_median")));
  if (!request.json.empty()) writeFile(request.json, json.dump(2) + "\n");
}

} // namespace brickfield
