// How far two pictures are apart, in figures and as a heat map.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/exr.h"
#include "app/image.h"

namespace brickfield {

/// rmse   root of the mean squared difference
/// mae    mean absolute difference
/// relmse mean of (a - b)^2 / (b^2 + 0.01), b being the truth; the 0.01 keeps dark pixels from ruling
enum class Metric { Rmse, Mae, RelMse };
Metric parseMetric(const std::string& flag, const std::string& text);
std::string_view metricName(Metric metric);

/// Two parts that can be compared: same size, same channels in the same order.
struct LayerDifference {
  std::string layer;
  bool isCategorical = false; ///< id and kind: a pixel differs or not, whatever the metric
  double figure = 0;          ///< by the metric over all matched pixels; categorical: share that differs
  double meanAbsolute = 0;
  double maxAbsolute = 0;
  glm::uvec2 worstPixel{0}; ///< where maxAbsolute stands
  std::uint64_t pixels = 0;
  std::uint64_t unmatched = 0; ///< pixels with a value that is NaN, or infinite in one of both only
  std::vector<float> errors;   ///< a pixel each: its share in the figure; NaN where unmatched
};

/// a         what is judged
/// b         the truth
/// returns   pixels that are infinite alike in both (sky) count as equal
/// error     BadInput: sizes or channels differ
/// proved by tests/unit/app/compare_test.cpp
LayerDifference compareParts(const ImagePart& a, const ImagePart& b, Metric metric);

/// Black through blue, red and yellow to white at the greatest error, by its square root, so that one bad pixel does
/// not hide the others; green where unmatched.
RgbImage heatmapOf(const LayerDifference& difference, glm::uvec2 size);

} // namespace brickfield
