// Shadows from the world field against closed forms: the share of a sun's disk that a straight edge leaves free.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{320, 240};

// A slab over a floor; its edge runs along z at x = 0, rising from 0.2 to 1.1 m, the slab lies on the side of -x.
constexpr float kHalfThick = 0.02f, kSlope = 0.375f, kMiddle = 0.65f;
double heightAt(double z, bool ofTop) {
  const double thick = kHalfThick * std::sqrt(1 + double{kSlope} * kSlope);
  return kMiddle + kSlope * z + (ofTop ? thick : -thick);
}

Scene slabOverFloor() {
  Scene scene;
  scene.scenes.push_back({"scene", {0, 1}});
  Node floor;
  floor.name = "Floor";
  floor.mesh = 0;
  floor.matrix = glm::translate(glm::mat4(1), {0, -0.1f, 0});
  Node slab;
  slab.name = "Slab";
  slab.mesh = 1;
  slab.matrix = glm::rotate(glm::translate(glm::mat4(1), {-0.6f, kMiddle, 0}), -std::atan(kSlope), {1, 0, 0});
  scene.nodes = {floor, slab};
  scene.meshes = {makeBoxMesh({1.2f, 0.1f, 1.2f}), makeBoxMesh({0.6f, kHalfThick, 1.4f})};
  return scene;
}

// Of a disk of radius 1 that is cut at s, the part below s.
double shareBelow(double s) {
  if (s <= -1) return 0;
  if (s >= 1) return 1;
  return 0.5 + (s * std::sqrt(1 - s * s) + std::asin(s)) / std::numbers::pi;
}

class FieldShadow : public GlTest {
protected:
  FieldShadow() : scene_(slabOverFloor(), "none"), view_(scene_.view({1.9f, 0.55f, 0}, {0, 0, 0}, kSize, 70)) {}

  FrameLayers draw(double degrees, ShadowMethod method) const {
    RendererSettings settings;
    settings.shadows.method = method;
    settings.worldField.shape = {1, 128, 0, true};
    const auto renderer = scene_.makeRenderer(context().info(), settings);
    Environment black;
    black.size = {1, 1};
    black.radiance = {glm::vec3(0)};
    renderer->setLighting(
        makeLighting(scene_.pose(), {"sun:0,-1,0:" + std::to_string(degrees) + ":3.14159265"}, black));
    renderer->render(view_);
    return renderer->readLayers();
  }

  TestScene scene_;
  View view_;
};

struct FloorSample {
  double x, z, visible;
};

TEST_F(FieldShadow, PenumbraeUnderAnEdgeHaveTheirWidth) {
  for (const double degrees : {8.0, 16.0}) {
    const double spread = std::tan(0.5 * degrees * std::numbers::pi / 180);
    const FrameLayers lit = draw(degrees, ShadowMethod::None), shadowed = draw(degrees, ShadowMethod::Field);
    std::vector<FloorSample> samples;
    for (std::uint32_t y = 0; y < kSize.y; ++y)
      for (std::uint32_t x = 0; x < kSize.x; ++x) {
        const std::size_t i = std::size_t{y} * kSize.x + x;
        if (lit.id[i] != 0 || lit.kind[i] == SurfaceKind::None || lit.color[i].y <= 0) continue;
        const PrimaryRay ray = primaryRay(view_, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
        const glm::vec3 point = ray.originWorld + lit.depth[i] * ray.directionWorld;
        if (std::abs(point.y) > 1e-3f || std::abs(point.z) > 1.1f) continue;
        samples.push_back({point.x, point.z, shadowed.color[i].y / lit.color[i].y});
      }
    ASSERT_GT(samples.size(), 5000u);
    const double texel = 2.4 / 128; // of a field that holds the floor, about
    double squares = 0;
    std::size_t count = 0;
    for (int step = 0; step < 10; ++step) {
      const double z = -0.4 + 0.155 * step;
      // Widths as the integral of 4 v (1 - v) over x, which is a multiple of the penumbra's.
      const auto truth = [&](double x) { return shareBelow(x / (spread * heightAt(z, x > 0))); };
      std::vector<FloorSample> row;
      for (const FloorSample& sample : samples)
        if (std::abs(sample.z - z) < 0.03 && std::abs(sample.x) < 0.4) row.push_back(sample);
      std::sort(row.begin(), row.end(), [](auto& a, auto& b) { return a.x < b.x; });
      ASSERT_GT(row.size(), 50u);
      double width = 0, expected = 0, offset = 0;
      for (std::size_t i = 1; i < row.size(); ++i) {
        const double dx = row[i].x - row[i - 1].x, v = row[i].visible, t = truth(row[i].x);
        width += 4 * v * (1 - v) * dx;
        expected += 4 * t * (1 - t) * dx;
        offset += (t - v) * dx;
        squares += (v - t) * (v - t);
        ++count;
      }
      std::printf("%g degrees, edge %.2f m above: width %.4f, expected %.4f, shifted by %.4f m\n", degrees,
                  heightAt(z, false), width, expected, offset);
      EXPECT_NEAR(width, expected, 0.13 * expected) << z; // of texels as wide as a quarter of it
      EXPECT_LE(std::abs(offset), 0.5 * texel) << z;
    }
    const double rmse = std::sqrt(squares / static_cast<double>(count));
    std::printf("%g degrees: rmse %.4f\n", degrees, rmse);
    EXPECT_LE(rmse, 0.02);
  }
}

// Nothing is above the floor in front of the slab, and nothing shines through the slab: no acne, no leak.
TEST_F(FieldShadow, LitFloorsAreLitAndUmbraeAreDark) {
  const FrameLayers lit = draw(0.5, ShadowMethod::None), shadowed = draw(0.5, ShadowMethod::Field);
  std::size_t free = 0, speckled = 0, covered = 0, leaking = 0;
  for (std::uint32_t y = 0; y < kSize.y; ++y)
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      const std::size_t i = std::size_t{y} * kSize.x + x;
      if (lit.id[i] != 0 || lit.kind[i] == SurfaceKind::None || lit.color[i].y <= 0) continue;
      const PrimaryRay ray = primaryRay(view_, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      const glm::vec3 point = ray.originWorld + lit.depth[i] * ray.directionWorld;
      const float visible = shadowed.color[i].y / lit.color[i].y;
      if (std::abs(point.y) > 1e-3f || std::abs(point.z) > 1.1f) continue;
      if (point.x > 0.06f && point.x < 1.1f) ++free, speckled += visible < 0.98f;
      if (point.x < -0.06f && point.x > -1.1f) ++covered, leaking += visible > 0.02f;
    }
  ASSERT_GT(free, 3000u);
  ASSERT_GT(covered, 1000u);
  EXPECT_EQ(speckled, 0u);
  EXPECT_EQ(leaking, 0u);
}

} // namespace
} // namespace brickfield::test
