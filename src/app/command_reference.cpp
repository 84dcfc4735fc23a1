// The renderer's camera, lights and materials on the CPU: what its pictures are measured against.
#ifdef BRICKFIELD_BAKERS
#include "app/command_reference.h"

#include <CLI/CLI.hpp>

#include "app/image_io.h"
#include "app/layers_io.h"
#include "app/occlusion_choice.h"
#include "app/options.h"
#include "app/parse.h"
#include "app/progress_bar.h"
#include "app/scene_fields.h"
#include "app/session.h"
#include "app/shadow_choice.h"
#include "bakers/reference.h"
#include "core/error.h"
#include "scene/gltf_import.h"

namespace brickfield {

namespace {

enum class SdfTrace { Unsaid, Meshes, Fields };

struct ReferenceOptions {
  SceneRequest scene;
  CameraRequest camera;
  LightRequest light;
  std::filesystem::path output;
  std::filesystem::path layers;
  ShadowChoice shadows = ShadowChoice::Traced;
  SdfTrace sdfTrace = SdfTrace::Unsaid;
  bool ambientOcclusion = false;
  std::optional<float> ambientOcclusionMetres;
  int reflections = 0;
  BrdfModel brdf = BrdfModel::CookTorrance;
  float exposureEv = 0;
  std::optional<int> samples;
};

/// Enough to judge soft shadows by eye; pictures without anything soft keep the one ray through each pixel's centre
/// that a rasterizer takes, so that they compare with its pictures.
int samplesOf(const ReferenceOptions& options) {
  constexpr int kSoftSamples = 16;
  const bool isSoft = options.shadows == ShadowChoice::Traced || options.ambientOcclusion || options.reflections > 0;
  return options.samples.value_or(isSoft ? kSoftSamples : 1);
}

void checkOptions(const ReferenceOptions& options) {
  checkCamera(options.camera);
  if (options.ambientOcclusionMetres && !options.ambientOcclusion) throw BadInput("--ao-radius", "", "needs --ao");
}

bool tracesFields(const ReferenceOptions& options) {
  if (options.sdfTrace == SdfTrace::Unsaid) return !options.scene.sdf.patterns.empty();
  return options.sdfTrace == SdfTrace::Fields;
}

int reference(const ReferenceOptions& options) {
  const std::vector<OutputPath> outputs{{"-o", options.output, {".exr", ".png"}},
                                        {"--layers", options.layers, {".exr"}}};
  checkOutputs(outputs, {options.scene.path, options.light.environment});
  checkOptions(options);
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
  request.shadows = options.shadows != ShadowChoice::None;
  request.lightsFromCentres = options.shadows == ShadowChoice::Hard;
  request.samples = samplesOf(options);
  request.seed = options.scene.seed;
  request.threads = options.scene.threads;
  request.brdf = options.brdf;
  request.reflections = options.reflections;
  request.shadowLayers = !options.layers.empty();
  if (options.ambientOcclusion)
    request.ambientOcclusionMetres = options.ambientOcclusionMetres.value_or(std::numeric_limits<float>::infinity());
  SceneFieldsResult baked;
  FrameLayers layers;
  {
    ProgressBar bar;
    if (tracesFields(options)) {
      const std::filesystem::path cache = options.scene.cacheFolder ? *options.scene.cacheFolder : defaultCacheFolder();
      baked = bakeSceneFields(scene, pose, sdf, cache, bar.progress());
      baked.fields.triplanarOfNode = triplanarNodes(scene, options.scene.sdf);
      request.fields = {&baked.fields.fields, &baked.fields.fieldOfNode, &baked.fields.triplanarOfNode};
    } else {
      request.isSdf = [&](int node) { return node >= 0 && sdf[static_cast<std::size_t>(node)].has_value(); };
    }
    layers = traceReference(request, bar.progress());
  }
  throwIfInterrupted();
  for (const std::string& warning : baked.warnings) printWarning(warning);
  if (!options.layers.empty()) writeLayers(options.layers, layers);
  writePicture(options.output, {layers.size, layers.color}, options.exposureEv);
  return 0;
}

void addTraceOptions(CLI::App& command, ReferenceOptions& options) {
  addReferenceShadows(command, options.shadows);
  command.add_flag("--ao", options.ambientOcclusion,
                   "Ambient occlusion: what stands around dims the environment's light; its own layer");
  addOcclusionRadius(command, options.ambientOcclusionMetres);
  addValue(
      command, "--reflections",
      "So often is a ray mirrored, 0 to 64; what it meets then mirrors the surroundings alone, as all does with 0, "
      "the default; render --reflections field is like 1",
      [&](auto& flag, auto& text) { options.reflections = static_cast<int>(parseWhole(flag, text, 0, 64)); })
      ->type_name("N");
  addValue(command, "--sdf-as",
           "field: SDF objects as their own bricks; mesh: as the triangles that these were baked from, only marked in "
           "the layers; absent: field where --sdf names objects, mesh where the scene's extras alone do",
           [&](auto& flag, auto& text) {
             if (text != "field" && text != "mesh")
               throw BadInput(flag, "\"" + text + "\"", "is none of field and mesh");
             options.sdfTrace = text == "field" ? SdfTrace::Fields : SdfTrace::Meshes;
           })
      ->type_name("WHAT");
  addValue(command, "--samples",
           "Of a pixel, of each light, of the hemisphere and of lobes, 1 to 65536; absent: 16, or 1 where --shadows is "
           "none or hard and neither --ao nor --reflections asks for more; 1 goes through the pixel's centre",
           [&](auto& flag, auto& text) { options.samples = static_cast<int>(parseWhole(flag, text, 1, 65536)); })
      ->type_name("N");
}

void addOptions(CLI::App& command, ReferenceOptions& options) {
  addSceneOptions(command, options.scene);
  command.footer("--resolution, --memory and --cache serve SDF objects that are traced as fields.");
  addPath(command, "-o,--output", "The picture: .exr (linear radiance) or .png (exposed, tone-mapped)", options.output)
      ->required();
  addCameraOptions(command, options.camera);
  addLightOptions(command, options.light);
  addTraceOptions(command, options);
  addBrdfOption(command, options.brdf);
  addExposureOption(command, options.exposureEv);
  addPath(command, "--layers", "Depth, normals, ids, shadows and more as one multi-part .exr", options.layers);
}

} // namespace

void addReferenceCommand(CLI::App& program, CommandAction& chosen) {
  CLI::App& command =
      *program.add_subcommand("reference", "Trace a scene on the CPU to the same picture, with soft shadows");
  const auto options = std::make_shared<ReferenceOptions>();
  addOptions(command, *options);
  command.callback([options, &chosen] { chosen = [options] { return reference(*options); }; });
}

} // namespace brickfield
#endif
