// The comparison that all render tests rest on: each of its three numbers can fail an image alone.
#include "tests/support/image_compare.h"

#include <filesystem>
#include <limits>

namespace brickfield::test {
namespace {

// 10 x 10 pixels of one channel.
std::vector<float> flat(float value) { return std::vector<float>(100, value); }

TEST(ImageCompare, EqualImagesMatchWithoutTolerance) {
  EXPECT_TRUE(imagesMatch("equal", flat(0.5f), flat(0.5f), 10, 1, {}));
}

TEST(ImageCompare, DifferencesWithinToleranceMatch) {
  EXPECT_TRUE(imagesMatch("within", flat(0.5f), flat(0.625f), 10, 1, {0.125f, 0, 0.125f}));
}

TEST(ImageCompare, ShareDecidesBelowTheHardLimit) {
  std::vector<float> image = flat(0);
  image[3] = image[57] = 0.5f;
  EXPECT_TRUE(imagesMatch("share", image, flat(0), 10, 1, {0.1f, 0.02f, 1}));
  EXPECT_FALSE(imagesMatch("share", image, flat(0), 10, 1, {0.1f, 0.019f, 1}));
}

TEST(ImageCompare, HardLimitHoldsWhateverTheShare) {
  std::vector<float> image = flat(0);
  image[42] = 0.75f;
  EXPECT_TRUE(imagesMatch("limit", image, flat(0), 10, 1, {0.1f, 1, 0.75f}));
  const ::testing::AssertionResult result = imagesMatch("limit", image, flat(0), 10, 1, {0.1f, 1, 0.5f});
  EXPECT_FALSE(result);
  EXPECT_NE(std::string(result.message()).find("pixel 2,4: 0.75"), std::string::npos) << result.message();
  EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(BRICKFIELD_BINARY_DIR) / "heatmaps" / "limit.png"));
}

TEST(ImageCompare, NotANumberNeverPasses) {
  std::vector<float> image = flat(0);
  image[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(imagesMatch("nan", image, flat(0), 10, 1, {1e30f, 1, 1e30f}));
  EXPECT_TRUE(imagesMatch("nan", image, image, 10, 1, {}));
}

TEST(ImageCompare, SizesMustFit) {
  EXPECT_FALSE(imagesMatch("sizes", flat(0), std::vector<float>(99), 10, 1, {1, 1, 1}));
  EXPECT_FALSE(imagesMatch("sizes", flat(0), flat(0), 7, 1, {1, 1, 1}));
  EXPECT_FALSE(imagesMatch("sizes", {}, {}, 10, 1, {1, 1, 1}));
}

TEST(ImageCompare, LargestChannelCounts) {
  const std::vector<glm::vec3> expected(4, glm::vec3(0.25f));
  std::vector<glm::vec3> actual = expected;
  actual[1].y = 0.5f;
  EXPECT_FALSE(imagesMatch("channels", actual, expected, 2, {0.2f, 0, 1}));
  EXPECT_TRUE(imagesMatch("channels", actual, expected, 2, {0.25f, 0, 1}));
}

} // namespace
} // namespace brickfield::test
