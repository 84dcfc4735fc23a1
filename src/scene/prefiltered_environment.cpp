// Convolves by summing over texels, no random numbers: each level reads a copy of the environment that is just fine
// enough for its lobe.
#include "scene/prefiltered_environment.h"

#include <algorithm>
#include <numbers>
#include <span>

#include "scene/brdf.h"
#include "scene/environment.h"

namespace brickfield {

namespace {

struct LevelPlan {
  glm::uvec2 source, target;
};
// Roughness 0.2, 0.4, ... 1. The narrowest lobe (alpha 0.04) is half as high 0.05 rad from its axis: two texels of 256.
constexpr std::array<LevelPlan, 5> kPlans{
    {{{256, 128}, {128, 64}}, {{128, 64}, {64, 32}}, {{64, 32}, {64, 32}}, {{64, 32}, {32, 16}}, {{64, 32}, {32, 16}}}};

struct Texel {
  glm::vec3 direction;
  glm::vec3 radiance;
  float solidAngle;
};

std::vector<Texel> texelsOf(const Environment& environment) {
  std::vector<Texel> texels;
  texels.reserve(environment.radiance.size());
  for (std::uint32_t row = 0; row < environment.size.y; ++row)
    for (std::uint32_t column = 0; column < environment.size.x; ++column) {
      const glm::dvec2 uv((column + 0.5) / environment.size.x, (row + 0.5) / environment.size.y);
      texels.push_back({glm::vec3(environmentDirection(uv)), environment.radiance[texels.size()],
                        static_cast<float>(texelSolidAngle(environment.size, row))});
    }
  return texels;
}

/// Cosine between the lobe's axis and the light direction where the lobe has sunk to a thousandth of its peak: there
/// sin²(half angle) (1 - alpha²) + alpha² = alpha² sqrt(1000).
float lobeEnd(float alpha) {
  const float alphaSquared = alpha * alpha;
  const float sineSquared = alphaSquared * (std::sqrt(1000.0f) - 1.0f) / std::max(1.0f - alphaSquared, 1e-6f);
  return std::max(1.0f - 2.0f * sineSquared, 0.0f); // cos of the doubled angle; never below the horizon
}

/// texels    of the rows that the lobe can reach
glm::vec3 convolveAt(std::span<const Texel> texels, glm::vec3 axis, float alpha, float leastCosine) {
  glm::vec3 sum(0.0f);
  float weights = 0.0f;
  for (const Texel& texel : texels) {
    const float cosine = glm::dot(axis, texel.direction);
    if (cosine <= leastCosine) continue;
    const float nDotH = std::sqrt(0.5f + 0.5f * std::min(cosine, 1.0f)); // viewer and normal are the axis
    const float weight = distributionGgx(alpha, nDotH) * cosine * texel.solidAngle;
    sum += weight * texel.radiance;
    weights += weight;
  }
  if (weights > 0.0f) return sum / weights;
  // A tiny environment may have no texel under a narrow lobe: the nearest one stands for it.
  return std::ranges::max_element(texels, {}, [&](const Texel& t) { return glm::dot(axis, t.direction); })->radiance;
}

Environment convolve(const Environment& environment, const LevelPlan& plan, float roughness) {
  const Environment source = shrinkEnvironment(environment, plan.source);
  const std::vector<Texel> texels = texelsOf(source);
  const float alpha = roughness * roughness, leastCosine = lobeEnd(alpha);
  const double reach = std::acos(double{leastCosine}) / std::numbers::pi; // of the lobe, in heights of the image
  Environment level;
  level.size = glm::min(environment.size, plan.target);
  for (std::uint32_t row = 0; row < level.size.y; ++row) {
    const double v = (row + 0.5) / level.size.y;
    const auto rowAt = [&](double place) {
      return static_cast<std::size_t>(std::clamp(place, 0.0, 1.0) * source.size.y);
    };
    const std::size_t firstRow = rowAt(v - reach), endRow = std::min<std::size_t>(rowAt(v + reach) + 1, source.size.y);
    const auto rows = std::span(texels).subspan(firstRow * source.size.x, (endRow - firstRow) * source.size.x);
    for (std::uint32_t column = 0; column < level.size.x; ++column) {
      const glm::vec3 axis(environmentDirection({(column + 0.5) / level.size.x, v}));
      level.radiance.push_back(convolveAt(rows, axis, alpha, leastCosine));
    }
  }
  return level;
}

} // namespace

PrefilteredEnvironment prefilterEnvironment(const Environment& environment) {
  PrefilteredEnvironment result;
  result.levels.push_back(environment);
  if (environment.radiance.empty()) return result;
  for (std::size_t i = 0; i < kPlans.size(); ++i)
    result.levels.push_back(
        convolve(environment, kPlans[i], static_cast<float>(i + 1) / static_cast<float>(kPlans.size())));
  return result;
}

glm::vec3 samplePrefiltered(const PrefilteredEnvironment& environment, glm::vec3 directionWorld, float roughness) {
  const std::size_t last = environment.levels.size() - 1;
  const float position = std::clamp(roughness, 0.0f, 1.0f) * static_cast<float>(last);
  const std::size_t lower = std::min(static_cast<std::size_t>(position), last);
  const std::size_t upper = std::min(lower + 1, last);
  return glm::mix(sampleEnvironment(environment.levels[lower], directionWorld),
                  sampleEnvironment(environment.levels[upper], directionWorld), position - static_cast<float>(lower));
}

} // namespace brickfield
