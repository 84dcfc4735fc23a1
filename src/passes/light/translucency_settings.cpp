// Ranges.
#include "passes/light/translucency_settings.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

void checkTranslucencySettings(const TranslucencySettings& settings) {
  if (!(settings.wrap >= 0 && settings.wrap <= 1))
    throw BadInput("translucency", "wrap", fmt::format("{} is not in [0, 1]", settings.wrap));
  if (!(settings.share >= 0 && settings.share <= 1))
    throw BadInput("translucency", "share", fmt::format("{} is not in [0, 1]", settings.share));
  for (int c = 0; c < 3; ++c)
    if (!(settings.absorption[c] >= 0) || !std::isfinite(settings.absorption[c]))
      throw BadInput("translucency", "absorption", fmt::format("{} is not in [0, inf)", settings.absorption[c]));
}

} // namespace brickfield
