// Names and ranges.
#include "passes/light/occlusion_settings.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

const char* occlusionFormName(OcclusionForm form) {
  switch (form) {
  case OcclusionForm::Off:
    return "off";
  case OcclusionForm::Taps:
    return "5tap";
  case OcclusionForm::Rays:
    return "rays";
  case OcclusionForm::Cones:
    return "cones";
  }
  return "unknown";
}

void checkOcclusionSettings(const OcclusionSettings& settings) {
  if (settings.form == OcclusionForm::Off) return;
  if (!(settings.radiusMetres > 0))
    throw BadInput("ambient occlusion", "radius", fmt::format("{} is not above 0", settings.radiusMetres));
  if (settings.form != OcclusionForm::Cones && !std::isfinite(settings.radiusMetres))
    throw BadInput("ambient occlusion", occlusionFormName(settings.form), "needs a radius to spread its taps over");
  if (settings.scale != 1 && settings.scale != 2 && settings.scale != 4)
    throw BadInput("ambient occlusion", "scale", fmt::format("{} is none of 1, 2 and 4", settings.scale));
  if (settings.cones < 1 || settings.cones > 64)
    throw BadInput("ambient occlusion", "cones", fmt::format("{} is not in [1, 64]", settings.cones));
}

} // namespace brickfield
