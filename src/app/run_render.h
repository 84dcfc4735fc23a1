// What `brickfield render` is asked, complete and checked as far as the command line alone allows, and the frame behind
// it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/field_choice.h"
#include "app/field_shadow_choice.h"
#include "app/occlusion_choice.h"
#include "app/options.h"
#include "app/reflection_choice.h"
#include "app/scene_fields.h"
#include "app/shadow_choice.h"
#include "app/translucency_choice.h"
#include "gpu/context.h"
#include "renderer/renderer.h"

namespace brickfield {

enum class TraceChoice { Boxes, Tiles, Auto };

struct RenderRequest {
  SceneRequest scene; ///< sdf nodes by sdfNodes()
  CameraRequest camera;
  LightRequest light;           ///< by makeLighting(pose, light)
  std::filesystem::path output; ///< .png or .exr, by writePicture()
  std::filesystem::path layers; ///< .exr, by writeLayers(); empty: not asked for
  std::filesystem::path stats;  ///< .json; empty: not asked for
  int frames = 1;               ///< 1/60 s apart, the last one at the scene's time; the image is the last
  TraceChoice trace = TraceChoice::Boxes;
  ShadowChoice shadows = ShadowChoice::None;
  FieldShadowChoice fieldShadows; ///< checked
  ShadowMapChoice shadowMaps;
  TaaSettings taa;
  OcclusionChoice occlusion;       ///< settled
  TranslucencyChoice translucency; ///< settled
  ReflectionChoice reflections;    ///< checked
  FieldChoice field;               ///< settled
  BrdfModel brdf = BrdfModel::CookTorrance;
  float exposureEv = 0;
  std::string view; ///< one of debugViews(); empty: the lit picture
  int device = -1;  ///< -1: the first that works
};

std::vector<OutputPath> outputsOf(const RenderRequest& request);

/// A scene with all that drawing it needs, on a context of its own that is current.
struct LoadedRender {
  Scene scene;
  Pose pose; ///< of the last frame, as what follows
  View view;
  Lighting lighting;
  std::unique_ptr<Context> context;
  SceneFieldsResult baked;
  double loadSeconds = 0, bakeSeconds = 0;
};
/// Everything that may be refused is refused before the bake.
/// error  BadInput, Failure, Cancelled
LoadedRender loadRender(const RenderRequest& request, const std::vector<OutputPath>& outputs);

RendererSettings rendererSettingsOf(const RenderRequest& request);

/// Sets pose and light of one of the request's frames, 0 to frames - 1, and draws it.
void drawFrame(const RenderRequest& request, const LoadedRender& loaded, int frame, Renderer& renderer);

/// Makes of TraceChoice::Auto what draws the last frame's surfaces faster, in a small picture; Boxes where nothing is
/// an SDF object. Leaves the renderer with other settings and pose.
void settleTrace(RenderRequest& request, const LoadedRender& loaded, Renderer& renderer);

/// Counts of a frame like the last one. Counting slows drawing down, so it is drawn once more for it.
FrameStats countFrame(const RenderRequest& request, const View& view, Renderer& renderer);

/// Renders and writes everything that is asked for, the picture last.
/// error  BadInput, Failure, Cancelled; then nothing is half-written
void runRender(RenderRequest request);

} // namespace brickfield
