// What arrives at a point from one light, before anything stands in the way (KHR_lights_punctual). Twin of the light
// loop in shaders/lib.
#pragma once

#include "scene/pose.h"

namespace brickfield {

struct LightArrival {
  glm::vec3 towardsLight{0.0f}; ///< world, unit
  float distance = 0.0f;        ///< metres to the light's surface, where a shadow ray ends; infinite for suns
  glm::vec3 irradiance{0.0f};   ///< lux times colour on a surface that faces the light; zero outside cone and range
};

/// Spheres shine as points at their centre, from their surface on: no nearer than their radius. Rectangles shine from
/// their centre, by the cosine less aside and not backwards.
LightArrival lightArrivalAt(const PosedLight& light, glm::vec3 pointWorld);

} // namespace brickfield
