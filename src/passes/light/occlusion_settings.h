// How ambient occlusion is found from the world field.
#pragma once

#include <cstdint>
#include <limits>

namespace brickfield {

/// Taps: five along the normal (Evans 2006). Rays: five along each of five rays of the hemisphere (thesis 7.2.2).
/// Cones: narrow cones over the hemisphere, traced to what they meet.
enum class OcclusionForm : std::uint8_t { Off, Taps, Rays, Cones };
const char* occlusionFormName(OcclusionForm form);

struct OcclusionSettings {
  OcclusionForm form = OcclusionForm::Off;
  float radiusMetres = std::numeric_limits<float>::infinity(); ///< what is farther hides nothing; finite but for Cones
  int scale = 2; ///< traced at every so manyth pixel along both axes: 1, 2 or 4
  int cones = 8; ///< a traced pixel, 1 to 64; sixteen pixels share their directions

  bool operator==(const OcclusionSettings&) const = default;
};

/// error BadInput that names the parameter
void checkOcclusionSettings(const OcclusionSettings& settings);

} // namespace brickfield
