// A plain clear sky: a gradient from a pale horizon to a deeper zenith, a glow around the sun, a dim ground. Made to
// look pleasant and to light evenly, not to model the air.
#include <algorithm>

#include "scene/environment.h"

namespace brickfield {

namespace {

// Linear radiance that goes with a sun of π lux: the whole sky adds about a third of the sun's light to flat ground.
constexpr glm::vec3 kZenith(0.16f, 0.27f, 0.50f);
constexpr glm::vec3 kHorizon(0.50f, 0.57f, 0.64f);
constexpr glm::vec3 kGround(0.13f, 0.12f, 0.11f);
constexpr glm::vec3 kGlow(0.55f, 0.45f, 0.30f);
constexpr float kGlowSharpness = 24.0f;    // cosine power: half its strength at 14 degrees from the sun
constexpr float kHorizonHalfWidth = 0.04f; // in sine of elevation: about one texel row of the default size

glm::vec3 skyRadiance(glm::vec3 direction, glm::vec3 directionToSun) {
  const float elevation = direction.y;
  const float towardsZenith = std::sqrt(std::clamp(elevation, 0.0f, 1.0f));
  const float glow = std::pow(std::max(glm::dot(direction, directionToSun), 0.0f), kGlowSharpness);
  const glm::vec3 air = glm::mix(kHorizon, kZenith, towardsZenith) + glow * kGlow;
  return glm::mix(kGround, air, glm::smoothstep(-kHorizonHalfWidth, kHorizonHalfWidth, elevation));
}

} // namespace

Environment makeSky(glm::vec3 directionToSunWorld, glm::uvec2 size) {
  Environment sky;
  sky.size = size;
  sky.radiance.reserve(std::size_t{size.x} * size.y);
  for (std::uint32_t row = 0; row < size.y; ++row)
    for (std::uint32_t column = 0; column < size.x; ++column) {
      const glm::dvec2 uv((column + 0.5) / size.x, (row + 0.5) / size.y);
      sky.radiance.push_back(skyRadiance(glm::vec3(environmentDirection(uv)), directionToSunWorld));
    }
  return sky;
}

} // namespace brickfield
