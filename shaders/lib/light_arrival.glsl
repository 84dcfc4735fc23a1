// What of a light arrives at a point, as from its centre. Twin: scene/light_arrival.h.
#include "shared/frame_params.h"

// Irradiance that reaches a point facing the light, and the direction to it. Of a rectangle what would arrive were it
// radiant to all sides alike: its cosine is left to the caller.
vec3 lightAt(LightRow light, vec3 pointWorld, out vec3 toLight) {
  uint kind = uint(light.position.w);
  if (kind == LIGHT_SUN) {
    toLight = -light.direction.xyz;
    return light.intensity.rgb;
  }
  vec3 offset = light.position.xyz - pointWorld;
  float distance2 = max(dot(offset, offset), 1e-8);
  toLight = offset * inversesqrt(distance2);
  // A sphere light's candela hold for its far field; nearer than its surface nothing is defined.
  distance2 = max(distance2, light.intensity.w * light.intensity.w);
  float falloff = 1.0 / distance2;
  if (light.direction.w > 0.0) {
    // KHR_lights_punctual's window.
    float ratio2 = distance2 / (light.direction.w * light.direction.w);
    falloff *= clamp(1.0 - ratio2 * ratio2, 0.0, 1.0);
  }
  if (kind == LIGHT_SPOT) {
    float angular = clamp(dot(light.direction.xyz, -toLight) * light.cone.x + light.cone.y, 0.0, 1.0);
    falloff *= angular * angular;
  }
  return light.intensity.rgb * falloff;
}
