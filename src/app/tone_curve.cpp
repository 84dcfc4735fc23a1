// Narkowicz' rational fit: (x (2.51 x + 0.03)) / (x (2.43 x + 0.59) + 0.14).
#include "app/tone_curve.h"

#include <algorithm>

namespace brickfield {

float toneCurve(float exposed) {
  if (!(exposed > 0.0f)) return 0.0f;
  // Beyond this the fit lies above 1 and only grows towards 2.51 / 2.43; larger values would overflow when squared.
  constexpr float kSurelyWhite = 1e4f;
  if (exposed > kSurelyWhite) return 1.0f;
  return std::clamp(exposed * (2.51f * exposed + 0.03f) / (exposed * (2.43f * exposed + 0.59f) + 0.14f), 0.0f, 1.0f);
}

glm::vec3 displayFromRadiance(glm::vec3 radiance, float exposureEv) {
  const glm::vec3 exposed = radiance * std::exp2(exposureEv);
  return srgbFromLinear(glm::vec3(toneCurve(exposed.x), toneCurve(exposed.y), toneCurve(exposed.z)));
}

} // namespace brickfield
