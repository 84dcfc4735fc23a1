// What a frame can be asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "field/field_windows.h"
#include "passes/frame_context.h"
#include "passes/light/shadow_maps.h"
#include "passes/light/shadow_settings.h"
#include "passes/post/temporal.h"
#include "passes/world_field/rtsdf_settings.h"
#include "scene/brdf.h"

namespace brickfield {

/// How the world field is made: by exact distances, as the RTSDF paper does, or not at all.
enum class FieldMethod : std::uint8_t { Off, Exact, Rtsdf };
const char* fieldMethodName(FieldMethod method);

/// The world field is made in the frames that read it. Today those are the views of it; any other frame pays nothing
/// for it, unless `always` is set.
struct FieldSettings {
  FieldMethod method = FieldMethod::Exact;
  bool always = false;
  FieldShape shape;    ///< of the exact field
  RtsdfSettings rtsdf; ///< one volume around the scene; its triangles alone, no SDF objects

  bool operator==(const FieldSettings&) const = default;
};

/// What the views of the world field's cuts show.
struct FieldSlice {
  int axis = 1;                        ///< the plane's normal: 0 x, 1 y, 2 z
  std::optional<double> positionWorld; ///< metres along it; nothing: through the middle of the scene
  int cascade = -1;                    ///< its whole window; -1: the finest at each point, the scene's bounds
};

/// How SDF objects are found: by fragments of their boxes, or by tiles of pixels in compute. Both draw the same
/// surfaces; which is faster is the GPU's to say.
enum class SdfTracing : std::uint8_t { Boxes, Tiles };
const char* sdfTracingName(SdfTracing tracing);

struct RendererSettings {
  float exposureEv = 0;               ///< stops; at 0 a white diffuse surface under π lux has radiance 1
  std::uint32_t maxTraceSteps = 2048; ///< of a ray in one object; running out is a miss and is counted
  int forcedLevel = -1;               ///< level that all SDF objects show; -1: by the size of a voxel on screen
  DrawOrder drawOrder = DrawOrder::MeshesFirst;
  SdfTracing sdfTracing = SdfTracing::Boxes; ///< boxes where they are drawn first
  bool countersOn = false;                   ///< counts fragments, steps and brick reads; slower
  std::string view;                          ///< one of debugViews(); empty: the lit picture
  ShadowSettings shadows;                    ///< those that march make a world field in each frame
  ShadowMapSettings shadowMaps;              ///< where the method draws maps
  TaaSettings taa;
  OcclusionSettings occlusion; ///< as the shadows: any form makes a world field in each frame
  TranslucencySettings translucency;
  ReflectionSettings reflections;           ///< as the shadows
  BrdfModel brdf = BrdfModel::CookTorrance; ///< that answers direct light
  FieldSettings worldField;
  FieldSlice fieldSlice;
};

/// A picture of one layer, as `--view` and `list views` name it.
struct DebugView {
  std::string name;
  std::string meaning;
  std::uint32_t number;    ///< DEBUG_VIEW_*
  float redAt = 0;         ///< count that is shown as the heat scale's end; 0: no counts
  bool readsField = false; ///< a view of the world field
  bool isSlice = false;    ///< that cuts it by FieldSlice
  bool isExactOnly = false;
  bool needsShadows = false; ///< shows them or what they cost
  bool readsShadowMaps = false;
  bool readsTemporal = false;
};
const std::vector<DebugView>& debugViews();
/// Null: no such view, or none.
const DebugView* findView(const std::string& name);

/// error BadInput, which names view or parameter: an unknown view; a view of a field that is off, or of what its method
/// does not know; a cascade, size or count out of range
void checkSettings(const RendererSettings& settings);

} // namespace brickfield
