// Image comparison after OpenImageIO's idea of three numbers: what differs by more than a tolerance may do so in a
// small share of the pixels, and nowhere by more than a hard limit. A failure keeps a heat map.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

namespace brickfield::test {

struct ImageTolerance {
  float tolerance = 0;    ///< a pixel's largest channel difference above this counts as over
  float shareAllowed = 0; ///< of the pixels that may be over, in [0,1]
  float hardLimit = 0;    ///< none may differ by more
};

struct ImageDifference {
  float max = 0;
  double mean = 0;      ///< over pixels, of the largest channel difference
  double shareOver = 0; ///< of pixels above the tolerance
  std::string worst;    ///< text: the worst pixels with both values
  std::vector<float>
      pixels; ///< largest channel difference of each pixel; a NaN or infinity in one image only is infinite
};

/// width    pixels in a row
/// channels values a pixel; both images hold width * height * channels floats
ImageDifference differenceOf(const std::vector<float>& actual, const std::vector<float>& expected, int width,
                             int channels, float tolerance);

/// For EXPECT_TRUE. On failure the message has the three numbers and the worst pixels, and the images' heat map is kept
/// as heatmaps/NAME.png under the build folder.
::testing::AssertionResult imagesMatch(std::string_view name, const std::vector<float>& actual,
                                       const std::vector<float>& expected, int width, int channels,
                                       const ImageTolerance& tolerance);
::testing::AssertionResult imagesMatch(std::string_view name, const std::vector<glm::vec3>& actual,
                                       const std::vector<glm::vec3>& expected, int width,
                                       const ImageTolerance& tolerance);

} // namespace brickfield::test
