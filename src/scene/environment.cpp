// Equirectangular look-ups.
#include "scene/environment.h"

#include <algorithm>
#include <numbers>

namespace brickfield {

glm::dvec3 environmentDirection(glm::dvec2 uv) {
  const double azimuth = (uv.x - 0.5) * 2.0 * std::numbers::pi, polar = uv.y * std::numbers::pi;
  return {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

glm::vec2 environmentUv(glm::vec3 directionWorld) {
  constexpr float kPi = std::numbers::pi_v<float>;
  return {0.5f + std::atan2(directionWorld.x, -directionWorld.z) / (2.0f * kPi),
          std::acos(std::clamp(directionWorld.y, -1.0f, 1.0f)) / kPi};
}

double texelSolidAngle(glm::uvec2 size, std::uint32_t row) {
  const double top = std::cos(std::numbers::pi * row / size.y),
               bottom = std::cos(std::numbers::pi * (row + 1) / size.y);
  return (top - bottom) * 2.0 * std::numbers::pi / size.x;
}

glm::vec3 sampleEnvironment(const Environment& environment, glm::vec3 directionWorld) {
  if (environment.radiance.empty()) return glm::vec3(0.0f);
  const int width = static_cast<int>(environment.size.x), height = static_cast<int>(environment.size.y);
  const glm::vec2 position = environmentUv(directionWorld) * glm::vec2(environment.size) - 0.5f;
  const glm::vec2 corner = glm::floor(position), weight = position - corner;
  const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
  const auto texel = [&](int column, int row) {
    // Around the horizon the image closes; beyond a pole it would go on from the other side, which a clamp
    // approximates.
    const auto wrapped = static_cast<std::size_t>((column + width) % width);
    return environment
        .radiance[static_cast<std::size_t>(std::clamp(row, 0, height - 1)) * environment.size.x + wrapped];
  };
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), weight.x),
                  glm::mix(texel(x, y + 1), texel(x + 1, y + 1), weight.x), weight.y);
}

Environment shrinkEnvironment(const Environment& environment, glm::uvec2 sideLimit) {
  Environment small;
  small.size = glm::min(environment.size, sideLimit);
  const std::size_t count = std::size_t{small.size.x} * small.size.y;
  std::vector<glm::dvec3> sums(count, glm::dvec3(0.0));
  std::vector<double> weights(count, 0.0);
  for (std::uint32_t row = 0; row < environment.size.y; ++row) {
    const double weight = texelSolidAngle(environment.size, row);
    const std::uint64_t targetRow = std::uint64_t{row} * small.size.y / environment.size.y;
    for (std::uint32_t column = 0; column < environment.size.x; ++column) {
      const std::uint64_t targetColumn = std::uint64_t{column} * small.size.x / environment.size.x;
      const std::size_t target = targetRow * small.size.x + targetColumn;
      sums[target] += weight * glm::dvec3(environment.radiance[std::size_t{row} * environment.size.x + column]);
      weights[target] += weight;
    }
  }
  for (std::size_t i = 0; i < count; ++i) small.radiance.emplace_back(sums[i] / weights[i]);
  return small;
}

} // namespace brickfield
