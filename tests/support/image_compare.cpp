// The comparison and its heat map.
#include "tests/support/image_compare.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace brickfield::test {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kWorstShown = 5;

float valueDifference(float actual, float expected) {
  if (actual == expected || (std::isnan(actual) && std::isnan(expected))) return 0;
  const float difference = std::abs(actual - expected);
  return std::isfinite(difference) ? difference : std::numeric_limits<float>::infinity();
}

std::string worstPixels(const std::vector<float>& actual, const std::vector<float>& expected, int width, int channels,
                        const std::vector<float>& differences) {
  std::vector<std::size_t> order(differences.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t shown = std::min(kWorstShown, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return differences[a] != differences[b] ? differences[a] > differences[b] : a < b;
                    });
  std::string text;
  for (std::size_t i = 0; i < shown && differences[order[i]] > 0; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(order[i] * static_cast<std::size_t>(channels));
    const auto values = [&](const std::vector<float>& image) {
      return fmt::join(image.begin() + first, image.begin() + first + channels, " ");
    };
    text += fmt::format("\n  pixel {},{}: {} is ({}), expected ({})", order[i] % static_cast<std::size_t>(width),
                        order[i] / static_cast<std::size_t>(width), differences[order[i]], values(actual),
                        values(expected));
  }
  return text;
}

// Black, red, yellow, white from no difference to the hard limit and beyond.
fs::path writeHeatMap(std::string_view name, const std::vector<float>& differences, int width, float hardLimit) {
  const fs::path folder = fs::path(BRICKFIELD_BINARY_DIR) / "heatmaps";
  fs::create_directories(folder);
  const fs::path path = folder / (std::string(name) + ".png");
  const float white = hardLimit > 0 ? hardLimit : std::numeric_limits<float>::min();
  std::vector<std::uint8_t> rgb;
  rgb.reserve(differences.size() * 3);
  for (const float difference : differences) {
    const float heat = std::min(difference / white, 1.0f) * 3.0f;
    for (const float start : {0.0f, 1.0f, 2.0f})
      rgb.push_back(static_cast<std::uint8_t>(std::clamp(heat - start, 0.0f, 1.0f) * 255.0f + 0.5f));
  }
  const int height = static_cast<int>(differences.size()) / width;
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output || !output->open(path.string(), OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8)) ||
      !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close())
    return "(heat map not written)";
  return path;
}

} // namespace

ImageDifference differenceOf(const std::vector<float>& actual, const std::vector<float>& expected, int width,
                             int channels, float tolerance) {
  ImageDifference difference;
  const std::size_t stride = static_cast<std::size_t>(std::max(channels, 1));
  difference.pixels.resize(std::min(actual.size(), expected.size()) / stride);
  std::size_t over = 0;
  double sum = 0;
  for (std::size_t pixel = 0; pixel < difference.pixels.size(); ++pixel) {
    float most = 0;
    for (std::size_t c = pixel * stride; c < (pixel + 1) * stride; ++c)
      most = std::max(most, valueDifference(actual[c], expected[c]));
    difference.pixels[pixel] = most;
    difference.max = std::max(difference.max, most);
    sum += most;
    over += most > tolerance;
  }
  const double count = std::max<double>(1, static_cast<double>(difference.pixels.size()));
  difference.mean = sum / count;
  difference.shareOver = static_cast<double>(over) / count;
  difference.worst = worstPixels(actual, expected, width, channels, difference.pixels);
  return difference;
}

::testing::AssertionResult imagesMatch(std::string_view name, const std::vector<float>& actual,
                                       const std::vector<float>& expected, int width, int channels,
                                       const ImageTolerance& tolerance) {
  const std::size_t row =
      static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(channels, 0));
  if (row == 0 || actual.empty() || actual.size() != expected.size() || actual.size() % row != 0)
    return ::testing::AssertionFailure() << name << ": sizes do not fit: " << actual.size() << " and "
                                         << expected.size() << " values, " << row << " a row";
  const ImageDifference difference = differenceOf(actual, expected, width, channels, tolerance.tolerance);
  const std::string numbers =
      fmt::format("{}: max {} (limit {}), mean {}, {:.4f}% of pixels over {} (allowed {:.4f}%){}", name, difference.max,
                  tolerance.hardLimit, difference.mean, 100 * difference.shareOver, tolerance.tolerance,
                  100 * tolerance.shareAllowed, difference.worst);
  if (difference.max <= tolerance.hardLimit && static_cast<float>(difference.shareOver) <= tolerance.shareAllowed)
    return ::testing::AssertionSuccess() << numbers;
  return ::testing::AssertionFailure() << numbers << "\n  heat map "
                                       << writeHeatMap(name, difference.pixels, width, tolerance.hardLimit).string();
}

::testing::AssertionResult imagesMatch(std::string_view name, const std::vector<glm::vec3>& actual,
                                       const std::vector<glm::vec3>& expected, int width,
                                       const ImageTolerance& tolerance) {
  const auto values = [](const std::vector<glm::vec3>& image) {
    std::vector<float> flat;
    flat.reserve(image.size() * 3);
    for (const glm::vec3& pixel : image) flat.insert(flat.end(), {pixel.x, pixel.y, pixel.z});
    return flat;
  };
  return imagesMatch(name, values(actual), values(expected), width, 3, tolerance);
}

} // namespace brickfield::test
