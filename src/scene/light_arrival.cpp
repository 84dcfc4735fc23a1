// Suns by their direction, everything else by the inverse square.
#include "scene/light_arrival.h"

#include <algorithm>
#include <limits>

#include "scene/brdf.h"

namespace brickfield {

LightArrival lightArrivalAt(const PosedLight& posed, glm::vec3 pointWorld) {
  const Light& light = posed.light;
  const glm::vec3 strength = light.color * light.intensity;
  if (light.kind == LightKind::Sun) return {-posed.directionWorld, std::numeric_limits<float>::infinity(), strength};

  const glm::vec3 offset = posed.positionWorld - pointWorld;
  const float distance = glm::length(offset);
  if (!(distance > 0.0f) || !std::isfinite(distance)) return {};
  const float radius = light.kind == LightKind::Sphere ? light.radius : 0.0f;
  LightArrival arrival{offset / distance, std::max(distance - radius, 0.0f), glm::vec3(0.0f)};
  arrival.irradiance = strength * distanceFalloff(std::max(distance, radius), light.range);
  if (light.kind == LightKind::Spot)
    arrival.irradiance *= coneFalloff(glm::dot(posed.directionWorld, -arrival.towardsLight), light.innerConeRadians,
                                      light.outerConeRadians);
  if (light.kind == LightKind::Rectangle)
    arrival.irradiance *= std::max(0.0f, glm::dot(posed.directionWorld, -arrival.towardsLight));
  if (!isFinite(arrival.irradiance)) arrival.irradiance = glm::vec3(0.0f); // 1/d² overflows at a point light itself
  return arrival;
}

} // namespace brickfield
