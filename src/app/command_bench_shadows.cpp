// Lists by commas, as the other benches take them.
#include "app/command_bench_shadows.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/bench_shadows.h"
#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

namespace {

void addLights(CLI::App& command, ShadowBenchRequest& request) {
  addValue(command, "--suns", "Diameters of the suns' disks in degrees, comma separated; 0.5,2,8 by default",
           [&](auto& flag, auto& text) {
             request.sunDegrees.clear();
             if (text == "none") return;
             for (const std::string_view piece : splitText(text, ','))
               request.sunDegrees.push_back(parseNumber(flag, piece, 0, 90));
           })
      ->type_name("DEG,...");
  addValue(command, "--sun-travels", "Where the suns' light travels; absent: as the scene's own sun, or 0.5,-1,-0.7",
           [&](auto& flag, auto& text) {
             request.sunTravels = parseVector(flag, text);
             if (*request.sunTravels == glm::vec3(0)) throw BadInput(flag, text, "is no direction");
           })
      ->type_name("X,Y,Z");
  addValue(command, "--sphere-radius", "Of the sphere light, 0.2 metres by default; 0: none",
           [&](auto& flag, auto& text) { request.sphereRadius = static_cast<float>(parseNumber(flag, text, 0, 1e6)); })
      ->type_name("M");
  addValue(command, "--sphere", "Where it hangs; absent: at four fifths of the scene's height, over its middle",
           [&](auto& flag, auto& text) { request.sphereWorld = parseVector(flag, text); })
      ->type_name("X,Y,Z");
}

void addTruth(CLI::App& command, ShadowBenchRequest& request) {
  addValue(command, "--samples", "Of the truth, for each pixel and light, 1024 by default",
           [&](auto& flag, auto& text) { request.samples = static_cast<int>(parseWhole(flag, text, 1, 1 << 20)); })
      ->type_name("N");
  addValue(command, "--truth", "Folder where traced truths are kept; absent: in the user's cache folder",
           [&](auto& flag, auto& text) {
             if (text.empty()) throw BadInput(flag, "", "names no folder");
             request.truthFolder = text;
           })
      ->type_name("DIR");
}

} // namespace

void addShadowBench(CLI::App& bench, CommandAction& chosen) {
  CLI::App& command =
      *bench.add_subcommand("shadows", "Errors against the traced truth, reads and times of all kinds of shadows");
  const auto request = std::make_shared<ShadowBenchRequest>();
  addSceneOptions(command, request->scene);
  command.add_option("MORE", request->more, "More scenes");
  addCameraOptions(command, request->camera);
  command.add_flag("--floor", request->hasFloor, "Put a floor under each scene");
  addValue(command, "--methods", "Of those that it names, comma separated; absent: all", [=](auto&, auto& text) {
    for (const std::string_view piece : splitText(text, ',')) request->methods.emplace_back(piece);
  })->type_name("NAME,...");
  addLights(command, *request);
  addTruth(command, *request);
  addValue(command, "--field-size", "Of the world field: S, M or L; M by default", [=](auto& flag, auto& text) {
    if (text != "S" && text != "M" && text != "L")
      throw BadInput(flag, fmt::format("\"{}\"", text), "is none of S, M, L");
    request->fieldSize = text;
  })->type_name("SIZE");
  addValue(command, "--shadow-bricks",
           "Voxels along a scene's longest side of the bricks that meshes get; 1024 by default",
           [=](auto& flag, auto& text) { request->brickVoxels = static_cast<int>(parseWhole(flag, text, 64, 4096)); })
      ->type_name("N");
  addValue(command, "--frames", "Frames that are timed, 10 by default", [=](auto& flag, auto& text) {
    request->frames = static_cast<int>(parseWhole(flag, text, 1, 100000));
  })->type_name("N");
  addValue(command, "--device", "EGL device by number", [=](auto& flag, auto& text) {
    request->device = static_cast<int>(parseWhole(flag, text, 0, 255));
  })->type_name("N");
  addPath(command, "--json", "The figures as .json", request->json);
  addPath(command, "--plates", "Folder for a .png of each scene: pictures and heat maps of their errors, red too light",
          request->plates);
  command.callback([request, &chosen] {
    chosen = [request] {
      runShadowBench(*request);
      return 0;
    };
  });
}

} // namespace brickfield
