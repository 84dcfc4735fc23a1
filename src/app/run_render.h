// What `brickfield render` is asked, complete and checked as far as the command line alone allows, and the frame behind
// it.
#pragma once

#include <filesystem>
#include <string>

#include "app/field_choice.h"
#include "app/field_shadow_choice.h"
#include "app/occlusion_choice.h"
#include "app/options.h"
#include "app/reflection_choice.h"
#include "app/shadow_choice.h"
#include "app/translucency_choice.h"

namespace brickfield {

enum class TraceChoice { Auto, Boxes };

struct RenderRequest {
  SceneRequest scene; ///< sdf nodes by sdfNodes()
  CameraRequest camera;
  LightRequest light;           ///< by makeLighting(pose, light)
  std::filesystem::path output; ///< .png or .exr, by writePicture()
  std::filesystem::path layers; ///< .exr, by writeLayers(); empty: not asked for
  std::filesystem::path stats;  ///< .json; empty: not asked for
  int frames = 1;               ///< 1/60 s apart, the last one at the scene's time; the image is the last
  TraceChoice trace = TraceChoice::Auto;
  ShadowChoice shadows = ShadowChoice::None;
  FieldShadowChoice fieldShadows; ///< checked
  ShadowMapSettings shadowMaps;
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

/// Renders and writes everything that is asked for, the picture last.
/// error  BadInput, Failure, Cancelled; then nothing is half-written
void runRender(const RenderRequest& request);

} // namespace brickfield
