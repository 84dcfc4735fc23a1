// How surfaces mirror what stands around.
#pragma once

#include <cstdint>

namespace brickfield {

/// Field: one cone a pixel through the world field and, beside surfaces, the bricks of objects.
enum class ReflectionMethod : std::uint8_t { Off, Field };
/// "off", "field"
const char* reflectionMethodName(ReflectionMethod method);

struct ReflectionSettings {
  ReflectionMethod method = ReflectionMethod::Off;
  int scale = 2; ///< traced at every so manyth pixel along both axes: 1, 2 or 4

  bool operator==(const ReflectionSettings&) const = default;
};

/// error BadInput that names the parameter
void checkReflectionSettings(const ReflectionSettings& settings);

} // namespace brickfield
