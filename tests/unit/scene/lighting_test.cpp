// Light texts, environments, harmonics and prefiltering against closed forms.
#include "scene/lighting.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/light_arrival.h"
#include "scene/prefiltered_environment.h"

using namespace brickfield;

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Environment constantEnvironment(glm::uvec2 size, glm::vec3 radiance) {
  Environment environment;
  environment.size = size;
  environment.radiance.assign(std::size_t{size.x} * size.y, radiance);
  return environment;
}

/// Radiance that is a function of the direction, sampled at texel centres.
template <typename Function>
Environment environmentOf(glm::uvec2 size, Function radianceOf) {
  Environment environment;
  environment.size = size;
  for (std::uint32_t row = 0; row < size.y; ++row)
    for (std::uint32_t column = 0; column < size.x; ++column) {
      const float azimuth = ((static_cast<float>(column) + 0.5f) / static_cast<float>(size.x) - 0.5f) * 2.0f * kPi;
      const float polar = (static_cast<float>(row) + 0.5f) / static_cast<float>(size.y) * kPi;
      environment.radiance.push_back(radianceOf(
          glm::vec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth))));
    }
  return environment;
}

const std::array<glm::vec3, 5> kDirections{glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0),
                                           glm::normalize(glm::vec3(1, 2, -3)), glm::normalize(glm::vec3(-5, -1, 2))};

Lighting lightingOf(const std::vector<std::string>& texts) { return makeLighting({}, texts, {}); }

} // namespace

TEST(Lighting, SunTextIsReadWhole) {
  const Lighting lighting = lightingOf({"sun:0,-2,0:1.5:1000"});
  ASSERT_EQ(lighting.lights.size(), 1u);
  const PosedLight& sun = lighting.lights[0];
  EXPECT_EQ(sun.light.kind, LightKind::Sun);
  EXPECT_EQ(sun.directionWorld, glm::vec3(0, -1, 0));
  EXPECT_FLOAT_EQ(sun.light.angleRadians, glm::radians(1.5f));
  EXPECT_EQ(sun.light.intensity, 1000.0f);
  EXPECT_EQ(sun.node, -1);
}

TEST(Lighting, SphereTextIsReadWhole) {
  const Lighting lighting = lightingOf({"sphere:1,2,-3.5:0.25:80", "sun:1,0,0:0:0"});
  ASSERT_EQ(lighting.lights.size(), 2u);
  EXPECT_EQ(lighting.lights[0].light.kind, LightKind::Sphere);
  EXPECT_EQ(lighting.lights[0].positionWorld, glm::vec3(1, 2, -3.5f));
  EXPECT_EQ(lighting.lights[0].light.radius, 0.25f);
  EXPECT_EQ(lighting.lights[0].light.intensity, 80.0f);
}

TEST(Lighting, RectangleTextIsReadWhole) {
  const PosedLight light = lightingOf({"rectangle:1,2,3:0,-0.5,0:0.5,2:80"}).lights.at(0);
  EXPECT_EQ(light.light.kind, LightKind::Rectangle);
  EXPECT_EQ(light.positionWorld, glm::vec3(1, 2, 3));
  EXPECT_EQ(light.directionWorld, glm::vec3(0, -1, 0));
  EXPECT_EQ(light.rightWorld, glm::vec3(1, 0, 0)) << "straight down: along X";
  EXPECT_EQ(light.light.size, glm::vec2(0.5f, 2));
  EXPECT_EQ(light.light.intensity, 80.0f);
  const PosedLight slanted = lightingOf({"rectangle:0,0,0:1,-1,2:1,1:1"}).lights.at(0);
  EXPECT_NEAR(glm::dot(slanted.rightWorld, slanted.directionWorld), 0.0f, 1e-6f);
  EXPECT_EQ(slanted.rightWorld.y, 0.0f) << "level";
  EXPECT_NEAR(glm::length(slanted.rightWorld), 1.0f, 1e-6f);
}

TEST(Lighting, WrongTextsNameTheFlagAndTheText) {
  for (const std::string text : {"",
                                 "sun",
                                 "moon:0,1,0:1:1",
                                 "sun:0,1:1:1",
                                 "sun:0,0,0:1:1",
                                 "sun:0,1,0:1:-1",
                                 "sun:0,1,0:180:1",
                                 "sun:0,1,0:-1:1",
                                 "sun:0,1,0:1:1:1",
                                 "sun:0,1,x:1:1",
                                 "sun:0,1,0:nan:1",
                                 "sun:0,inf,0:1:1",
                                 "sun:0,1,0::1",
                                 "sphere:0,0,0:-1:1",
                                 "sphere:0,0,0:1:bright",
                                 "sphere:0,0,0:1: 1",
                                 "None",
                                 "rectangle:0,0,0:0,-1,0:1,1",
                                 "rectangle:0,0,0:0,0,0:1,1:1",
                                 "rectangle:0,0,0:0,-1,0:1:1",
                                 "rectangle:0,0,0:0,-1,0:1,-1:1",
                                 "rectangle:0,0,0:0,-1,0:1,1:-1",
                                 "rectangle:0,0:0,-1,0:1,1:1"}) {
    try {
      lightingOf({text});
      ADD_FAILURE() << "accepted: " << text;
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find("--light"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(lightingOf({"none", "sun:0,-1,0:1:1"}), BadInput);
}

TEST(Lighting, SourcesGiveWayInOrder) {
  Pose pose;
  EXPECT_EQ(makeLighting(pose, {}, {}).lights.size(), 1u) << "nothing said: a sun";
  EXPECT_FLOAT_EQ(makeLighting(pose, {}, {}).lights[0].light.intensity, kPi);
  pose.lights.resize(2);
  EXPECT_EQ(makeLighting(pose, {}, {}).lights.size(), 2u) << "the scene's own";
  EXPECT_EQ(makeLighting(pose, {"sun:0,-1,0:1:1"}, {}).lights.size(), 1u) << "the command line's instead";
  EXPECT_TRUE(makeLighting(pose, {"none"}, {}).lights.empty());
  EXPECT_FALSE(makeLighting(pose, {"none"}, {}).environment.radiance.empty()) << "the sky";
  EXPECT_EQ(makeLighting(pose, {}, constantEnvironment({4, 2}, glm::vec3(3))).environment.size, glm::uvec2(4, 2));
}

TEST(Lighting, SkyIsFiniteAndBrightestTowardsTheSun) {
  const glm::vec3 towardsSun = glm::normalize(glm::vec3(1, 1, -1));
  const Environment sky = makeSky(towardsSun);
  ASSERT_EQ(sky.radiance.size(), 256u * 128u);
  for (const glm::vec3 radiance : sky.radiance) {
    ASSERT_TRUE(isFinite(radiance));
    ASSERT_GT(std::min({radiance.x, radiance.y, radiance.z}), 0.0f);
  }
  const glm::vec3 opposite(-towardsSun.x, towardsSun.y, -towardsSun.z);
  EXPECT_GT(sampleEnvironment(sky, towardsSun).x, 1.5f * sampleEnvironment(sky, opposite).x);
  EXPECT_GT(sampleEnvironment(sky, opposite).z, 2.0f * sampleEnvironment(sky, -towardsSun).z) << "a dim ground";
}

TEST(Environment, DirectionsMeetTheirColumnsAndRows) {
  // One bright texel at a time, found again from the formula of the header.
  Environment environment = constantEnvironment({8, 4}, glm::vec3(0));
  const auto brightAt = [&](std::uint32_t column, std::uint32_t row, glm::vec3 direction) {
    environment.radiance.assign(32, glm::vec3(0));
    environment.radiance[row * 8 + column] = glm::vec3(1);
    return sampleEnvironment(environment, glm::normalize(direction)).x;
  };
  const auto centre = [](float column, float row) {
    const float azimuth = ((column + 0.5f) / 8 - 0.5f) * 2 * kPi, polar = (row + 0.5f) / 4 * kPi;
    return glm::vec3(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
  };
  EXPECT_NEAR(brightAt(0, 0, centre(0, 0)), 1.0f, 1e-5f);
  EXPECT_NEAR(brightAt(5, 3, centre(5, 3)), 1.0f, 1e-5f);
  EXPECT_NEAR(brightAt(3, 1, centre(3.5f, 1)), 0.5f, 1e-5f);
  EXPECT_NEAR(brightAt(7, 2, centre(7.5f, 2)), 0.5f, 1e-5f) << "closed behind the viewer";
  EXPECT_NEAR(brightAt(0, 2, centre(7.5f, 2)), 0.5f, 1e-5f);
  EXPECT_NEAR(brightAt(6, 1, {1, 0.4f, 0}), brightAt(5, 1, {1, 0.4f, 0}), 1e-5f) << "+X at u = 3/4";
  EXPECT_GT(brightAt(6, 1, {1, 0.4f, 0}), 0.4f);
}

TEST(Harmonics, ConstantRadianceGivesPiTimesIt) {
  const auto harmonics = irradianceHarmonics(constantEnvironment({64, 32}, {1, 2, 0.5f}));
  for (const glm::vec3 direction : kDirections) {
    const glm::vec3 irradiance = evaluateHarmonics(harmonics, direction);
    // Only the texel-centre sums of the second band are not exact: error of the midpoint rule, (π/32)²/24 of each.
    EXPECT_NEAR(irradiance.x, kPi, 4e-3f);
    EXPECT_NEAR(irradiance.y, 2 * kPi, 8e-3f);
    EXPECT_NEAR(irradiance.z, 0.5f * kPi, 2e-3f);
  }
}

TEST(Harmonics, LinearAndQuadraticRadianceAreExact) {
  // L = 1 + d.a: irradiance π + 2π/3 n.a (the clamped cosine's first two bands).
  const glm::vec3 a(0.3f, -0.5f, 0.4f);
  const auto linear =
      irradianceHarmonics(environmentOf({128, 64}, [&](glm::vec3 d) { return glm::vec3(1.0f + glm::dot(d, a)); }));
  for (const glm::vec3 n : kDirections)
    EXPECT_NEAR(evaluateHarmonics(linear, n).x, kPi + 2.0f * kPi / 3.0f * glm::dot(n, a), 3e-3f);
  // L = (d.b)²: one third of a constant and two thirds of a zonal second band: π/3 + π/4 ((n.b)² - 1/3).
  const glm::vec3 b = glm::normalize(glm::vec3(1, 2, 2));
  const auto quadratic = irradianceHarmonics(
      environmentOf({128, 64}, [&](glm::vec3 d) { return glm::vec3(glm::dot(d, b) * glm::dot(d, b)); }));
  for (const glm::vec3 n : kDirections) {
    const float cosine = glm::dot(n, b);
    EXPECT_NEAR(evaluateHarmonics(quadratic, n).x, kPi / 3 + kPi / 4 * (cosine * cosine - 1.0f / 3.0f), 3e-3f);
  }
}

TEST(Harmonics, HalfBrightSphereIsWithinThePublishedError) {
  // Radiance 1 above the horizon: irradiance π (1 + n.y) / 2. Nine coefficients stay within 3 % for distant light that
  // is not a point (Ramamoorthi and Hanrahan 2001).
  const auto harmonics =
      irradianceHarmonics(environmentOf({128, 64}, [](glm::vec3 d) { return glm::vec3(d.y > 0.0f ? 1.0f : 0.0f); }));
  for (const glm::vec3 n : kDirections)
    EXPECT_NEAR(evaluateHarmonics(harmonics, n).x, 0.5f * kPi * (1.0f + n.y), 0.03f * kPi);
}

TEST(Prefilter, ConstantStaysConstant) {
  const PrefilteredEnvironment prefiltered = prefilterEnvironment(constantEnvironment({64, 32}, {1, 2, 3}));
  for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f})
    for (const glm::vec3 direction : kDirections)
      EXPECT_NEAR(samplePrefiltered(prefiltered, direction, roughness).y, 2.0f, 1e-4f);
}

TEST(Prefilter, RougherSurfacesBlurMore) {
  const glm::vec3 axis = kDirections[3];
  const PrefilteredEnvironment prefiltered = prefilterEnvironment(
      environmentOf({256, 128}, [&](glm::vec3 d) { return glm::vec3(glm::dot(d, axis) > 0.98f ? 1.0f : 0.0f); }));
  float last = 1.01f;
  for (const float roughness : {0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
    const float peak = samplePrefiltered(prefiltered, axis, roughness).x;
    EXPECT_LT(peak, last) << roughness;
    last = peak;
  }
  EXPECT_GT(samplePrefiltered(prefiltered, axis, 0.2f).x, 0.6f) << "a lobe of 0.05 rad on a disk of 0.2 rad";
  // alpha = 1: GGX is constant over half vectors, so the lobe is cos / π; a cap of cosine c holds 1 - c² of it.
  EXPECT_NEAR(samplePrefiltered(prefiltered, axis, 1.0f).x, 1.0f - 0.98f * 0.98f, 0.006f);
}

TEST(LightArrival, FollowsTheExtension) {
  PosedLight light;
  light.positionWorld = {0, 4, 0};
  light.directionWorld = {0, -1, 0};
  light.light.intensity = 32.0f;
  light.light.color = {1, 0.5f, 0};
  LightArrival arrival = lightArrivalAt(light, {0, 0, 0});
  EXPECT_EQ(arrival.towardsLight, glm::vec3(0, 1, 0));
  EXPECT_EQ(arrival.distance, 4.0f);
  EXPECT_EQ(arrival.irradiance, glm::vec3(2, 1, 0)) << "I / d²";
  light.light.range = 8.0f;
  EXPECT_NEAR(lightArrivalAt(light, {0, 0, 0}).irradiance.x, 2.0f * (1.0f - 1.0f / 16.0f), 1e-6f);
  light.light.range = 3.0f;
  EXPECT_EQ(lightArrivalAt(light, {0, 0, 0}).irradiance.x, 0.0f);

  light.light.range = 0.0f;
  light.light.kind = LightKind::Spot;
  light.light.innerConeRadians = 0.2f;
  light.light.outerConeRadians = 0.6f;
  EXPECT_NEAR(lightArrivalAt(light, {0, 0, 0}).irradiance.x, 2.0f, 1e-6f);
  EXPECT_EQ(lightArrivalAt(light, {4 * std::tan(0.61f), 0, 0}).irradiance.x, 0.0f);
  const float cosine = std::cos(0.4f), share = (cosine - std::cos(0.6f)) / (std::cos(0.2f) - std::cos(0.6f));
  EXPECT_NEAR(lightArrivalAt(light, {4 * std::tan(0.4f), 0, 0}).irradiance.x, 2 * cosine * cosine * share * share,
              1e-5f);

  light.light.kind = LightKind::Sphere;
  light.light.radius = 1.0f;
  EXPECT_EQ(lightArrivalAt(light, {0, 0, 0}).distance, 3.0f) << "ends at the surface";
  EXPECT_EQ(lightArrivalAt(light, {0, 3.9f, 0}).irradiance.x, 32.0f) << "no nearer than the radius";
  EXPECT_EQ(lightArrivalAt(light, {0, 4, 0}).irradiance, glm::vec3(0.0f));

  light.light.kind = LightKind::Rectangle;
  EXPECT_EQ(lightArrivalAt(light, {0, 0, 0}).irradiance, glm::vec3(2, 1, 0));
  EXPECT_NEAR(lightArrivalAt(light, {4, 0, 0}).irradiance.x, 32.0f / 32.0f * std::sqrt(0.5f), 1e-6f) << "by its cosine";
  EXPECT_EQ(lightArrivalAt(light, {0, 5, 0}).irradiance, glm::vec3(0.0f)) << "dark behind";

  light.light.kind = LightKind::Sun;
  arrival = lightArrivalAt(light, {1, 2, 3});
  EXPECT_EQ(arrival.irradiance, glm::vec3(32, 16, 0));
  EXPECT_TRUE(std::isinf(arrival.distance));
}
