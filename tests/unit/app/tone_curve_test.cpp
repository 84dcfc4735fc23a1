// The curve against values worked out by hand.
#include "app/tone_curve.h"

#include <limits>

#include <gtest/gtest.h>

namespace brickfield {
namespace {

// Float rounding of four products and a quotient near 1.
constexpr float kRounding = 1e-6f;

TEST(ToneCurve, MeetsHandValues) {
  EXPECT_EQ(toneCurve(0.0f), 0.0f);
  EXPECT_NEAR(toneCurve(1.0f), 2.54f / 3.16f, kRounding);     // (2.51 + 0.03) / (2.43 + 0.59 + 0.14)
  EXPECT_NEAR(toneCurve(0.5f), 0.6425f / 1.0425f, kRounding); // 0.5 * 1.285 / (0.5 * 1.805 + 0.14)
  EXPECT_NEAR(toneCurve(0.18f), 0.18f * 0.4818f / (0.18f * 1.0274f + 0.14f), kRounding);
}

TEST(ToneCurve, RisesToWhiteAndStays) {
  float before = 0;
  for (float exposed = 0.001f; exposed < 8.0f; exposed *= 1.1f) {
    const float value = toneCurve(exposed);
    EXPECT_GE(value, before) << exposed;
    before = value;
  }
  EXPECT_EQ(toneCurve(100.0f), 1.0f);
  EXPECT_EQ(toneCurve(std::numeric_limits<float>::max()), 1.0f);
  EXPECT_EQ(toneCurve(std::numeric_limits<float>::infinity()), 1.0f);
  EXPECT_EQ(toneCurve(std::numeric_limits<float>::quiet_NaN()), 0.0f);
  EXPECT_EQ(toneCurve(-1.0f), 0.0f);
}

TEST(DisplayFromRadiance, ExposesByStopsThenCodesSrgb) {
  const glm::vec3 radiance{0.1f, 0.25f, 1.0f};
  const glm::vec3 brighter = displayFromRadiance(radiance, 1.0f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(brighter[c], srgbFromLinear(toneCurve(2.0f * radiance[c])), kRounding);
  EXPECT_EQ(displayFromRadiance(radiance, 0.0f).z, srgbFromLinear(toneCurve(1.0f)));
}

} // namespace
} // namespace brickfield
