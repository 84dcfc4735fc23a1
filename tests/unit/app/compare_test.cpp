// Figures against values worked out by hand.
#include "app/compare.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ImagePart depthOf(std::vector<float> values) {
  const auto width = static_cast<unsigned>(values.size());
  return {"depth", {width, 1}, {"Z"}, std::move(values)};
}

TEST(CompareParts, RmseIsTheRootOfTheMeanSquare) {
  const LayerDifference difference = compareParts(depthOf({1, 2, 3, 4}), depthOf({1, 5, 3, 0}), Metric::Rmse);
  EXPECT_DOUBLE_EQ(difference.figure, 2.5); // (9 + 16) / 4 = 6.25
  EXPECT_DOUBLE_EQ(difference.meanAbsolute, 7.0 / 4.0);
  EXPECT_DOUBLE_EQ(difference.maxAbsolute, 4.0);
  EXPECT_EQ(difference.worstPixel, glm::uvec2(3, 0));
  EXPECT_EQ(difference.unmatched, 0u);
}

TEST(CompareParts, MaeAndRelmseFollowTheirFormulas) {
  EXPECT_DOUBLE_EQ(compareParts(depthOf({1, 2}), depthOf({2, 4}), Metric::Mae).figure, 1.5);
  // 1 / 4.01 and 4 / 16.01
  EXPECT_DOUBLE_EQ(compareParts(depthOf({1, 2}), depthOf({2, 4}), Metric::RelMse).figure, (1 / 4.01 + 4 / 16.01) / 2);
}

TEST(CompareParts, AveragesChannels) {
  const ImagePart a{"color", {1, 2}, {"R", "G", "B"}, {0, 0, 0, 1, 1, 1}};
  const ImagePart b{"color", {1, 2}, {"R", "G", "B"}, {0, 0, 3, 1, 1, 1}};
  EXPECT_DOUBLE_EQ(compareParts(a, b, Metric::Mae).figure, 0.5); // 3 / 3 channels / 2 pixels
  EXPECT_DOUBLE_EQ(compareParts(a, b, Metric::Rmse).figure, std::sqrt(1.5));
  EXPECT_EQ(compareParts(a, b, Metric::Rmse).worstPixel, glm::uvec2(0, 0));
}

TEST(CompareParts, SkyInBothIsEqualAndInOneIsUnmatched) {
  const LayerDifference difference =
      compareParts(depthOf({kInfinity, kInfinity, 1, kNan}), depthOf({kInfinity, 2, 3, kNan}), Metric::Mae);
  EXPECT_EQ(difference.unmatched, 2u);
  EXPECT_DOUBLE_EQ(difference.figure, 1.0); // 0 and 2 over two matched pixels
  EXPECT_EQ(difference.errors[0], 0.0f);
  EXPECT_TRUE(std::isnan(difference.errors[1]));
  EXPECT_EQ(difference.maxAbsolute, 2.0);
}

TEST(CompareParts, CountsPixelsOfCategoriesThatDiffer) {
  const ImagePart a{"id", {4, 1}, {"ID"}, {1, 2, 3, -1}}, b{"id", {4, 1}, {"ID"}, {1, 2, 9, 40}};
  for (const Metric metric : {Metric::Rmse, Metric::Mae, Metric::RelMse})
    EXPECT_DOUBLE_EQ(compareParts(a, b, metric).figure, 0.5);
}

TEST(CompareParts, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(compareParts(depthOf({1}), depthOf({1, 2}), Metric::Rmse), BadInput);
  const ImagePart other{"depth", {1, 1}, {"D"}, {1}};
  EXPECT_THROW(compareParts(depthOf({1}), other, Metric::Rmse), BadInput);
}

TEST(Heatmap, RunsFromBlackToWhiteAndMarksUnmatched) {
  const LayerDifference difference = compareParts(depthOf({0, 1, 2, kInfinity}), depthOf({0, 0, 0, 0}), Metric::Mae);
  const RgbImage map = heatmapOf(difference, {4, 1});
  EXPECT_EQ(map.pixels[0], glm::vec3(0));
  EXPECT_EQ(map.pixels[2], glm::vec3(1));
  EXPECT_EQ(map.pixels[3], glm::vec3(0, 1, 0));
  EXPECT_GT(map.pixels[1].x + map.pixels[1].y + map.pixels[1].z, 0.0f);
  EXPECT_LT(map.pixels[1].x + map.pixels[1].y + map.pixels[1].z, 3.0f);
}

TEST(Heatmap, OfEqualPicturesIsBlack) {
  const RgbImage map = heatmapOf(compareParts(depthOf({1, 2}), depthOf({1, 2}), Metric::Rmse), {2, 1});
  EXPECT_THAT(map.pixels, ::testing::Each(glm::vec3(0)));
}

TEST(ParseMetric, KnowsThree) {
  EXPECT_EQ(parseMetric("--metric", "relmse"), Metric::RelMse);
  EXPECT_THROW(parseMetric("--metric", "psnr"), BadInput);
}

} // namespace
} // namespace brickfield
