// The published estimators under a straight edge, where each has a closed form: what it says, not what is true.
#include <cstdio>

#include "tests/oracle/passes/edge_scene.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{240, 180};
constexpr double kDegrees = 16;

class ShadowEstimators : public GlTest {
protected:
  ShadowEstimators() : scene_(slabOverFloor(), "none"), view_(viewOfEdge(scene_, kSize)) {}

  // Those of the floor, none nearer than this to the slab's ends.
  std::vector<FloorSample> draw(ShadowEstimator estimator) {
    RendererSettings settings;
    settings.shadows.method = ShadowMethod::Field;
    settings.shadows.estimator = estimator;
    settings.worldField.shape = {1, 128, 0, true};
    if (!renderer_) renderer_ = scene_.makeRenderer(context().info(), settings);
    renderer_->setSettings(settings);
    renderer_->setLighting(overheadSun(scene_, kDegrees));
    renderer_->render(view_);
    std::vector<FloorSample> samples = floorSamples(view_, renderer_->readLayers());
    std::erase_if(samples, [](const FloorSample& s) { return std::abs(s.z) > 0.8 || s.x < -0.9 || s.x > 0.9; });
    EXPECT_GT(samples.size(), 3000u);
    return samples;
  }

  struct Difference {
    double mean = 0, rmse = 0;
  };
  template <typename Expected>
  static Difference compare(const char* name, const std::vector<FloorSample>& samples, const Expected& expected) {
    Difference difference;
    for (const FloorSample& sample : samples) {
      const double d = sample.visible - expected(sample);
      difference.mean += d;
      difference.rmse += d * d;
    }
    difference.mean /= static_cast<double>(samples.size());
    difference.rmse = std::sqrt(difference.rmse / static_cast<double>(samples.size()));
    std::printf("%-10s mean %+.4f rmse %.4f against its closed form\n", name, difference.mean, difference.rmse);
    return difference;
  }

  // The least distance to the edge a metre of the way along a vertical ray, over the light's spread. With c the cosine
  // of the edge's slope and H its height, the square of (x² + c²(H - t)²) / t² is least at t = (x² + c²H²) / c²H.
  static double ratio(const FloorSample& sample) {
    const double c = 1 / std::sqrt(1 + double{kSlope} * kSlope), height = c * heightAt(sample.z, true);
    const double spread = std::tan(0.5 * kDegrees * std::numbers::pi / 180);
    return c * sample.x / std::sqrt(sample.x * sample.x + height * height) / spread;
  }

  TestScene scene_;
  View view_;
  std::unique_ptr<Renderer> renderer_;
};

// A texel of blur at the edge: of some 1.8 m that are seen of x, 0.02 m are it, so 0.6 % of the pixels may be wrong.
TEST_F(ShadowEstimators, HardIsAStep) {
  const Difference d = compare("hard", draw(ShadowEstimator::Hard), [](auto& s) { return s.x > 0 ? 1.0 : 0.0; });
  EXPECT_LE(d.rmse, 0.08);
}

// Steps stop beside the least value, so that it is missed by what makes the known bands: too light, never too dark by
// more than a texel.
TEST_F(ShadowEstimators, MinRatioIsItsClosedForm) {
  const Difference d =
      compare("min-ratio", draw(ShadowEstimator::MinRatio), [](auto& s) { return std::clamp(ratio(s), 0.0, 1.0); });
  EXPECT_LE(d.rmse, 0.06);
  EXPECT_GT(d.mean, -0.01);
}

// Between two samples it takes one that would have been darker.
TEST_F(ShadowEstimators, RtsdfIsTheSameAndDarker) {
  const auto expected = [](auto& s) { return std::clamp(ratio(s), 0.0, 1.0); };
  const Difference d = compare("rtsdf", draw(ShadowEstimator::Rtsdf), expected);
  const Difference plain = compare("min-ratio", draw(ShadowEstimator::MinRatio), expected);
  EXPECT_LE(d.rmse, 0.05);
  EXPECT_LT(d.mean, plain.mean);
}

// Under the slab its depth is never more than half its thickness: light leaks in.
TEST_F(ShadowEstimators, CoverageIsItsClosedFormAndLeaks) {
  const double spread = std::tan(0.5 * kDegrees * std::numbers::pi / 180);
  const Difference d = compare("coverage", draw(ShadowEstimator::Coverage), [&](auto& s) {
    if (s.x >= 0) return shareBelow(ratio(s));
    return shareBelow(-std::min(-s.x, double{kHalfThick}) / (spread * heightAt(s.z, false)));
  });
  EXPECT_LE(d.rmse, 0.06);
}

// Random rays to the light: right on average but for their weights, with the noise of sixteen.
TEST_F(ShadowEstimators, UmbraIsTheTruthWithNoise) {
  const double spread = std::tan(0.5 * kDegrees * std::numbers::pi / 180);
  const Difference d = compare("umbra", draw(ShadowEstimator::Umbra),
                               [&](auto& s) { return shareBelow(s.x / (spread * heightAt(s.z, s.x > 0))); });
  EXPECT_LE(d.rmse, 0.13); // one of sixteen, at most 0.125 in a penumbra
  EXPECT_LE(std::abs(d.mean), 0.05);
}

} // namespace
} // namespace brickfield::test
