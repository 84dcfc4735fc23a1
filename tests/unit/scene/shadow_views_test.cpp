// Where shadow maps are drawn from: what they cover, and that moving cameras leave their texels in place.
#include "scene/shadow_views.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace brickfield {
namespace {

constexpr int kTexels = 512;
const Box kBounds{{-30, -1, -40}, {30, 9, 40}};

PosedLight lightOf(LightKind kind, glm::vec3 direction = glm::normalize(glm::vec3(0.4f, -1, 0.3f))) {
  PosedLight light;
  light.light.kind = kind;
  light.directionWorld = direction;
  light.positionWorld = {1, 4, 2};
  return light;
}

View cameraAt(glm::vec3 eye, glm::vec3 forward = {0.3f, -0.2f, -1}) {
  return makePerspectiveView(eye, eye + forward, 0.8f, 0.05f, {1280, 720});
}

glm::dvec3 ndcOf(const ShadowView& view, glm::dvec3 pointWorld) {
  const glm::dvec4 clip = clipFromEye(view.view) * glm::dvec4(pointWorld - glm::dvec3(view.view.eyeWorld), 1.0);
  return glm::dvec3(clip) / clip.w;
}

// A point of the picture at a depth, which the slice of that depth must hold with the filters' margin around it.
TEST(ShadowViews, CascadesHoldTheirSlicesOfTheFrustum) {
  const View camera = cameraAt({2, 3, 20});
  const std::vector<double> ends = cascadeEnds(camera, kBounds);
  const auto views = makeShadowViews(lightOf(LightKind::Sun), camera, kBounds, kTexels);
  ASSERT_EQ(views.size(), std::size_t{kSunCascades});
  const double inner = 1.0 - 2.0 * (kShadowMarginTexels - 1) / kTexels; // one is for the snapping
  std::size_t held = 0;
  for (int x = 0; x <= 8; ++x)
    for (int y = 0; y <= 8; ++y)
      for (int d = 1; d <= 60; ++d) {
        const PrimaryRay ray = primaryRay(camera, glm::vec2(camera.sizePixels) * glm::vec2(x, y) / 8.0f);
        const double cosine = glm::dot(ray.directionWorld, -glm::vec3(camera.worldFromView[2]));
        const glm::dvec3 point = glm::dvec3(ray.originWorld) + (d / cosine) * glm::dvec3(ray.directionWorld);
        if (!kBounds.contains(glm::vec3(point))) continue;
        const auto slice =
            std::upper_bound(ends.begin() + 1, ends.end() - 1, static_cast<double>(d)) - ends.begin() - 1;
        const glm::dvec3 ndc = ndcOf(views[static_cast<std::size_t>(slice)], point);
        EXPECT_LE(std::max(std::abs(ndc.x), std::abs(ndc.y)), inner) << "depth " << d << " slice " << slice;
        EXPECT_GT(ndc.z, 0);
        EXPECT_LT(ndc.z, 1);
        ++held;
      }
  EXPECT_GT(held, 500u);
}

TEST(ShadowViews, CascadesGetFinerTowardsTheEye) {
  const auto views = makeShadowViews(lightOf(LightKind::Sun), cameraAt({2, 3, 20}), kBounds, kTexels);
  for (std::size_t i = 1; i < views.size(); ++i) EXPECT_LE(views[i - 1].texelSpan, views[i].texelSpan);
  EXPECT_LT(views[0].texelSpan, 0.2f * views[3].texelSpan);
}

// Whole texels: where a fixed point lies within its texel does not depend on the camera. Single precision rounds eyes
// at 40 m to 4e-6 m, a few thousandths of the finest texel here.
TEST(ShadowViews, TexelsStayInPlaceWhileTheCameraMoves) {
  const PosedLight sun = lightOf(LightKind::Sun);
  const auto first = makeShadowViews(sun, cameraAt({2, 3, 20}), kBounds, kTexels);
  const glm::dvec3 point(1.234, 0.5, 3.21);
  for (int step = 1; step <= 20; ++step) {
    const float turn = 0.01f * static_cast<float>(step);
    const View camera = cameraAt({2 + 0.0137f * static_cast<float>(step), 3, 20}, {0.3f + turn, -0.2f, -1});
    const auto moved = makeShadowViews(sun, camera, kBounds, kTexels);
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_FLOAT_EQ(moved[i].texelSpan, first[i].texelSpan) << "cascade " << i << " step " << step;
      const glm::dvec2 apart = 0.5 * kTexels * glm::dvec2(ndcOf(moved[i], point) - ndcOf(first[i], point));
      EXPECT_NEAR(apart.x, std::round(apart.x), 0.01) << "cascade " << i << " step " << step;
      EXPECT_NEAR(apart.y, std::round(apart.y), 0.01);
    }
  }
}

// A small scene seen from afar is held whole by all cascades, and no camera moves them at all.
TEST(ShadowViews, SmallScenesAreHeldWhole) {
  const Box small{{-1, 0, -1}, {1, 2, 1}};
  const PosedLight sun = lightOf(LightKind::Sun);
  const auto views = makeShadowViews(sun, cameraAt({0, 1, 6}, {0, 0, -1}), small, kTexels);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) ? 1 : -1, (corner & 2) ? 2 : 0, (corner & 4) ? 1 : -1);
    const glm::dvec3 ndc = ndcOf(views.back(), point);
    EXPECT_LE(std::max(std::abs(ndc.x), std::abs(ndc.y)), 1);
    EXPECT_GT(ndc.z, 0);
    EXPECT_LT(ndc.z, 1);
  }
  EXPECT_LT(views.back().texelSpan * kTexels, 3.9f); // the diagonal is 3.46 m
}

TEST(ShadowViews, SpotsHaveOneAndOthersSixWhereverTheyLook) {
  PosedLight spot = lightOf(LightKind::Spot, {0, -1, 0});
  spot.light.outerConeRadians = 0.6f;
  const auto one = makeShadowViews(spot, cameraAt({2, 3, 20}), kBounds, kTexels);
  ASSERT_EQ(one.size(), 1u);
  const glm::dvec3 onCone = glm::dvec3(spot.positionWorld) + glm::dvec3(3 * std::tan(0.6), -3, 0);
  EXPECT_NEAR(std::abs(ndcOf(one[0], onCone).x) + std::abs(ndcOf(one[0], onCone).y),
              1 - 2.0 * kShadowMarginTexels / kTexels, 1e-5);
  spot.light.outerConeRadians = 1.5f;
  EXPECT_EQ(makeShadowViews(spot, cameraAt({2, 3, 20}), kBounds, kTexels).size(), std::size_t{kCubeFaces});
  const auto cube = makeShadowViews(lightOf(LightKind::Sphere), cameraAt({2, 3, 20}), kBounds, kTexels);
  ASSERT_EQ(cube.size(), std::size_t{kCubeFaces});
  for (int face = 0; face < kCubeFaces; ++face) {
    glm::dvec3 way(0.3, 0.2, -0.4);
    way[face / 2] = face % 2 == 0 ? 1 : -1;
    const glm::dvec3 ndc = ndcOf(cube[static_cast<std::size_t>(face)], glm::dvec3(1, 4, 2) + 2.0 * way);
    EXPECT_LE(std::max(std::abs(ndc.x), std::abs(ndc.y)), 0.45) << face;
    EXPECT_GT(ndc.z, 0) << face;
  }
}

} // namespace
} // namespace brickfield
