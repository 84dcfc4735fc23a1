// Sums over pixels; what counts as lit or as umbra looks around in the truth.
#include "app/shadow_errors.h"

#include <algorithm>
#include <cmath>

namespace brickfield {

namespace {

constexpr float kLit = 0.9999f, kUmbra = 1e-4f;
constexpr float kFlatCosine = 0.9999f; // of normals: 0.8 degrees

// Whether a condition holds for all pixels of a square around one; false at the border of the picture.
template <typename Holds>
bool holdsAround(glm::uvec2 size, glm::uvec2 pixel, std::uint32_t reach, const Holds& holds) {
  if (pixel.x < reach || pixel.y < reach || pixel.x + reach >= size.x || pixel.y + reach >= size.y) return false;
  for (std::uint32_t y = pixel.y - reach; y <= pixel.y + reach; ++y)
    for (std::uint32_t x = pixel.x - reach; x <= pixel.x + reach; ++x)
      if (!holds(std::size_t{y} * size.x + x)) return false;
  return true;
}

} // namespace

std::vector<std::uint8_t> comparableShadowPixels(const FrameLayers& frame, const FrameLayers& truth, const View& view,
                                                 const PosedLight& light) {
  constexpr float kSameDepth = 0.01f;
  std::vector<std::uint8_t> counts(truth.depth.size(), 0);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (truth.kind[i] == SurfaceKind::None || frame.kind[i] == SurfaceKind::None || truth.id[i] != frame.id[i])
      continue;
    if (!(std::abs(truth.depth[i] - frame.depth[i]) <= kSameDepth * truth.depth[i])) continue;
    const glm::vec2 pixel(static_cast<float>(i % truth.size.x) + 0.5f, static_cast<float>(i / truth.size.x) + 0.5f);
    const PrimaryRay ray = primaryRay(view, pixel);
    const glm::vec3 point = ray.originWorld + truth.depth[i] * ray.directionWorld;
    const glm::vec3 toLight = light.light.kind == LightKind::Sun ? -light.directionWorld : light.positionWorld - point;
    counts[i] = glm::dot(truth.normalSurface[i], toLight) > 0.0f;
  }
  return counts;
}

ShadowErrors shadowErrors(const std::vector<float>& frame, const std::vector<float>& truth, const FrameLayers& layers,
                          const std::vector<std::uint8_t>& counts) {
  ShadowErrors errors;
  double squares = 0, sum = 0;
  std::size_t lit = 0, umbra = 0, speckled = 0, leaking = 0;
  for (std::uint32_t y = 0; y < layers.size.y; ++y)
    for (std::uint32_t x = 0; x < layers.size.x; ++x) {
      const std::size_t i = std::size_t{y} * layers.size.x + x;
      if (!counts[i]) continue;
      ++errors.pixels;
      const double difference = double{frame[i]} - truth[i];
      squares += difference * difference;
      sum += difference;
      if (truth[i] >= kLit && holdsAround(layers.size, {x, y}, 2, [&](std::size_t j) {
            return counts[j] && truth[j] >= kLit &&
                   glm::dot(layers.normalSurface[i], layers.normalSurface[j]) > kFlatCosine;
          }))
        ++lit, speckled += frame[i] < 0.98f;
      if (truth[i] <= kUmbra && holdsAround(layers.size, {x, y}, 1, [&](std::size_t j) { return truth[j] <= kUmbra; }))
        ++umbra, leaking += frame[i] > 0.1f;
    }
  const auto share = [](double part, std::size_t whole) { return whole ? part / static_cast<double>(whole) : 0.0; };
  errors.rmse = std::sqrt(share(squares, errors.pixels));
  errors.mean = share(sum, errors.pixels);
  errors.speckled = share(static_cast<double>(speckled), lit);
  errors.leaking = share(static_cast<double>(leaking), umbra);
  return errors;
}

RgbImage shadowHeatMap(const std::vector<float>& frame, const std::vector<float>& truth, glm::uvec2 size,
                       const std::vector<std::uint8_t>& counts) {
  constexpr float kFull = 0.25f;
  RgbImage image{size, {}};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const float error = std::clamp((frame[i] - truth[i]) / kFull, -1.0f, 1.0f);
    const glm::vec3 full = error > 0 ? glm::vec3(0.8f, 0.05f, 0.1f) : glm::vec3(0.1f, 0.2f, 0.8f);
    image.pixels.push_back(counts[i] ? glm::mix(glm::vec3(1), full, std::abs(error)) : glm::vec3(0.55f));
  }
  return image;
}

RgbImage shadowPicture(const std::vector<float>& shadow, glm::uvec2 size) {
  RgbImage image{size, {}};
  for (const float visible : shadow) image.pixels.emplace_back(std::pow(std::clamp(visible, 0.0f, 1.0f), 1 / 2.2f));
  return image;
}

} // namespace brickfield
