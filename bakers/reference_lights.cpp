// Directions in the cone of a sun or a sphere, points of a rectangle.
#include "bakers/reference_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bakers/reference_samples.h"
#include "scene/brdf.h"

namespace brickfield {

namespace {

/// 1 - cos of an angle from its sine, without the cancellation of small ones.
float oneMinusCosine(float sine) { return sine * sine / (1.0f + std::sqrt(std::max(0.0f, 1.0f - sine * sine))); }

/// What uniform directions of a cap bring for the irradiance E that faces its axis: L times the solid angle, with
/// L = E / (π sin²) and a solid angle of 2 π (1 - cos), is 2 E / (1 + cos).
float strengthOfCap(float capHeight) { return 2.0f / (2.0f - capHeight); }

LightArrival sampleSun(const PosedLight& sun, glm::vec2 square) {
  const float halfAngle = 0.5f * sun.light.angleRadians;
  const float capHeight = oneMinusCosine(std::sin(halfAngle));
  return {directionOfCap(basisAround(-sun.directionWorld), capHeight, square), std::numeric_limits<float>::infinity(),
          sun.light.color * sun.light.intensity * strengthOfCap(capHeight)};
}

LightArrival sampleSphere(const PosedLight& sphere, glm::vec3 pointWorld, glm::vec2 square) {
  LightArrival arrival = lightArrivalAt(sphere, pointWorld);
  const glm::vec3 offset = sphere.positionWorld - pointWorld;
  const float distance = glm::length(offset), radius = sphere.light.radius;
  if (!(distance > radius) || !std::isfinite(distance)) return arrival;
  const float sine = radius / distance, capHeight = oneMinusCosine(sine);
  arrival.irradiance *= strengthOfCap(capHeight);
  const glm::vec3 axis = arrival.towardsLight;
  arrival.towardsLight = directionOfCap(basisAround(axis), capHeight, square);
  // The nearer crossing of the sphere; at the rim of its outline the root is 0, or a rounding below.
  const float along = glm::dot(axis, arrival.towardsLight);
  const float root = std::sqrt(std::max(0.0f, sine * sine - (1.0f - along * along)));
  arrival.distance = distance * std::max(0.0f, along - root);
  return arrival;
}

LightArrival sampleRectangle(const PosedLight& rectangle, glm::vec3 pointWorld, glm::vec2 square) {
  const glm::vec3 up = glm::cross(rectangle.rightWorld, rectangle.directionWorld);
  const glm::vec2 place = (square - 0.5f) * rectangle.light.size;
  // L A cos / d² with L = I / A: the arrival from a point of the same front.
  PosedLight element = rectangle;
  element.positionWorld += place.x * rectangle.rightWorld + place.y * up;
  LightArrival arrival = lightArrivalAt(element, pointWorld);
  // A panel may lie in the very plane of a ceiling, which must not shadow it by rounding.
  constexpr float kShortOfPanel = 1.0f - 1e-4f;
  arrival.distance *= kShortOfPanel;
  return arrival;
}

} // namespace

bool hasExtent(const Light& light) {
  if (light.kind == LightKind::Sun) return light.angleRadians > 0.0f;
  if (light.kind == LightKind::Sphere) return light.radius > 0.0f;
  return light.kind == LightKind::Rectangle && light.size != glm::vec2(0.0f);
}

LightArrival sampleLight(const PosedLight& light, glm::vec3 pointWorld, glm::vec2 square) {
  if (!hasExtent(light.light)) return lightArrivalAt(light, pointWorld);
  if (light.light.kind == LightKind::Sun) return sampleSun(light, square);
  if (light.light.kind == LightKind::Sphere) return sampleSphere(light, pointWorld, square);
  return sampleRectangle(light, pointWorld, square);
}

} // namespace brickfield
