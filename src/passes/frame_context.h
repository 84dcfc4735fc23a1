// What every pass is handed when it records: the scene, the targets, the frame's numbers. No pass owns any of it.
#pragma once

#include <span>

#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "passes/frame_targets.h"
#include "passes/geometry/visible_draws.h"
#include "passes/light/occlusion_settings.h"
#include "passes/light/reflection_settings.h"
#include "passes/light/shadow_settings.h"
#include "passes/light/translucency_settings.h"
#include "passes/visible_boxes.h"
#include "resident/resident_scene.h"
#include "resident/world_triangles.h"
#include "scene/brdf.h"

namespace brickfield {

struct FieldFrame;
class ShadowMaps;
struct Temporal;

/// Order in which objects are drawn. Both give the same picture to the last bit: reversed, later draws win ties.
enum class DrawOrder : std::uint8_t { MeshesFirst, BoxesFirstAllReversed };

struct FrameContext {
  const ResidentScene& scene;
  FrameTargets& targets;
  const VisibleBoxes& visible;
  const Buffer& counters;     ///< COUNTERS words
  const Texture& environment; ///< prefiltered radiance, a roughness each mip
  const Texture& environmentBrdf;
  DrawOrder drawOrder = DrawOrder::MeshesFirst;
  bool countersOn = false;
  const WorldTriangles* worldTriangles = nullptr; ///< null: nobody asks for a world field
  const FieldFrame* field = nullptr;              ///< the same
  const ShadowSettings* shadows = nullptr;        ///< null: none
  bool countsShadowReads = false;                 ///< a pixel, for a view or the counters
  const Buffer* frameParams = nullptr;            ///< of the camera; bound when a pass begins
  const ShadowMaps* shadowMaps = nullptr;         ///< null: nobody asks for them
  const Temporal* temporal = nullptr;             ///< null: no temporal antialiasing
  OcclusionSettings occlusion = {};
  BrdfModel brdf = BrdfModel::CookTorrance; ///< of direct light
  TranslucencySettings translucency = {};
  ReflectionSettings reflections = {};
  std::span<const DrawRun> meshRuns = {}; ///< what the camera sees, in the order in which it is drawn
};

} // namespace brickfield
