// The flags of `render`; the outputs are checked before anything is read.
#include "app/command_render.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/image_io.h"
#include "app/parse.h"
#include "app/run_render.h"
#include "core/error.h"
#include "renderer/settings.h"

namespace brickfield {

namespace {

TraceChoice parseTrace(const std::string& flag, const std::string& text) {
  if (text == "auto") return TraceChoice::Auto;
  if (text == "boxes") return TraceChoice::Boxes;
  if (text == "tiles") return TraceChoice::Tiles;
  throw BadInput(flag, fmt::format("\"{}\"", text), "is not auto, boxes or tiles");
}

void checkView(const std::string& view) {
  if (view.empty() || findAnyView(view)) return;
  throw BadInput("--view", fmt::format("\"{}\"", view), "is no view; \"brickfield list views\" names them");
}

int render(RenderRequest& request) {
  checkOutputs(outputsOf(request), {request.scene.path, request.light.environment});
  settleFrameOptions(request);
  runRender(request);
  return 0;
}

} // namespace

void settleFrameOptions(RenderRequest& request) {
  checkCamera(request.camera);
  checkView(request.view);
  settleFieldChoice(request.field, request.view, request.scene.seed);
  checkFieldShadowChoice(request.fieldShadows, marchesField(shadowMethodOf(request.shadows)),
                         request.field.settings.method == FieldMethod::Exact);
  checkShadowMapChoice(request.shadowMaps, request.shadows);
  settleOcclusionChoice(request.occlusion, request.view, request.field.settings.method != FieldMethod::Off);
  if (request.taa.shutter > 0 && !request.taa.on)
    throw BadInput("--motion-blur", "", "needs --taa on, which finds what moves");
  settleTranslucencyChoice(request.translucency, request.view);
  checkReflectionChoice(request.reflections, request.view, request.field.settings.method == FieldMethod::Exact);
  checkInputPath(request.scene.path, {".gltf", ".glb"});
}

void addFrameOptions(CLI::App& command, RenderRequest& request) {
  addSceneOptions(command, request.scene);
  addCameraOptions(command, request.camera);
  addLightOptions(command, request.light);
  addBrdfOption(command, request.brdf);
  addExposureOption(command, request.exposureEv);
  addValue(command, "--frames", "Frames 1/60 s apart that end at --time; the picture is the last",
           [&](auto& flag, auto& text) { request.frames = static_cast<int>(parseWhole(flag, text, 1, 100000)); })
      ->type_name("N");
  addValue(
      command, "--trace",
      "How SDF objects are found: boxes (fragments of their boxes, the default), tiles (of pixels, in compute), or "
      "auto: whichever draws a small picture faster",
      [&](auto& flag, auto& text) { request.trace = parseTrace(flag, text); })
      ->type_name("WAY");
  addFieldOptions(command, request.field);
  addRenderShadows(command, request.shadows);
  addFieldShadowOptions(command, request.fieldShadows);
  addShadowMapOptions(command, request.shadowMaps);
  addValue(command, "--taa", "Temporal antialiasing, on or off (the default); give it --frames",
           [&](auto& flag, auto& text) {
             if (text != "on" && text != "off")
               throw BadInput(flag, fmt::format("\"{}\"", text), "is neither on nor off");
             request.taa.on = text == "on";
           })
      ->type_name("SWITCH");
  addValue(command, "--sharpness", "Of temporal antialiasing, 0 (the default) to 1", [&](auto& flag, auto& text) {
    request.taa.sharpness = static_cast<float>(parseNumber(flag, text, 0, 1));
  })->type_name("S");
  addValue(command, "--motion-blur",
           "Smears what moves over this share of the time between two frames, 0 (the default) to 1; with --taa on",
           [&](auto& flag, auto& text) { request.taa.shutter = static_cast<float>(parseNumber(flag, text, 0, 1)); })
      ->type_name("SHARE");
  addOcclusionOptions(command, request.occlusion);
  addTranslucencyOptions(command, request.translucency);
  addReflectionOptions(command, request.reflections);
  addName(command, "--view", "A debug view instead of the picture; see \"brickfield list views\"", request.view);
  addValue(command, "--device", "EGL device by number, see \"brickfield list devices\"; absent: the first that works",
           [&](auto& flag, auto& text) { request.device = static_cast<int>(parseWhole(flag, text, 0, 255)); })
      ->type_name("N");
}

void addRenderCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("render", "Draw a scene to a picture");
  const auto request = std::make_shared<RenderRequest>();
  addFrameOptions(command, *request);
  addPath(command, "-o,--output", "The picture: .png (exposed, tone-mapped) or .exr (linear radiance)", request->output)
      ->required();
  addPath(command, "--layers", "Depth, normals, ids and more as one multi-part .exr", request->layers);
  addPath(command, "--stats", "Times, counts and memory as .json", request->stats);
  command.callback([request, &chosen] { chosen = [request] { return render(*request); }; });
}

} // namespace brickfield
