// What shines on a frame: lights, environment, sky; and its diffuse part as spherical harmonics. Shared by the renderer
// and the reference.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/pose.h"

namespace brickfield {

/// Radiance of the far surroundings as an equirectangular image, rows from the zenith, linear. The column of +Z... is
/// u = 0.5 + atan2(x, -z) / 2π, the row v = acos(y) / π.
struct Environment {
  glm::uvec2 size{0};
  std::vector<glm::vec3> radiance;
};

/// A plain clear sky with a soft horizon and a dim ground; used where no environment is given.
/// directionToSunWorld unit; brightens the sky around it, the disk itself is a light and not in the image
Environment makeSky(glm::vec3 directionToSunWorld, glm::uvec2 size = {256, 128});

/// Irradiance as nine spherical-harmonics coefficients (Ramamoorthi and Hanrahan 2001), already convolved with the
/// clamped cosine: irradiance(n) = sum c_i * Y_i(n). Twin of shaders/lib/spherical_harmonics.glsl.
std::array<glm::vec3, 9> irradianceHarmonics(const Environment& environment);
glm::vec3 evaluateHarmonics(const std::array<glm::vec3, 9>& harmonics, glm::vec3 directionWorld);

/// Bilinear lookup.
glm::vec3 sampleEnvironment(const Environment& environment, glm::vec3 directionWorld);

/// Everything that a frame is lit by.
struct Lighting {
  std::vector<PosedLight> lights;
  Environment environment;
};

/// The lights of a frame from what the user said (texts as on the command line) and what the scene has.
///
/// lightTexts       "sun:X,Y,Z:DEGREES:LUX", "sphere:X,Y,Z:RADIUS:CANDELA", "rectangle:X,Y,Z:DX,DY,DZ:WIDTH,HEIGHT:
///                  CANDELA" or "none"; empty: the scene's own lights, and where it has none a sun of π lux from the
///                  upper left and the sky
/// environment      loaded by the caller; one of size 0: the sky
/// error            BadInput that names the flag
Lighting makeLighting(const Pose& pose, const std::vector<std::string>& lightTexts, Environment environment);

} // namespace brickfield
