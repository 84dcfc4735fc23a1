// Which lights shine on a frame.
#include "scene/lighting.h"

#include <algorithm>
#include <numbers>

#include "scene/light_texts.h"

namespace brickfield {

namespace {

/// From the upper left, behind the viewer of "auto". π lux give a white diffuse surface that faces it radiance 1.
PosedLight defaultSun() {
  PosedLight sun;
  sun.light.name = "default sun";
  sun.light.kind = LightKind::Sun;
  sun.light.intensity = std::numbers::pi_v<float>;
  sun.light.angleRadians = glm::radians(0.53f); // the sun as seen from the earth
  sun.directionWorld = glm::normalize(glm::vec3(0.5f, -1.0f, -0.7f));
  return sun;
}

} // namespace

Lighting makeLighting(const Pose& pose, const std::vector<std::string>& lightTexts, Environment environment) {
  Lighting lighting;
  lighting.lights = lightTexts.empty() ? pose.lights : parseLightTexts(lightTexts);
  if (lightTexts.empty() && lighting.lights.empty()) lighting.lights.push_back(defaultSun());

  lighting.environment = std::move(environment);
  if (lighting.environment.radiance.empty()) {
    const auto sun =
        std::ranges::find(lighting.lights, LightKind::Sun, [](const PosedLight& l) { return l.light.kind; });
    lighting.environment = makeSky(-(sun != lighting.lights.end() ? sun->directionWorld : defaultSun().directionWorld));
  }
  return lighting;
}

} // namespace brickfield
