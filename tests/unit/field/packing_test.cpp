// RGBA8 and RGB9E5 against their definitions.
#include <gtest/gtest.h>

#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

TEST(PackRgba8, RoundTripsEveryCode) {
  for (std::uint32_t i = 0; i < 256; ++i) {
    const std::uint32_t packed = i | (255 - i) << 8 | (i ^ 0x55u) << 16 | (i / 2) << 24;
    EXPECT_EQ(packRgba8(unpackRgba8(packed)), packed);
  }
}

TEST(PackRgba8, RoundsClampsAndOrders) {
  EXPECT_EQ(packRgba8({1, 0, 0, 0}), 0x000000ffu);
  EXPECT_EQ(packRgba8({0, 0, 0, 1}), 0xff000000u);
  EXPECT_EQ(packRgba8({-1, 2, std::nanf(""), 0.5f}), 0x8000ff00u);
  EXPECT_EQ(packRgba8({0.4999f / 255, 0.5001f / 255, 0, 0}), 0x00000100u);
}

TEST(PackRgb9e5, KnownCodes) {
  EXPECT_EQ(packRgb9e5({0, 0, 0}), 0u);
  EXPECT_EQ(packRgb9e5({1, 1, 1}), 0x84020100u);     // 256 * 2^(16-24)
  EXPECT_EQ(packRgb9e5({65408, 0, 0}), 0xf80001ffu); // the largest: 511 * 2^(31-24)
  EXPECT_EQ(packRgb9e5({1e30f, 0, 0}), 0xf80001ffu); // clamped
  EXPECT_EQ(packRgb9e5({std::numeric_limits<float>::infinity(), -1, std::nanf("")}), 0xf80001ffu);
  EXPECT_EQ(packRgb9e5({0.9995f, 0, 0}), 0x80000100u);           // 511.7 rounds to 512: the exponent goes up
  EXPECT_EQ(unpackRgb9e5(0x00000001u).x, std::ldexp(1.0f, -24)); // the smallest
  EXPECT_EQ(packRgb9e5(glm::vec3(std::ldexp(1.0f, -24), 0, 0)), 1u);
  EXPECT_EQ(packRgb9e5(glm::vec3(1e-40f)), 0u);
}

TEST(PackRgb9e5, LosesAtMostA512thOfTheLargestChannel) {
  test::Random random(2);
  for (int i = 0; i < 100000; ++i) {
    // The shared step is 2^(e-24) with the largest channel at least 2^(e-16): half a step is 2^-9 of it.
    const float scale = std::exp2(random.between(-13, 15.9f));
    const glm::vec3 radiance = scale * glm::vec3(random.unit(), random.unit(), random.unit());
    const float largest = std::max({radiance.x, radiance.y, radiance.z});
    const glm::vec3 back = unpackRgb9e5(packRgb9e5(radiance));
    for (int channel = 0; channel < 3; ++channel)
      ASSERT_LE(std::abs(back[channel] - radiance[channel]), std::max(largest / 512, std::ldexp(1.0f, -25)) * 1.0001f)
          << largest;
    ASSERT_EQ(packRgb9e5(back), packRgb9e5(radiance));
  }
}

} // namespace
} // namespace brickfield
