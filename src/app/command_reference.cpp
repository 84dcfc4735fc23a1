// The renderer's camera, lights and materials on the CPU: what its pictures are measured against.
#ifdef BRICKFIELD_BAKERS
#include "app/command_reference.h"

#include <CLI/CLI.hpp>

#include "app/image_io.h"
#include "app/layers_io.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/progress_bar.h"
#include "app/session.h"
#include "app/shadow_choice.h"
#include "bakers/reference.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

struct ReferenceOptions {
  SceneRequest scene;
  CameraRequest camera;
  LightRequest light;
  std::filesystem::path output;
  std::filesystem::path layers;
  ShadowChoice shadows = ShadowChoice::Traced;
  float exposureEv = 0;
  int samples = 1;
};

int reference(const ReferenceOptions& options) {
  const std::vector<OutputPath> outputs{{"-o", options.output, {".exr", ".png"}},
                                        {"--layers", options.layers, {".exr"}}};
  checkOutputs(outputs, {options.scene.path, options.light.environment});
  checkCamera(options.camera);
  checkInputPath(options.scene.path, {".gltf", ".glb"});
  const Scene scene = importGltf(options.scene.path);
  checkSceneFiles(scene, outputs);
  const Pose pose = poseScene(scene, options.scene.pose);
  const View view = makeView(scene, pose, options.camera);
  const Lighting lighting = makeLighting(pose, options.light);
  const auto sdf = sdfNodes(scene, options.scene.sdf, options.scene.threads);
  printWarnings(scene);

  ReferenceRequest request;
  request.scene = &scene;
  request.pose = &pose;
  request.view = &view;
  request.lighting = &lighting;
  request.isSdf = [&](int node) { return node >= 0 && sdf[static_cast<std::size_t>(node)].has_value(); };
  request.shadows = options.shadows == ShadowChoice::Traced;
  request.samples = options.samples;
  request.seed = options.scene.seed;
  request.threads = options.scene.threads;
  FrameLayers layers;
  {
    ProgressBar bar;
    layers = traceReference(request, bar.progress());
  }
  throwIfInterrupted();
  if (!options.layers.empty()) writeLayers(options.layers, layers);
  writePicture(options.output, {layers.size, layers.color}, options.exposureEv);
  return 0;
}

void addOptions(CLI::App& command, ReferenceOptions& options) {
  addSceneOptions(command, options.scene);
  command.footer("--resolution and --cache are taken so that one set of scene flags serves render and reference; here "
                 "they change nothing, because the source triangles are traced.");
  addPath(command, "-o,--output", "The picture: .exr (linear radiance) or .png (exposed, tone-mapped)", options.output)
      ->required();
  addCameraOptions(command, options.camera);
  addLightOptions(command, options.light);
  addReferenceShadows(command, options.shadows);
  addExposureOption(command, options.exposureEv);
  addValue(command, "--samples", "Rays a pixel, 1 to 65536; the first goes through its centre",
           [&](auto& flag, auto& text) { options.samples = static_cast<int>(parseWhole(flag, text, 1, 65536)); })
      ->type_name("N");
  addPath(command, "--layers", "Depth, normals, ids and more as one multi-part .exr", options.layers);
}

} // namespace

void addReferenceCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command = *program.add_subcommand("reference", "Trace a scene's triangles on the CPU to the same picture");
  const auto options = std::make_shared<ReferenceOptions>();
  addOptions(command, *options);
  command.callback([options, &chosen] { chosen = [options] { return reference(*options); }; });
}

} // namespace brickfield
#endif
