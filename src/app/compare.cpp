// Figures are summed in double precision, row by row, so that they are the same everywhere.
#include "app/compare.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace brickfield {

namespace {
constexpr double kRelativeFloor = 0.01;

/// Share of one value in its pixel's error.
double valueError(double a, double b, Metric metric) {
  const double difference = a - b;
  if (metric == Metric::Mae) return std::abs(difference);
  if (metric == Metric::Rmse) return difference * difference;
  return difference * difference / (b * b + kRelativeFloor);
}

bool isMatched(float a, float b) { return (std::isfinite(a) && std::isfinite(b)) || a == b; }

} // namespace

Metric parseMetric(const std::string& flag, const std::string& text) {
  for (const Metric metric : {Metric::Rmse, Metric::Mae, Metric::RelMse})
    if (text == metricName(metric)) return metric;
  throw BadInput(flag, fmt::format("\"{}\"", text), "is none of rmse, mae, relmse");
}

std::string_view metricName(Metric metric) {
  return metric == Metric::Rmse ? "rmse" : metric == Metric::Mae ? "mae" : "relmse";
}

LayerDifference compareParts(const ImagePart& a, const ImagePart& b, Metric metric) {
  if (a.size != b.size)
    throw BadInput("layer " + a.name, "",
                   fmt::format("sizes differ: {} x {} and {} x {}", a.size.x, a.size.y, b.size.x, b.size.y));
  if (a.channels != b.channels)
    throw BadInput("layer " + a.name, "",
                   fmt::format("channels differ: {} and {}", fmt::join(a.channels, " "), fmt::join(b.channels, " ")));
  LayerDifference result;
  result.layer = a.name;
  result.isCategorical = a.name == "id" || a.name == "kind";
  result.pixels = std::uint64_t{a.size.x} * a.size.y;
  result.errors.resize(result.pixels);
  const std::size_t channels = a.channels.size();
  double sum = 0, sumAbsolute = 0;
  for (std::size_t pixel = 0; pixel < result.pixels; ++pixel) {
    double error = 0, absolute = 0, largest = 0;
    bool matched = true;
    for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i) {
      matched = matched && isMatched(a.values[i], b.values[i]);
      if (a.values[i] == b.values[i]) continue;
      const double difference = std::abs(double{a.values[i]} - double{b.values[i]});
      error += result.isCategorical ? 1.0 : valueError(a.values[i], b.values[i], metric);
      absolute += difference;
      largest = std::max(largest, difference);
    }
    if (!matched) {
      ++result.unmatched;
      result.errors[pixel] = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    error /= static_cast<double>(channels);
    result.errors[pixel] = static_cast<float>(error);
    sum += error;
    sumAbsolute += absolute / static_cast<double>(channels);
    if (largest > result.maxAbsolute) {
      result.maxAbsolute = largest;
      result.worstPixel = {pixel % a.size.x, pixel / a.size.x};
    }
  }
  const double matchedPixels = static_cast<double>(std::max<std::uint64_t>(1, result.pixels - result.unmatched));
  const double mean = sum / matchedPixels;
  result.figure = metric == Metric::Rmse && !result.isCategorical ? std::sqrt(mean) : mean;
  result.meanAbsolute = sumAbsolute / matchedPixels;
  return result;
}

RgbImage heatmapOf(const LayerDifference& difference, glm::uvec2 size) {
  static constexpr std::array<glm::vec3, 5> kRamp{
      {{0, 0, 0}, {0.1f, 0.1f, 0.7f}, {0.8f, 0.1f, 0.2f}, {1, 0.8f, 0.1f}, {1, 1, 1}}};
  static constexpr glm::vec3 kUnmatchedColor{0, 1, 0};
  float largest = 0;
  for (const float error : difference.errors)
    if (error > largest) largest = error;
  RgbImage image{size, {}};
  image.pixels.reserve(difference.errors.size());
  for (const float error : difference.errors) {
    if (std::isnan(error)) {
      image.pixels.push_back(kUnmatchedColor);
      continue;
    }
    const float position = largest > 0 ? std::sqrt(error / largest) * (kRamp.size() - 1) : 0.0f;
    const std::size_t step = std::min(static_cast<std::size_t>(position), kRamp.size() - 2);
    image.pixels.push_back(glm::mix(kRamp[step], kRamp[step + 1], position - static_cast<float>(step)));
  }
  return image;
}

} // namespace brickfield
