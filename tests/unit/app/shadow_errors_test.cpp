// Figures of shadows on pictures of a few pixels.
#include "app/shadow_errors.h"

#include <cmath>

#include <gtest/gtest.h>

namespace brickfield {
namespace {

constexpr glm::uvec2 kSize{12, 9};

FrameLayers flatFloor() {
  FrameLayers layers;
  layers.size = kSize;
  const std::size_t pixels = std::size_t{kSize.x} * kSize.y;
  layers.depth.assign(pixels, 2.0f);
  layers.id.assign(pixels, 3);
  layers.kind.assign(pixels, SurfaceKind::Mesh);
  layers.normalSurface.assign(pixels, glm::vec3(0, 1, 0));
  return layers;
}

std::size_t at(std::uint32_t x, std::uint32_t y) { return std::size_t{y} * kSize.x + x; }

TEST(ShadowErrors, AreMeanAndRootOfSquares) {
  const FrameLayers layers = flatFloor();
  const std::vector<float> truth(layers.depth.size(), 0.5f);
  std::vector<float> frame = truth;
  std::vector<std::uint8_t> counts(truth.size(), 0);
  for (std::uint32_t x = 0; x < 4; ++x) counts[at(x, 0)] = 1;
  frame[at(0, 0)] = 0.9f, frame[at(1, 0)] = 0.3f, frame[at(5, 5)] = 0.0f; // the last does not count
  const ShadowErrors errors = shadowErrors(frame, truth, layers, counts);
  EXPECT_EQ(errors.pixels, 4u);
  EXPECT_NEAR(errors.mean, 0.05, 1e-6);
  EXPECT_NEAR(errors.rmse, std::sqrt((0.16 + 0.04) / 4), 1e-6);
  EXPECT_EQ(errors.speckled, 0.0);
  EXPECT_EQ(errors.leaking, 0.0);
  EXPECT_EQ(shadowErrors(frame, truth, layers, std::vector<std::uint8_t>(truth.size(), 0)).rmse, 0.0);
}

// The left half lit, the right in the umbra: five columns of each and one between.
TEST(ShadowErrors, SpecklesAreInTheLightAndLeaksInTheUmbra) {
  const FrameLayers layers = flatFloor();
  std::vector<float> truth(layers.depth.size(), 0.5f);
  for (std::uint32_t y = 0; y < kSize.y; ++y)
    for (std::uint32_t x = 0; x < kSize.x; ++x)
      if (x != 5 && x != 6) truth[at(x, y)] = x < 5 ? 1.0f : 0.0f;
  const std::vector<std::uint8_t> counts(truth.size(), 1);
  std::vector<float> frame = truth;
  frame[at(2, 4)] = 0.97f;  // of 1 x 5 pixels that are two away from everything else
  frame[at(4, 4)] = 0.5f;   // beside the penumbra: no speckle
  frame[at(9, 4)] = 0.11f;  // of 3 x 7 pixels that are one away
  frame[at(10, 4)] = 0.09f; // too little
  const ShadowErrors errors = shadowErrors(frame, truth, layers, counts);
  EXPECT_NEAR(errors.speckled, 1.0 / 5, 1e-9);
  EXPECT_NEAR(errors.leaking, 1.0 / 21, 1e-9);
}

TEST(ShadowErrors, PixelsCountThatShowTheSameAndFaceTheLight) {
  FrameLayers truth = flatFloor(), frame = flatFloor();
  frame.id[at(1, 1)] = 4;
  frame.depth[at(2, 1)] = 2.03f;
  truth.kind[at(3, 1)] = SurfaceKind::None;
  truth.normalSurface[at(4, 1)] = {0, -1, 0};
  PosedLight sun;
  sun.light.kind = LightKind::Sun;
  sun.directionWorld = {0, -1, 0};
  const View view = makePerspectiveView({0, 2, 0.1f}, {0, 0, 0}, 1, 0.01f, kSize);
  const std::vector<std::uint8_t> counts = comparableShadowPixels(frame, truth, view, sun);
  for (std::uint32_t x = 0; x < kSize.x; ++x) EXPECT_EQ(counts[at(x, 1)], x < 1 || x > 4) << x;
}

TEST(ShadowErrors, HeatMapsAreRedWhereTooLight) {
  const std::vector<float> truth{0.5f, 0.5f, 0.5f, 0.5f}, frame{0.5f, 0.8f, 0.2f, 0.9f};
  const RgbImage image = shadowHeatMap(frame, truth, {4, 1}, {1, 1, 1, 0});
  EXPECT_EQ(image.pixels[0], glm::vec3(1));
  EXPECT_GT(image.pixels[1].x, 2 * image.pixels[1].z);
  EXPECT_GT(image.pixels[2].z, 2 * image.pixels[2].x);
  EXPECT_EQ(image.pixels[3].x, image.pixels[3].z);
}

} // namespace
} // namespace brickfield
