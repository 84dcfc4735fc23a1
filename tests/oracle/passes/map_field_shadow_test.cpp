// Shadow maps that decide before anything is marched: their pyramid against brute force, and what they decide against
// closed forms of the light that a straight edge leaves free.
#include <cstdio>

#include "tests/oracle/passes/edge_scene.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{320, 240};
constexpr int kTexels = 512;

class MapFieldShadow : public GlTest {
protected:
  MapFieldShadow() : scene_(slabOverFloor(), "none"), view_(viewOfEdge(scene_, kSize)) {}

  static RendererSettings settingsOf(ShadowMethod method, int mapTexels = kTexels) {
    RendererSettings settings;
    settings.shadows.method = method;
    settings.shadowMaps.size = mapTexels;
    settings.worldField.shape = {1, 128, 0, true};
    settings.countersOn = true;
    return settings;
  }

  std::unique_ptr<Renderer> draw(const RendererSettings& settings, double degrees) const {
    auto renderer = scene_.makeRenderer(context().info(), settings);
    renderer->setLighting(overheadSun(scene_, degrees));
    renderer->render(view_);
    return renderer;
  }

  static double truthAt(const FloorSample& sample, double degrees) {
    const double spread = std::tan(0.5 * degrees * std::numbers::pi / 180);
    return shareBelow(sample.x / (spread * heightAt(sample.z, sample.x > 0)));
  }

  double rmseOf(const std::vector<FloorSample>& samples, double degrees) const {
    double squares = 0;
    std::size_t count = 0;
    for (const FloorSample& sample : samples) {
      if (std::abs(sample.x) > 0.4 || std::abs(sample.z) > 1) continue;
      const double difference = sample.visible - truthAt(sample, degrees);
      squares += difference * difference, ++count;
    }
    return std::sqrt(squares / static_cast<double>(count));
  }

  TestScene scene_;
  View view_;
};

// Each square's nearest and farthest depth, of sides that halve and of one with odd levels.
TEST_F(MapFieldShadow, RangesAreThoseOfTheirTexels) {
  for (const int side : {512, 100}) {
    const auto renderer = draw(settingsOf(ShadowMethod::MapsAndField, side), 8);
    for (int layer = 0; layer < kSunCascades; layer += kSunCascades - 1) {
      const std::vector<float> depths = renderer->readShadowMap(layer);
      std::size_t squares = 0, apart = 0;
      for (int level = 0, extent = side / 2; extent > 0; ++level, extent /= 2) {
        const std::vector<glm::vec2> ranges = renderer->readShadowRange(layer, level);
        ASSERT_EQ(ranges.size(), static_cast<std::size_t>(extent * extent)) << level;
        for (int y = 0; y < extent; ++y)
          for (int x = 0; x < extent; ++x) {
            const auto end = [&](int at) { return at == extent - 1 ? side : (at + 1) << (level + 1); };
            glm::vec2 expected(0, 1);
            for (int v = y << (level + 1); v < end(y); ++v)
              for (int u = x << (level + 1); u < end(x); ++u) {
                const float depth = depths[static_cast<std::size_t>(v * side + u)];
                expected = {std::max(expected.x, depth), std::min(expected.y, depth)};
              }
            ++squares, apart += expected.x > expected.y;
            ASSERT_EQ(ranges[static_cast<std::size_t>(y * extent + x)], expected) << side << " " << level;
          }
      }
      EXPECT_GT(apart, squares / 50) << "of some squares the depths differ";
    }
  }
}

// Of pixels for which nothing was read those that are wholly lit or dark are so by the closed form but for two texels
// of the map; between, where the slab is of nearly one height, the filter is right to a part of its 48 places.
TEST_F(MapFieldShadow, MapsDecideWhereTheyAreSure) {
  for (const double degrees : {2.0, 8.0, 16.0}) {
    const auto renderer = draw(settingsOf(ShadowMethod::MapsAndField), degrees);
    const double texel = renderer->shadowViews()[kSunCascades - 1].texelSpan;
    const std::vector<std::uint32_t> reads = renderer->readShadowReads();
    const FrameLayers frame = renderer->readLayers();
    std::size_t decided = 0, wrong = 0, floor = 0, between = 0;
    double squares = 0;
    for (std::size_t i = 0; i < reads.size(); ++i) {
      if (frame.kind[i] == SurfaceKind::None || frame.id[i] != 0) continue;
      const glm::vec2 pixel(static_cast<float>(i % kSize.x) + 0.5f, static_cast<float>(i / kSize.x) + 0.5f);
      const PrimaryRay ray = primaryRay(view_, pixel);
      const glm::vec3 point = ray.originWorld + frame.depth[i] * ray.directionWorld;
      if (std::abs(point.y) > 1e-3f || std::abs(point.z) > 1 || std::abs(point.x) > 1.1) continue;
      ++floor;
      if (reads[i] > 0) continue;
      ++decided;
      const float visible = frame.shadow.front()[i];
      if (visible > 0 && visible < 1) {
        const double difference = visible - truthAt({point.x, point.z, 0}, degrees);
        squares += difference * difference, ++between;
        continue;
      }
      const double step = (visible > 0 ? 2 : -2) * texel;
      wrong += std::abs(truthAt({point.x + step, point.z, 0}, degrees) - visible) > 1e-6;
    }
    const double rmse = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(between, 1)));
    std::printf("%g degrees: %zu of %zu floor pixels decided, %zu wrong; %zu in penumbrae, rmse %.4f\n", degrees,
                decided, floor, wrong, between, rmse);
    EXPECT_LE(rmse, 0.03);
    EXPECT_GT(floor, 10000u);
    EXPECT_GT(decided, floor / 2);
    EXPECT_EQ(wrong, 0u);
  }
}

// Penumbrae are as near to the truth as the field's, and less is read for them.
TEST_F(MapFieldShadow, PenumbraeAreNoWorseThanTheFields) {
  const auto both = draw(settingsOf(ShadowMethod::MapsAndField), 8), alone = draw(settingsOf(ShadowMethod::Field), 8);
  const double rmse = rmseOf(floorSamples(view_, both->readLayers()), 8);
  const double without = rmseOf(floorSamples(view_, alone->readLayers()), 8);
  const auto readsOfFloor = [](Renderer& renderer) {
    const std::vector<std::uint32_t> reads = renderer.readShadowReads();
    const FrameLayers frame = renderer.readLayers();
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < reads.size(); ++i)
      if (frame.id[i] == 0 && frame.normalSurface[i].y > 0.99f) sum += reads[i];
    return sum;
  };
  const std::uint64_t reads = readsOfFloor(*both), readsAlone = readsOfFloor(*alone);
  std::printf("rmse %.4f with maps, %.4f without; %llu and %llu reads of the floor\n", rmse, without,
              static_cast<unsigned long long>(reads), static_cast<unsigned long long>(readsAlone));
  EXPECT_LE(rmse, without + 0.001);
  EXPECT_LE(rmse, 0.025);            // as FieldShadow's
  EXPECT_LT(reads, readsAlone / 50); // sides along the light are marched with maps too
}

// Half a degree is nothing to a field of two centimetres: nothing is read, and the map's own disk of texels is at least
// as near to the truth as a blur over 15 texels.
TEST_F(MapFieldShadow, MapsAloneDecideForSmallSuns) {
  const auto small = draw(settingsOf(ShadowMethod::MapsAndField), 0.5);
  EXPECT_EQ(small->stats().counters.shadowReads, 0u);
  RendererSettings blurred = settingsOf(ShadowMethod::Maps);
  blurred.shadowMaps.filter = ShadowFilter::Evsm;
  const double rmse = rmseOf(floorSamples(view_, small->readLayers()), 0.5);
  const double evsm = rmseOf(floorSamples(view_, draw(blurred, 0.5)->readLayers()), 0.5);
  std::printf("0.5 degrees: rmse %.4f, EVSM %.4f\n", rmse, evsm);
  EXPECT_LE(rmse, evsm);
  EXPECT_LE(rmse, 0.1); // a texel of 8 mm is as wide as the penumbra: half of it wrong by a quarter in 0.02 of 0.8 m
}

} // namespace
} // namespace brickfield::test
