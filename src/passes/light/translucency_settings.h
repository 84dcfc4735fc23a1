// How light passes through SDF objects.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace brickfield {

/// Materials: as KHR_materials_diffuse_transmission and KHR_materials_volume of each object's first material say.
/// Given: all objects alike.
enum class TranslucencySource : std::uint8_t { Off, Materials, Given };

struct TranslucencySettings {
  TranslucencySource source = TranslucencySource::Off;
  float share = 0;            ///< Given: of the diffuse light that passes, 0 to 1
  glm::vec3 absorption{0.0f}; ///< Given: per metre
  float wrap = 0;             ///< 0 to 1: how far round the light of the back reaches to the front; 0 as glTF says

  bool operator==(const TranslucencySettings&) const = default;
};

/// error BadInput that names the parameter
void checkTranslucencySettings(const TranslucencySettings& settings);

} // namespace brickfield
