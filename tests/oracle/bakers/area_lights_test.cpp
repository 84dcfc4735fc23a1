// Soft shadows, area lights and ambient occlusion of the reference against closed forms and integrals.
#include <algorithm>
#include <functional>

#include "bakers/reference_lights.h"
#include "bakers/reference_samples.h"
#include "scene/brdf.h"
#include "tests/oracle/bakers/reference_scenes.h"

namespace brickfield::test {
namespace {

PosedLight sunOf(float degrees, glm::vec3 direction) {
  PosedLight sun = sunAlong(direction);
  sun.light.angleRadians = glm::radians(degrees);
  return sun;
}

PosedLight ballAt(glm::vec3 position, float radius, float candela = 100.0f) {
  PosedLight ball;
  ball.light.kind = LightKind::Sphere;
  ball.light.radius = radius;
  ball.light.intensity = candela;
  ball.positionWorld = position;
  return ball;
}

PosedLight panelAt(glm::vec3 position, glm::vec3 direction, glm::vec2 size, float candela) {
  PosedLight panel;
  panel.light.kind = LightKind::Rectangle;
  panel.light.size = size;
  panel.light.intensity = candela;
  panel.positionWorld = position;
  panel.directionWorld = glm::normalize(direction);
  panel.rightWorld = levelRightOf(panel.directionWorld);
  return panel;
}

Lighting lightOf(const PosedLight& light) {
  Lighting lighting = darkness();
  lighting.lights.push_back(light);
  return lighting;
}

/// What a request for shadows and occlusion with `samples` asks.
ReferenceRequest layersOf(int samples, std::uint64_t seed = 0) {
  ReferenceRequest request;
  request.samples = samples;
  request.seed = seed;
  request.shadowLayers = true;
  return request;
}

/// The ground, and `height` above it a wide sheet over x < 0 whose edge is the line x = 0.
/// Penumbrae take sizes near their height: shadow rays start off the ground by a rounding of all that a point is made
/// of.
Scene edgeScene(float height, float half = 200) {
  Scene scene = sceneOf({squarePrimitive(2 * half), squarePrimitive(half)});
  scene.nodes[1].translation = {-half, 0, height};
  return scene;
}

/// From between ground and sheet, along the edge: pixel columns go along x and span ±reach.
View viewUnderEdge(float height, float reach, glm::uvec2 size) {
  const glm::vec3 eye(0, -3.0f * reach, 0.9f * height);
  const float tangent = reach / glm::length(eye) * static_cast<float>(size.y) / static_cast<float>(size.x);
  return makePerspectiveView(eye, {0, 0, 0}, 2.0f * std::atan(tangent), 0.01f * height, size);
}

glm::vec3 surfaceAt(const FrameLayers& layers, const View& view, std::size_t i) {
  const PrimaryRay ray =
      primaryRay(view, {static_cast<float>(i % layers.size.x) + 0.5f, static_cast<float>(i / layers.size.x) + 0.5f});
  return ray.originWorld + layers.depth[i] * ray.directionWorld;
}

/// Share of a cap of half angle `capRadians` on the positive side of a plane through its sphere's centre, which passes
/// `offsetRadians` from the cap's axis: rings of equal solid angle, each cut at an angle of its own. Exact but for the
/// sum over rings.
double cutCap(double capRadians, double offsetRadians) {
  constexpr int kRings = 400;
  const double capCosine = std::cos(capRadians);
  double share = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double z = 1.0 - (1.0 - capCosine) * (ring + 0.5) / kRings, rho = std::sqrt(1.0 - z * z);
    share += 1.0 - std::acos(std::clamp(z * std::tan(offsetRadians) / rho, -1.0, 1.0)) / std::numbers::pi;
  }
  return share / kRings;
}

struct EdgeFit {
  double meanError = 0, worst = 0;
  double width = 0; ///< of the penumbra, as a share of the true one
  int pixels = 0;
};

/// Compares the shadow of an edge at x = 0 with `shareAt(x)`, and finds the stretch of x that fits best.
EdgeFit fitEdge(const FrameLayers& layers, const View& view, const std::function<double(double x)>& shareAt) {
  EdgeFit fit;
  std::vector<std::pair<double, double>> samples;
  for (std::size_t i = 0; i < layers.depth.size(); ++i) {
    if (layers.id[i] != 0) continue;
    const double x = surfaceAt(layers, view, i).x, share = shareAt(x), error = layers.shadow[0][i] - share;
    if (share <= 0.0 || share >= 1.0) {
      EXPECT_NEAR(error, 0.0, 1e-6) << "beyond the penumbra, at " << x;
      continue;
    }
    fit.meanError += error;
    fit.worst = std::max(fit.worst, std::abs(error));
    samples.emplace_back(x, layers.shadow[0][i]);
  }
  fit.pixels = static_cast<int>(samples.size());
  fit.meanError /= fit.pixels;
  double least = 1e30;
  for (double width = 0.9; width <= 1.1; width += 0.004) {
    double squares = 0;
    for (const auto& [x, share] : samples) squares += std::pow(shareAt(x / width) - share, 2);
    if (squares < least) least = squares, fit.width = width;
  }
  return fit;
}

} // namespace

// Ten heights of the edge, three suns: at x the edge stands atan(x / h) from the sun's centre, of which the cap on the
// far side is seen. 256 multi-jittered samples leave a deviation of some 0.5 * 256^-0.75 = 0.008 a pixel.
TEST(AreaLights, SunHasThePenumbraOfItsDisk) {
  for (const float degrees : {0.5f, 2.0f, 8.0f})
    for (const float height : {0.05f, 0.1f, 0.2f, 0.5f, 1.0f, 2.0f, 4.0f, 8.0f, 15.0f, 30.0f}) {
      const double half = glm::radians(0.5 * degrees);
      const View view = viewUnderEdge(height, static_cast<float>(1.2 * height * std::tan(half)), {48, 6});
      const FrameLayers layers =
          trace(edgeScene(height, 8 * height), view, lightOf(sunOf(degrees, {0, 0, -1})), layersOf(256));
      const EdgeFit fit = fitEdge(layers, view, [&](double x) { return cutCap(half, std::atan(x / height)); });
      SCOPED_TRACE(std::to_string(degrees) + " degrees, " + std::to_string(height) + " m");
      ASSERT_GT(fit.pixels, 60);
      EXPECT_NEAR(fit.meanError, 0.0, 0.003);
      EXPECT_LT(fit.worst, 0.04);
      EXPECT_NEAR(fit.width, 1.0, 0.01);
    }
}

// A ball of radius r at (0, 0, H): from x on the ground its cap has sine r / d, and the edge stands between the
// directions to the centre and to (0, 0, h).
TEST(AreaLights, SphereHasThePenumbraOfItsOutline) {
  for (const float radius : {0.05f, 0.2f, 0.6f})
    for (const float height : {0.3f, 0.6f, 1.0f, 1.6f, 2.2f}) {
      constexpr float kLamp = 3.0f;
      const float reach = radius * height / (kLamp - height) * 1.3f;
      const View view = viewUnderEdge(height, reach, {48, 6});
      const FrameLayers layers =
          trace(edgeScene(height, 8 * height), view, lightOf(ballAt({0, 0, kLamp}, radius)), layersOf(256));
      // The plane holds the edge and the point on the ground, so y changes the cap's size and the plane's angle.
      double meanError = 0, worst = 0, contrast = 0, expectedContrast = 0;
      int pixels = 0;
      for (std::size_t i = 0; i < layers.depth.size(); ++i) {
        if (layers.id[i] != 0) continue;
        const glm::dvec3 at(surfaceAt(layers, view, i)), towards = glm::dvec3(0, 0, kLamp) - at;
        const glm::dvec3 normal = glm::normalize(glm::dvec3(height, 0, at.x)); // square to the edge and to (-x, 0, h)
        const double offset = std::asin(glm::dot(normal, glm::normalize(towards)));
        const double share = cutCap(std::asin(radius / glm::length(towards)), offset);
        const double error = layers.shadow[0][i] - share;
        meanError += error, worst = std::max(worst, std::abs(error));
        if (share <= 0.0 || share >= 1.0) continue;
        contrast += (share - 0.5) * (layers.shadow[0][i] - 0.5), expectedContrast += (share - 0.5) * (share - 0.5);
        ++pixels;
      }
      SCOPED_TRACE(std::to_string(radius) + " m, edge at " + std::to_string(height));
      ASSERT_GT(pixels, 60);
      EXPECT_NEAR(meanError / pixels, 0.0, 0.003);
      EXPECT_LT(worst, 0.04);
      EXPECT_NEAR(contrast / expectedContrast, 1.0, 0.01) << "wider penumbrae have less";
    }
}

// A panel of width w at H, straight above the edge at h: its share beyond the edge, seen from x, is linear in x.
TEST(AreaLights, RectangleHasALinearPenumbra) {
  for (const float width : {0.1f, 0.5f, 2.0f}) {
    constexpr float kLamp = 3.0f, kEdge = 1.0f;
    const View view = viewUnderEdge(kEdge, 0.7f * width * kEdge / (kLamp - kEdge), {48, 6});
    const FrameLayers layers =
        trace(edgeScene(kEdge, 8), view, lightOf(panelAt({0, 0, kLamp}, {0, 0, -1}, {width, 0.3f}, 10)), layersOf(256));
    const EdgeFit fit = fitEdge(layers, view, [&](double x) {
      // The line of sight over the edge meets the lamp's plane at x (1 - H / h); what lies beyond, towards +x, is seen.
      return std::clamp(0.5 - x * (1.0 - kLamp / kEdge) / width, 0.0, 1.0);
    });
    SCOPED_TRACE(width);
    ASSERT_GT(fit.pixels, 60);
    EXPECT_NEAR(fit.meanError, 0.0, 0.003);
    EXPECT_NEAR(fit.width, 1.0, 0.01);
  }
}

// Means over the samples of irradiance times the cosine at the receiver, against form factors.
TEST(AreaLights, IrradianceIsThatOfTheWholeLight) {
  const auto irradiance = [](const PosedLight& light, glm::vec3 point, glm::vec3 normal) {
    constexpr int kCount = 16384;
    const PixelSamples samples({3, 4}, 7, kCount);
    double sum = 0;
    for (int i = 0; i < kCount; ++i) {
      const LightArrival arrival = sampleLight(light, point, samples.point(i, SamplePurpose::Light));
      sum += arrival.irradiance.x * std::max(0.0f, glm::dot(arrival.towardsLight, normal));
    }
    return sum / kCount;
  };
  const glm::vec3 up(0, 0, 1);
  // A sun of E lux, whatever its disk; a ball of I / d² by the cosine, as long as all of it stands above the horizon.
  for (const float degrees : {0.0f, 0.5f, 8.0f, 60.0f})
    EXPECT_NEAR(irradiance(sunOf(degrees, {1, 0, -1}), {}, up), kPi * std::sqrt(0.5), 2e-4) << degrees;
  for (const float radius : {0.0f, 0.01f, 0.5f, 1.4f})
    EXPECT_NEAR(irradiance(ballAt({2, 0, 2}, radius), {}, up), 100.0 / 8.0 * std::sqrt(0.5), 2e-3) << radius;
  // Form factor of a parallel rectangle over its corner (Siegel and Howell), a and b its sides by the distance.
  const auto corner = [](double a, double b) {
    const double sa = std::sqrt(1 + a * a), sb = std::sqrt(1 + b * b);
    return (a / sa * std::atan(b / sa) + b / sb * std::atan(a / sb)) / (2 * std::numbers::pi);
  };
  for (const auto& [width, height, distance] : {std::tuple(1.0f, 1.0f, 1.0f), std::tuple(4.0f, 0.5f, 0.7f),
                                                std::tuple(3.0f, 3.0f, 0.5f), std::tuple(0.01f, 0.02f, 2.0f)}) {
    const double radiance = 50.0 / (width * height);
    const double expected = std::numbers::pi * radiance * 4 * corner(0.5 * width / distance, 0.5 * height / distance);
    const double aside = std::numbers::pi * radiance * corner(width / distance, height / distance);
    const PosedLight panel = panelAt({0, 0, distance}, {0, 0, -1}, {width, height}, 50);
    EXPECT_NEAR(irradiance(panel, {}, up) / expected, 1.0, 2e-3) << width << "x" << height << " at " << distance;
    EXPECT_NEAR(irradiance(panel, {0.5f * width, 0.5f * height, 0}, up) / aside, 1.0, 2e-3);
    EXPECT_EQ(irradiance(panel, {0, 0, 2 * distance}, -up), 0.0) << "dark behind";
  }
}

// The picture of a lit plane, against the BRDF integrated over the panel by midpoints.
TEST(AreaLights, PictureIsTheBrdfIntegratedOverTheLight) {
  Scene scene = sceneOf({squarePrimitive(10)});
  scene.materials[0].baseColor = {0.5f, 0.25f, 1.0f, 1.0f};
  scene.materials[0].roughness = 0.5f;
  const PosedLight panel = panelAt({0.3f, 0.5f, 1.5f}, {-0.2f, 0, -1}, {1.5f, 0.5f}, 20);
  const View view = makePerspectiveView({0, -1, 3}, {0, 0, 0}, 0.03f, 0.01f, {3, 3});
  const FrameLayers layers = trace(scene, view, lightOf(panel), 4096);
  glm::dvec3 expected(0);
  constexpr int kPixelSteps = 4, kLightSteps = 128;
  const SurfaceBrdf brdf = makeBrdf(glm::vec3(0.5f, 0.25f, 1.0f), 0, 0.5f);
  for (int i = 0; i < kPixelSteps * kPixelSteps; ++i) {
    const glm::vec2 inPixel((static_cast<float>(i % kPixelSteps) + 0.5f) / kPixelSteps,
                            (static_cast<float>(i / kPixelSteps) + 0.5f) / kPixelSteps);
    const PrimaryRay ray = primaryRay(view, glm::vec2(1) + inPixel);
    const glm::vec3 point = ray.originWorld - ray.directionWorld * (ray.originWorld.z / ray.directionWorld.z);
    for (int j = 0; j < kLightSteps * kLightSteps; ++j) {
      const glm::vec2 onLight((static_cast<float>(j % kLightSteps) + 0.5f) / kLightSteps,
                              (static_cast<float>(j / kLightSteps) + 0.5f) / kLightSteps);
      const LightArrival arrival = sampleLight(panel, point, onLight);
      expected += glm::dvec3(evaluateBrdf(brdf, {0, 0, 1}, -ray.directionWorld, arrival.towardsLight) *
                             arrival.irradiance * arrival.towardsLight.z);
    }
  }
  expected /= kPixelSteps * kPixelSteps * kLightSteps * kLightSteps;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(layers.color[4][c] / expected[c], 1.0, 2e-3) << c;
}

// Under an edge at x = 0 in a sun of 8 degrees: residuals against the truth over many pixels and seeds. Unbiased: their
// mean is 0 within four deviations. Four times the samples leave a quarter of the variance or less: stratification is
// never worse than chance (with 15 % for the estimate of a variance from 2,000 residuals).
TEST(AreaLights, ErrorsAverageOutAndShrink) {
  const double half = glm::radians(4.0);
  const View view = viewUnderEdge(1.0f, static_cast<float>(std::tan(half)), {48, 8});
  const Scene scene = edgeScene(1.0f);
  const Lighting lighting = lightOf(sunOf(8, {0, 0, -1}));
  double last = 1e30;
  for (const int count : {1, 4, 16, 64}) {
    double sum = 0, squares = 0;
    int pixels = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const FrameLayers layers = trace(scene, view, lighting, layersOf(count, seed));
      for (std::size_t i = 0; i < layers.depth.size(); ++i) {
        const double share = cutCap(half, std::atan(double{surfaceAt(layers, view, i).x}));
        if (layers.id[i] != 0 || share <= 0 || share >= 1) continue;
        const double error = layers.shadow[0][i] - share;
        sum += error, squares += error * error;
        ++pixels;
      }
    }
    ASSERT_GT(pixels, 2000);
    const double variance = squares / pixels;
    EXPECT_NEAR(sum / pixels, 0.0, 4 * std::sqrt(variance / pixels)) << count;
    EXPECT_LT(variance, last / 4 * 1.15) << count;
    last = variance;
  }
}

// The same for pictures: the mean over seeds of few samples is what many give, pixel edges and penumbra together.
TEST(AreaLights, PicturesOfFewSamplesAverageToThoseOfMany) {
  const Scene scene = edgeScene(1.0f);
  const Lighting lighting = lightOf(sunOf(20, {0.2f, 0, -1}));
  const View view = viewFrom({2, -3, 3}, {0, 0, 0.5f}, {6, 6});
  const FrameLayers truth = trace(scene, view, lighting, 16384);
  constexpr int kSeeds = 400;
  std::vector<double> sums(36, 0.0), squares(36, 0.0);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    ReferenceRequest request;
    request.samples = 2;
    request.seed = seed;
    const FrameLayers few = trace(scene, view, lighting, request);
    for (std::size_t i = 0; i < 36; ++i) sums[i] += few.color[i].x, squares[i] += std::pow(few.color[i].x, 2);
  }
  int noisy = 0;
  for (std::size_t i = 0; i < 36; ++i) {
    const double mean = sums[i] / kSeeds, deviation = std::sqrt(std::max(0.0, squares[i] / kSeeds - mean * mean));
    noisy += deviation > 0.05;
    EXPECT_NEAR(mean, truth.color[i].x, 4.5 * deviation / std::sqrt(double{kSeeds}) + 2e-3) << i;
  }
  EXPECT_GT(noisy, 4) << "there is something to average";
}

// At a wall of height H and no end, x away from it, the hemisphere is open by (1 + x / sqrt(x² + H²)) / 2: one half at
// its foot. Where two walls meet, a quarter.
TEST(AmbientOcclusion, CornersHaveTheirClosedForms) {
  Scene scene = sceneOf({squarePrimitive(2000), squarePrimitive(2000)});
  scene.materials[0].doubleSided = true;
  const float height = 1.0f;
  scene.nodes[1].rotation = glm::angleAxis(kPi / 2, glm::vec3(0, 1, 0)); // the plane x = 0
  scene.nodes[1].translation = {0, 0, height - 2000};
  ReferenceRequest request = layersOf(1024);
  request.ambientOcclusionMetres = std::numeric_limits<float>::infinity();
  const auto openAt = [&](float x, float y = 0) {
    // One pixel from far above, aimed at the point; from the side of the wall that it stands on.
    const View view = viewFrom({x + 0.5f, y + 0.1f, 3}, {x, y, 0}, {1, 1});
    const FrameLayers layers = trace(scene, view, darkness(), request);
    EXPECT_EQ(layers.id[0], 0);
    return layers.ambientOcclusion[0];
  };
  // 1,024 multi-jittered samples deviate by some 0.5 * 1024^-0.75 = 0.003.
  for (const float x : {0.001f, 0.1f, 0.3f, 1.0f, 3.0f, 30.0f})
    EXPECT_NEAR(openAt(x), 0.5 * (1 + x / std::hypot(x, height)), 0.01) << x;
  scene.nodes[1].translation = {0, 0, 0};
  EXPECT_NEAR(openAt(0.001f), 0.5, 0.01);
  scene.meshes.push_back(scene.meshes[1]);
  Node side;
  side.mesh = 2;
  side.rotation = glm::angleAxis(kPi / 2, glm::vec3(1, 0, 0)); // the plane y = 0
  scene.scenes[0].nodes.push_back(2);
  scene.nodes.push_back(side);
  EXPECT_NEAR(openAt(0.001f, 0.001f), 0.25, 0.01);
}

TEST(AmbientOcclusion, RadiusEndsIt) {
  // In the middle of the floor under a lid at 1 m that has no end, all of the sky is hidden; with a radius, what lies
  // within it: directions steeper than acos(1 / R), whose share by the cosine is 1 - 1 / R².
  Scene scene = sceneOf({squarePrimitive(500), squarePrimitive(500)});
  scene.nodes[1].translation = {0, 0, 1};
  scene.materials[0].doubleSided = true;
  const View view = viewFrom({0.1f, -0.2f, 0.8f}, {0, 0, 0}, {5, 5});
  const auto open = [&](float radius) {
    ReferenceRequest request = layersOf(1024);
    request.ambientOcclusionMetres = radius;
    return trace(scene, view, darkness(), request).ambientOcclusion[12];
  };
  EXPECT_EQ(open(0.9f), 1.0f);
  for (const float radius : {1.2f, 2.0f, 4.0f}) EXPECT_NEAR(open(radius), 1 / (radius * radius), 0.01) << radius;
  EXPECT_NEAR(open(std::numeric_limits<float>::infinity()), 0.0, 1e-3);
}

TEST(AmbientOcclusion, DimsTheEnvironmentAlone) {
  // White floor at the foot of a wall: half of the environment's light, all of the sun's.
  Scene scene = sceneOf({squarePrimitive(100), squarePrimitive(100)});
  scene.materials[0].doubleSided = true;
  scene.nodes[1].rotation = glm::angleAxis(kPi / 2, glm::vec3(0, 1, 0));
  Lighting lighting = lightOf(sunAlong({-0.1f, 0, -1}));
  lighting.environment.radiance.assign(8, glm::vec3(1.0f));
  const View view = viewFrom({1, 0, 2}, {0.01f, 0, 0}, {1, 1});
  const View tiny = makePerspectiveView({1, 0, 2}, {0.01f, 0, 0}, 0.001f, 0.01f, {1, 1});
  ReferenceRequest request;
  request.samples = 4096;
  const float with = trace(scene, tiny, lighting, request).color[0].x;
  Lighting dark = lighting;
  dark.environment = darkness().environment;
  const float sunAlone = trace(scene, tiny, dark, request).color[0].x;
  request.ambientOcclusionMetres = 50.0f;
  const FrameLayers dimmed = trace(scene, tiny, lighting, request);
  EXPECT_NEAR(dimmed.color[0].x - sunAlone, dimmed.ambientOcclusion[0] * (with - sunAlone), 0.01);
  EXPECT_NEAR(dimmed.ambientOcclusion[0], 0.5, 0.01);
  EXPECT_EQ(trace(scene, view, lighting, request).ambientOcclusion.size(), 1u);
}

TEST(ShadowLayers, AreOneALightAndSkyIsLit) {
  Scene scene = edgeScene(1.0f);
  Lighting lighting = lightOf(sunOf(0, {0, 0, -1}));
  lighting.lights.push_back(ballAt({5, 0, 3}, 0));
  lighting.lights.push_back(panelAt({0, 0, -5}, {0, 0, 1}, {1, 1}, 1)); // below the ground
  const View view = viewFrom({0, -4, 0.5f}, {0, 0, 0.5f}, {31, 31});
  const FrameLayers layers = trace(scene, view, lighting, layersOf(4));
  ASSERT_EQ(layers.shadow.size(), 3u);
  int sky = 0, lit = 0, dark = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    if (layers.id[i] < 0) {
      ++sky;
      for (const auto& shadow : layers.shadow) ASSERT_EQ(shadow[i], 1.0f);
    }
    if (layers.id[i] != 0) continue;
    const glm::vec3 at = surfaceAt(layers, view, i);
    if (std::abs(at.x) < 1e-3f) continue;
    ASSERT_EQ(layers.shadow[0][i], at.x > 0 ? 1.0f : 0.0f);
    (at.x > 0 ? lit : dark)++;
    ASSERT_EQ(layers.shadow[1][i], at.x > -2.5f ? 1.0f : 0.0f) << at.x; // over the edge at (0, 1) from (5, 3)
    ASSERT_EQ(layers.shadow[2][i], 0.0f) << "below the horizon";
  }
  EXPECT_GT(std::min({sky, lit, dark}), 20);
  ReferenceRequest none = layersOf(4);
  none.shadows = false;
  EXPECT_TRUE(trace(scene, view, lighting, none).shadow.empty());
  EXPECT_TRUE(trace(scene, view, lighting, 1).shadow.empty());
  EXPECT_TRUE(trace(scene, view, lighting, 1).ambientOcclusion.empty());
}

TEST(ShadowLayers, HolesOfMasksLetSoftLightThrough) {
  // The sheet's texture is a hole for x < -200 (its left half), so the light comes from the left again under its
  // middle.
  Scene scene = edgeScene(1.0f);
  scene.images.push_back({"", {2, 1}, {255, 255, 255, 0, 255, 255, 255, 255}});
  scene.textures.emplace_back();
  scene.textures[0].image = 0;
  scene.textures[0].magnify = scene.textures[0].minify = Filter::Nearest;
  scene.textures[0].mipmap.reset();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].baseColorTexture.texture = 0;
  scene.materials[1].alphaMode = AlphaMode::Mask;
  scene.meshes[1].primitives[0].material = 1;
  const double half = glm::radians(4.0);
  View view = makePerspectiveView({-200, -0.3f, 0.9f}, {-200, 0, 0}, 0.02f, 0.01f, {48, 6});
  const FrameLayers layers = trace(scene, view, lightOf(sunOf(8, {0, 0, -1})), layersOf(256));
  int between = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    ASSERT_EQ(layers.id[i], 0);
    const double x = surfaceAt(layers, view, i).x + 200.0;
    EXPECT_NEAR(layers.shadow[0][i], cutCap(half, -std::atan(x)), 0.04) << x;
    between += layers.shadow[0][i] > 0 && layers.shadow[0][i] < 1;
  }
  EXPECT_GT(between, 100);
}

TEST(ShadowLayers, APanelInTheCeilingIsNotShadowedByIt) {
  Scene scene = sceneOf({squarePrimitive(20), squarePrimitive(20)});
  scene.nodes[1].translation = {0, 0, 2.7f};
  scene.materials[0].doubleSided = true;
  const Lighting lighting = lightOf(panelAt({0.3f, 0.1f, 2.7f}, {0, 0, -1}, {1, 1}, 10));
  const View view = viewFrom({0, -3, 1}, {0, 0, 0}, {32, 32});
  const FrameLayers layers = trace(scene, view, lighting, layersOf(64));
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    if (layers.id[i] != 0) continue;
    ASSERT_EQ(layers.shadow[0][i], 1.0f) << i;
  }
}

TEST(SoftLight, ThreadsChangeNothing) {
  const Scene scene = edgeScene(1.0f);
  Lighting lighting = makeLighting({}, {"sun:0.1,0,-1:10:3", "sphere:1,2,3:0.5:9", "rectangle:2,0,4:0,0,-1:1,2:9"}, {});
  const View view = viewFrom({2, -4, 3}, {0, 0, 0}, {67, 35});
  ReferenceRequest request = layersOf(5, 42);
  request.ambientOcclusionMetres = 2.0f;
  request.threads = 1;
  const FrameLayers one = trace(scene, view, lighting, request);
  request.threads = 0;
  const FrameLayers all = trace(scene, view, lighting, request);
  request.seed = 43;
  const FrameLayers other = trace(scene, view, lighting, request);
  EXPECT_EQ(one.color, all.color);
  EXPECT_EQ(one.shadow, all.shadow);
  EXPECT_EQ(one.ambientOcclusion, all.ambientOcclusion);
  EXPECT_EQ(one.depth, other.depth);
  EXPECT_NE(one.color, other.color) << "the seed is felt";
  EXPECT_NE(one.shadow, other.shadow);
  EXPECT_NE(one.ambientOcclusion, other.ambientOcclusion);
}

TEST(SoftLight, CentresGiveHardShadows) {
  const Scene scene = edgeScene(1.0f);
  const Lighting soft = lightOf(sunOf(20, {0, 0, -1})), hard = lightOf(sunOf(0, {0, 0, -1}));
  const View view = viewFrom({2, -3, 3}, {0, 0, 0.5f}, {33, 33});
  ReferenceRequest request;
  request.lightsFromCentres = true;
  EXPECT_EQ(trace(scene, view, soft, request).color, trace(scene, view, hard, 1).color);
  request = {};
  request.shadows = false;
  EXPECT_EQ(trace(scene, view, soft, request).color, trace(scene, view, hard, request).color);
  EXPECT_NE(trace(scene, view, soft, 1).color, trace(scene, view, hard, 1).color);
}

} // namespace brickfield::test
