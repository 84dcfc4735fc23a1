// Names and ranges.
#include "passes/light/reflection_settings.h"

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

const char* reflectionMethodName(ReflectionMethod method) {
  return method == ReflectionMethod::Field ? "field" : "off";
}

void checkReflectionSettings(const ReflectionSettings& settings) {
  if (settings.scale != 1 && settings.scale != 2 && settings.scale != 4)
    throw BadInput("reflections", "scale", fmt::format("{} is none of 1, 2 and 4", settings.scale));
}

} // namespace brickfield
