// The views that there are, and what goes together.
#include "renderer/settings.h"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

const char* sdfTracingName(SdfTracing tracing) { return tracing == SdfTracing::Boxes ? "boxes" : "tiles"; }

namespace {

constexpr int kLeastFieldTexels = 16, kMostFieldTexels = 512;

void checkShape(const FieldShape& shape) {
  if (shape.cascades < 1 || shape.cascades > static_cast<int>(shared::MOST_CASCADES))
    throw BadInput("world field", "cascades", fmt::format("{} is not in [1, 8]", shape.cascades));
  if (shape.texels < kLeastFieldTexels || shape.texels > kMostFieldTexels ||
      !std::has_single_bit(static_cast<unsigned>(shape.texels)))
    throw BadInput(
        "world field", "texels",
        fmt::format("{} is no power of two from {} to {}", shape.texels, kLeastFieldTexels, kMostFieldTexels));
  if (!(shape.texelSize >= 0) || !std::isfinite(shape.texelSize))
    throw BadInput("world field", "texel size", fmt::format("{} is not in [0, inf)", shape.texelSize));
}

void checkFieldView(const DebugView& view, const RendererSettings& settings) {
  const FieldSettings& field = settings.worldField;
  if (field.method == FieldMethod::Off) throw BadInput("view", view.name, "shows the world field, which is off");
  if (view.isExactOnly && field.method != FieldMethod::Exact)
    throw BadInput("view", view.name, "is of the exact world field; rtsdf knows nothing of it");
  const int cascades = field.method == FieldMethod::Exact && !field.shape.isWhole ? field.shape.cascades : 1;
  if (settings.fieldSlice.cascade >= cascades)
    throw BadInput("view", view.name,
                   fmt::format("shows cascade {} of a world field that has {}, counted from 0",
                               settings.fieldSlice.cascade, cascades));
}

} // namespace

const char* fieldMethodName(FieldMethod method) {
  switch (method) {
  case FieldMethod::Off:
    return "off";
  case FieldMethod::Exact:
    return "exact";
  case FieldMethod::Rtsdf:
    return "rtsdf";
  }
  return "unknown";
}

const std::vector<DebugView>& debugViews() {
  constexpr float kStepsRange = 64, kOverdrawRange = 16, kReadsRange = 128, kMotionRange = 16, kTaaRange = 64;
  static const std::vector<DebugView> views{
      {"depth", "distance from the eye, near is bright", shared::DEBUG_VIEW_DEPTH},
      {"normal", "shading normal in world space, -1..1 as 0..1", shared::DEBUG_VIEW_NORMAL},
      {"albedo", "base colour", shared::DEBUG_VIEW_ALBEDO},
      {"id", "a colour for each node", shared::DEBUG_VIEW_ID},
      {"kind", "blue: mesh, orange: SDF object", shared::DEBUG_VIEW_KIND},
      {"steps", fmt::format("trace steps of the visible SDF object, blue 0 to red {}", kStepsRange),
       shared::DEBUG_VIEW_STEPS, kStepsRange},
      {"bricks", "a colour for each brick in which a ray ended", shared::DEBUG_VIEW_BRICKS},
      {"overdraw", fmt::format("box fragments of SDF objects at each pixel, blue 0 to red {}", kOverdrawRange),
       shared::DEBUG_VIEW_OVERDRAW, kOverdrawRange},
      {"field", "a plane through the world field: blue outside, orange inside, black zero, a line every four texels",
       shared::DEBUG_VIEW_FIELD, 0, true, true, false},
      {"field-id", "the same plane: a colour for the nearest node, grey where neighbours differ",
       shared::DEBUG_VIEW_FIELD_ID, 0, true, true, true},
      {"field-tiles",
       "the same plane: tiles of this frame, surfaces crimson, reached yellow, SDF objects green, kept grey",
       shared::DEBUG_VIEW_FIELD_TILES, 0, true, true, true},
      {"field-surface", "the world field's own surface from the camera, traced in it alone",
       shared::DEBUG_VIEW_FIELD_SURFACE, 0, true, false, false},
      {"shadow", "visible shares of the first three lights, a channel each; of one light alone as grey",
       shared::DEBUG_VIEW_SHADOW, 0, false, false, false, true},
      {"shadow-reads", fmt::format("distances read for the shadows at each pixel, blue 0 to red {}", kReadsRange),
       shared::DEBUG_VIEW_SHADOW_READS, kReadsRange, false, false, false, true},
      {"shadow-map", "the shadow maps of the first light side by side, near to the light bright",
       shared::DEBUG_VIEW_SHADOW_MAP, 0, false, false, false, false, true},
      {"shadow-cascade", "a colour for the shadow map that answers, in fields of eight of its texels; grey: none",
       shared::DEBUG_VIEW_SHADOW_CASCADE, 0, false, false, false, false, true},
      {"motion",
       fmt::format("motion vectors, pixels a frame: red {} and more to the right, green upwards", kMotionRange),
       shared::DEBUG_VIEW_MOTION, kMotionRange, false, false, false, false, false, true},
      {"taa-frames", fmt::format("frames in each pixel's average, blue 0 to red {}", kTaaRange),
       shared::DEBUG_VIEW_TAA_FRAMES, kTaaRange, false, false, false, false, false, true},
      {"thickness",
       "metres of the SDF object that the view ray crosses, as heat up to a quarter of the scene's diagonal",
       shared::DEBUG_VIEW_THICKNESS},
      {"reflection", "what smooth surfaces mirror by --reflections, as bright as it is", shared::DEBUG_VIEW_REFLECTION},
      {"ao", "ambient occlusion by --ao: white open, black hidden", shared::DEBUG_VIEW_AO},
  };
  return views;
}

const DebugView* findView(const std::string& name) {
  for (const DebugView& view : debugViews())
    if (view.name == name) return &view;
  return nullptr;
}

namespace {

void checkShadows(const ShadowSettings& shadows) {
  if (shadows.penumbraRays < 1 || shadows.penumbraRays > 64)
    throw BadInput("shadows", fmt::format("{} rays", shadows.penumbraRays), "is not 1 to 64");
  if (!(shadows.softness >= 0 && shadows.softness <= 4))
    throw BadInput("shadows", fmt::format("softness {}", shadows.softness), "is not 0 to 4");
  if (!(shadows.mostStep > 0) || !std::isfinite(shadows.mostStep))
    throw BadInput("shadows", fmt::format("step {}", shadows.mostStep), "is not above 0");
}

void checkShadowView(const DebugView& view, const RendererSettings& settings) {
  const ShadowMethod method = settings.shadows.method;
  if (view.needsShadows && method == ShadowMethod::None)
    throw BadInput("view", settings.view, "shows shadows, of which there are none; --shadows field makes some");
  if (view.number == shared::DEBUG_VIEW_SHADOW_READS && !marchesField(method))
    throw BadInput("view", settings.view, "shows what --shadows field reads");
  if (view.readsShadowMaps && !drawsMaps(method))
    throw BadInput("view", settings.view, "shows shadow maps, which --shadows csm makes");
  if (view.readsTemporal && !settings.taa.on) throw BadInput("view", settings.view, "shows what --taa on keeps");
}

} // namespace

void checkSettings(const RendererSettings& settings) {
  checkShape(settings.worldField.shape);
  checkRtsdfSettings(settings.worldField.rtsdf);
  if (marchesField(settings.shadows.method) && settings.worldField.method == FieldMethod::Off)
    throw BadInput("shadows", "field", "needs a world field, which is off");
  checkShadows(settings.shadows);
  if (settings.shadowMaps.size < kLeastShadowTexels || settings.shadowMaps.size > kMostShadowTexels)
    throw BadInput("shadow maps", fmt::format("size {}", settings.shadowMaps.size),
                   fmt::format("is not {} to {}", kLeastShadowTexels, kMostShadowTexels));
  if (!(settings.taa.sharpness >= 0 && settings.taa.sharpness <= 1))
    throw BadInput("taa", fmt::format("sharpness {}", settings.taa.sharpness), "is not in [0, 1]");
  if (!(settings.taa.shutter >= 0 && settings.taa.shutter <= 1))
    throw BadInput("taa", fmt::format("shutter {}", settings.taa.shutter), "is not in [0, 1]");
  checkOcclusionSettings(settings.occlusion);
  checkTranslucencySettings(settings.translucency);
  checkReflectionSettings(settings.reflections);
  if (settings.reflections.method == ReflectionMethod::Field && settings.worldField.method != FieldMethod::Exact)
    throw BadInput("reflections", "field", "needs the exact world field, which knows who is nearest");
  if (settings.occlusion.form != OcclusionForm::Off && settings.worldField.method == FieldMethod::Off)
    throw BadInput("ambient occlusion", occlusionFormName(settings.occlusion.form),
                   "needs a world field, which is off");
  if (settings.view.empty()) return;
  const DebugView* view = findView(settings.view);
  if (!view) throw BadInput("view", settings.view, "no such view");
  checkShadowView(*view, settings);
  if (view->readsField) checkFieldView(*view, settings);
  if (view->number == shared::DEBUG_VIEW_AO && settings.occlusion.form == OcclusionForm::Off)
    throw BadInput("view", view->name, "shows ambient occlusion, which is off");
  if (view->number == shared::DEBUG_VIEW_THICKNESS && settings.translucency.source == TranslucencySource::Off)
    throw BadInput("view", view->name, "shows what translucency finds, which is off");
  if (view->number == shared::DEBUG_VIEW_REFLECTION && settings.reflections.method == ReflectionMethod::Off)
    throw BadInput("view", view->name, "shows reflections, which are off");
}

} // namespace brickfield
