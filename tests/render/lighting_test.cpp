// Radiance of single pixels against closed forms, and that frames are functions of their inputs alone.
//
//   eye (0,0,2) --> -Z --> plane z = 0 facing the eye, so that in the middle pixel n = v
#include <bit>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "app/tone_curve.h"
#include "field/analytic.h"
#include "renderer/renderer.h"
#include "scene/brdf.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
// Colour targets are half floats, and image stores may round to either neighbour: a step of 11 bits, and a little for
// the arithmetic.
constexpr float kHalfRelative = 1.0f / 1024 + 1e-4f;

Material diffuse(glm::vec3 baseColor) {
  Material material;
  material.baseColor = glm::vec4(baseColor, 1);
  material.metallic = 0;
  return material;
}

// A square of 20 m at z = 0.
Scene planeScene(const Material& material) {
  Primitive primitive;
  for (const glm::vec2 corner : {glm::vec2(-10, -10), glm::vec2(10, -10), glm::vec2(10, 10), glm::vec2(-10, 10)}) {
    primitive.positions.emplace_back(corner, 0);
    primitive.normals.emplace_back(0, 0, 1);
  }
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = 0;
  Scene scene;
  scene.materials.push_back(material);
  scene.meshes.push_back({"Plane", {primitive}, {}});
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.scenes.push_back({"scene", {0}});
  return scene;
}

Environment uniformEnvironment(float radiance) { return {{16, 8}, std::vector<glm::vec3>(128, glm::vec3(radiance))}; }

PosedLight sun(float lux, glm::vec3 direction = {0, 0, -1}) {
  PosedLight posed;
  posed.light.kind = LightKind::Sun;
  posed.light.intensity = lux;
  posed.directionWorld = glm::normalize(direction);
  return posed;
}
PosedLight lampAt(glm::vec3 position, LightKind kind, float candela) {
  PosedLight posed;
  posed.light.kind = kind;
  posed.light.intensity = candela;
  posed.positionWorld = position;
  return posed;
}

View middleView(glm::vec3 eye = {0, 0, 2}) { return makePerspectiveView(eye, {0, 0, 0}, 0.5f, 0.01f, {9, 9}); }

class LightingTruths : public GlTest {
protected:
  std::unique_ptr<Renderer> rendererOf(const Scene& scene, const Lighting& lighting, const SceneFields& fields = {},
                                       const RendererSettings& settings = {}) {
    auto renderer = std::make_unique<Renderer>(context().info());
    renderer->setScene(scene, fields);
    renderer->setPose(poseScene(scene, {}));
    renderer->setLighting(lighting);
    renderer->setSettings(settings);
    return renderer;
  }
  glm::vec3 middleRadiance(const Material& material, const Lighting& lighting, glm::vec3 eye = {0, 0, 2}) {
    const Scene scene = planeScene(material);
    const auto renderer = rendererOf(scene, lighting);
    renderer->render(middleView(eye));
    return renderer->readLayers().color[40];
  }
  static void expectRadiance(glm::vec3 actual, glm::vec3 expected, const std::string& what) {
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(actual[c], expected[c], kHalfRelative * expected[c] + 1e-7f) << what << " channel " << c;
  }
};

// Under π lux the diffuse part is 1 less the share that the surface mirrors, (1 - 0.04); the mirrored part at roughness
// 1, straight on: F D V π = 0.04 * 1/π * 1/4 * π. Together 0.97.
TEST_F(LightingTruths, WhitePlaneUnderPiLux) {
  expectRadiance(middleRadiance(diffuse(glm::vec3(1)), {{sun(kPi)}, uniformEnvironment(0)}), glm::vec3(0.97f), "white");
  expectRadiance(middleRadiance(diffuse(glm::vec3(0)), {{sun(kPi)}, uniformEnvironment(0)}), glm::vec3(0.01f), "black");
}

// D = 1/(π α²), V = 1/4, F = 1.
TEST_F(LightingTruths, WhiteMetalMirrorsByItsRoughness) {
  for (const float roughness : {1.0f, 0.6f, 0.2f}) { // 255, 153 and 51 of 255: stored exactly
    Material metal;
    metal.roughness = roughness;
    const float alpha = roughness * roughness;
    // The stored roughness comes back within a rounding, whose share alpha^-2 takes four times.
    expectRadiance(middleRadiance(metal, {{sun(kPi)}, uniformEnvironment(0)}), glm::vec3(0.25f / (alpha * alpha)),
                   "roughness " + std::to_string(roughness));
  }
}

TEST_F(LightingTruths, SlantedSunFollowsTheBrdf) {
  for (const float degrees : {20.0f, 45.0f, 70.0f}) {
    const float angle = glm::radians(degrees);
    const glm::vec3 toSun(std::sin(angle), 0, std::cos(angle));
    const glm::vec3 expected =
        evaluateBrdf(makeBrdf(glm::vec3(1), 0, 1), {0, 0, 1}, {0, 0, 1}, toSun) * std::cos(angle) * kPi;
    expectRadiance(middleRadiance(diffuse(glm::vec3(1)), {{sun(kPi, -toSun)}, uniformEnvironment(0)}), expected,
                   std::to_string(degrees));
  }
  expectRadiance(middleRadiance(diffuse(glm::vec3(1)), {{sun(kPi, {0, 0, 1})}, uniformEnvironment(0)}), glm::vec3(0),
                 "from behind");
}

// Of a plane seen straight on under a sun by its side: the formula, and not that of Cook-Torrance.
TEST_F(LightingTruths, BlinnPhongAnswersWhereItIsAskedFor) {
  RendererSettings settings;
  settings.brdf = BrdfModel::BlinnPhong;
  int unlike = 0;
  for (const float roughness : {1.0f, 0.6f, 0.2f})
    for (const float degrees : {0.0f, 10.0f, 45.0f}) {
      Material material = diffuse(glm::vec3(1));
      material.roughness = roughness;
      const glm::vec3 toSun(std::sin(glm::radians(degrees)), 0, std::cos(glm::radians(degrees)));
      const Scene scene = planeScene(material);
      const auto renderer = rendererOf(scene, {{sun(kPi, -toSun)}, uniformEnvironment(0)}, {}, settings);
      renderer->render(middleView());
      const SurfaceBrdf brdf = makeBrdf(glm::vec3(1), 0, roughness);
      const glm::vec3 up(0, 0, 1), expected = evaluateBlinnPhong(brdf, up, up, toSun) * (kPi * toSun.z);
      const std::string name = fmt::format("roughness {} at {} degrees", roughness, degrees);
      expectRadiance(renderer->readLayers().color[40], expected, name);
      const glm::vec3 other = evaluateBrdf(brdf, up, up, toSun) * (kPi * toSun.z);
      unlike += std::abs(other.x - expected.x) > 5 * kHalfRelative * expected.x;
    }
  EXPECT_GE(unlike, 3) << "the two models are told apart";
}

TEST_F(LightingTruths, PointLightFallsOffByTheSquare) {
  for (const float distance : {0.5f, 1.0f, 2.0f, 5.0f})
    expectRadiance(middleRadiance(diffuse(glm::vec3(1)),
                                  {{lampAt({0, 0, distance}, LightKind::Point, kPi)}, uniformEnvironment(0)}),
                   glm::vec3(0.97f / (distance * distance)), std::to_string(distance));
}

TEST_F(LightingTruths, RangeConeAndRadiusShapeTheLight) {
  const auto radiance = [&](const PosedLight& light) {
    return middleRadiance(diffuse(glm::vec3(1)), {{light}, uniformEnvironment(0)});
  };
  PosedLight lamp = lampAt({0, 0, 1}, LightKind::Point, kPi);
  lamp.light.range = 2;
  expectRadiance(radiance(lamp), glm::vec3(0.97f * (1 - 1.0f / 16)), "window at half the range");
  lamp.light.range = 0.9f;
  expectRadiance(radiance(lamp), glm::vec3(0), "beyond the range");

  PosedLight spot = lampAt({0, 0, 1}, LightKind::Spot, kPi);
  spot.light.innerConeRadians = 0.2f;
  spot.light.outerConeRadians = 0.6f;
  for (const float angle : {0.1f, 0.4f, 0.7f}) {
    spot.directionWorld = {std::sin(angle), 0, -std::cos(angle)};
    expectRadiance(radiance(spot), glm::vec3(0.97f * coneFalloff(std::cos(angle), 0.2f, 0.6f)),
                   "cone " + std::to_string(angle));
  }

  PosedLight ball = lampAt({0, 0, 1}, LightKind::Sphere, kPi);
  ball.light.radius = 0.25f;
  expectRadiance(radiance(ball), glm::vec3(0.97f), "sphere from outside");
  ball.light.radius = 2;
  expectRadiance(radiance(ball), glm::vec3(0.97f / 4), "no nearer than its surface");
}

TEST_F(LightingTruths, LightsAddUpWithTheirColors) {
  PosedLight red = sun(kPi), blue = sun(2 * kPi);
  red.light.color = {1, 0, 0};
  blue.light.color = {0, 0.25f, 1};
  expectRadiance(middleRadiance(diffuse(glm::vec3(1)), {{red, blue}, uniformEnvironment(0)}),
                 0.97f * glm::vec3(1, 0.5f, 2), "two suns");
}

TEST_F(LightingTruths, UnlitShowsItsColorWhateverShines) {
  Material material = diffuse(glm::vec3(linearFromSrgb(188.0f / 255), linearFromSrgb(64.0f / 255), 1));
  material.unlit = true;
  for (const float light : {0.0f, 5.0f}) {
    const glm::vec3 shown =
        srgbFromLinear(middleRadiance(material, {{sun(light)}, uniformEnvironment(light)})) * 255.0f;
    // Half a code: what a driver's sRGB conversion may be off.
    EXPECT_NEAR(shown.x, 188, 0.5f) << light;
    EXPECT_NEAR(shown.y, 64, 0.5f) << light;
    EXPECT_NEAR(shown.z, 255, 0.5f) << light;
  }
}

TEST_F(LightingTruths, EmissionShinesInTheDarkAndAddsToLight) {
  Material material = diffuse(glm::vec3(0));
  material.emission = {0.5f, 4, 64}; // powers of two: exact in the small floats of the G-buffer
  expectRadiance(middleRadiance(material, {{}, uniformEnvironment(0)}), material.emission, "dark");
  expectRadiance(middleRadiance(material, {{sun(100 * kPi)}, uniformEnvironment(0)}), material.emission + 1.0f, "lit");
}

// A black body in white surroundings returns scale and bias of the split sum, a white one no more than comes in.
TEST_F(LightingTruths, UniformSurroundingsComeBackByTheirShare) {
  const Lighting white{{}, uniformEnvironment(1)};
  const glm::vec2 share = environmentBrdf(1, 1);
  const float mirrored = 0.04f * share.x + share.y;
  // Table of 64 steps in half floats: a percent of what is mirrored.
  EXPECT_NEAR(middleRadiance(diffuse(glm::vec3(0)), white).x, mirrored, 0.01f * mirrored + 1e-3f);
  EXPECT_NEAR(middleRadiance(diffuse(glm::vec3(1)), white).x, 1, 5e-3f);
  EXPECT_NEAR(middleRadiance(diffuse(glm::vec3(0.5f)), white, {0.7f, 0, 2}).x, mirrored + 0.5f * (1 - mirrored), 1e-2f);
}

TEST_F(LightingTruths, SkyIsTheSurroundings) {
  Scene empty = planeScene(diffuse(glm::vec3(1)));
  empty.scenes[0].nodes.clear();
  const auto renderer = rendererOf(empty, {{sun(kPi)}, uniformEnvironment(0.375f)});
  renderer->render(middleView());
  for (const glm::vec3& pixel : renderer->readLayers().color) EXPECT_EQ(pixel, glm::vec3(0.375f));
}

TEST_F(LightingTruths, OneStopDoublesRadianceBeforeTheCurve) {
  for (const float emission : {0.03125f, 0.25f, 0.5f}) {
    Material dim = diffuse(glm::vec3(0)), bright = dim;
    dim.emission = glm::vec3(emission);
    bright.emission = glm::vec3(2 * emission);
    const Scene dimScene = planeScene(dim), brightScene = planeScene(bright);
    RendererSettings oneStop;
    oneStop.exposureEv = 1;
    const auto exposed = rendererOf(dimScene, {{}, uniformEnvironment(0)}, {}, oneStop);
    const auto doubled = rendererOf(brightScene, {{}, uniformEnvironment(0)});
    exposed->render(middleView());
    doubled->render(middleView());
    EXPECT_EQ(exposed->readPicture(), doubled->readPicture());
    EXPECT_EQ(exposed->readLayers().color[40], glm::vec3(emission)) << "layers are before exposure";
    const float display = displayFromRadiance(glm::vec3(emission), 1).x * 255;
    EXPECT_NEAR(exposed->readPicture()[3 * 40], display, 0.51f);
  }
}

// Meshes and an SDF object, without a bake.
struct Mixed {
  Scene scene = makeInterpenetration();
  SceneFields fields;
  Lighting lighting;
  Mixed() {
    fields.fields.push_back(makeAnalyticField([](glm::vec3 p) { return sphereDistance(p, glm::vec3(0), 0.5f); },
                                              {glm::vec3(-0.5f), glm::vec3(0.5f)}, 32, 8, 2));
    fields.fieldOfNode = {-1, 0};
    lighting = {{sun(2, {-1, -2, -1}), lampAt({1, 1, 1}, LightKind::Point, 3)}, makeSky({0.3f, 0.9f, 0.3f}, {32, 16})};
  }
};

std::vector<std::uint32_t> bitsOf(const FrameLayers& layers) {
  std::vector<std::uint32_t> bits;
  for (const auto* layer : {&layers.color, &layers.normal, &layers.normalSurface, &layers.albedo})
    for (const glm::vec3& value : *layer)
      for (int c = 0; c < 3; ++c) bits.push_back(std::bit_cast<std::uint32_t>(value[c]));
  for (const auto* layer : {&layers.depth, &layers.steps})
    for (const float value : *layer) bits.push_back(std::bit_cast<std::uint32_t>(value));
  for (std::size_t p = 0; p < layers.id.size(); ++p)
    bits.push_back(static_cast<std::uint32_t>(layers.id[p]) << 2 | static_cast<std::uint32_t>(layers.kind[p]));
  return bits;
}

const View kViewA = makePerspectiveView({0.6f, 1.1f, 2.2f}, {0, 0, 0}, 0.7f, 0.01f, {96, 64});
const View kViewB = makePerspectiveView({-1.1f, 0.2f, 0.9f}, {0.2f, 0, 0}, 1.2f, 0.01f, {80, 72});

TEST_F(LightingTruths, SameFrameIsTheSameBytes) {
  const Mixed mixed;
  const auto renderer = rendererOf(mixed.scene, mixed.lighting, mixed.fields);
  renderer->render(kViewA);
  const auto first = bitsOf(renderer->readLayers());
  const auto picture = renderer->readPicture();
  renderer->render(kViewA);
  EXPECT_EQ(bitsOf(renderer->readLayers()), first);
  EXPECT_EQ(renderer->readPicture(), picture);
  const auto other = rendererOf(mixed.scene, mixed.lighting, mixed.fields);
  other->render(kViewA);
  EXPECT_EQ(bitsOf(other->readLayers()), first);
  EXPECT_EQ(other->readPicture(), picture);
  const FrameLayers layers = renderer->readLayers();
  for (const SurfaceKind kind : {SurfaceKind::None, SurfaceKind::Mesh, SurfaceKind::Sdf})
    EXPECT_THAT(layers.kind, ::testing::Contains(kind)) << "the frame shows too little to prove anything";
}

// A, then something else in every respect, then A again.
TEST_F(LightingTruths, FrameDoesNotDependOnTheOneBefore) {
  const Mixed mixed;
  const auto renderer = rendererOf(mixed.scene, mixed.lighting, mixed.fields);
  renderer->render(kViewA);
  const auto first = bitsOf(renderer->readLayers());
  const auto picture = renderer->readPicture();

  const Pose posed = poseScene(mixed.scene, {});
  Pose moved = posed;
  for (PosedInstance& instance : moved.instances) instance.worldFromObject[3] += glm::vec4(0.3f, -0.2f, 0.1f, 0);
  std::reverse(moved.instances.begin(), moved.instances.end());
  View sameSize = kViewB;
  sameSize = makePerspectiveView({-1.1f, 0.2f, 0.9f}, {0.2f, 0, 0}, 1.2f, 0.01f, kViewA.sizePixels);
  RendererSettings others;
  others.exposureEv = 2;
  others.countersOn = true;
  others.forcedLevel = 1;
  for (const char* view : {"", "overdraw", "steps"})
    for (const View& between : {kViewB, sameSize}) {
      others.view = view;
      renderer->setSettings(others);
      renderer->setPose(moved);
      renderer->setLighting({{}, uniformEnvironment(3)});
      renderer->render(between);
      EXPECT_NE(bitsOf(renderer->readLayers()), first);
      renderer->setSettings({});
      renderer->setPose(posed);
      renderer->setLighting(mixed.lighting);
      renderer->render(kViewA);
      EXPECT_EQ(bitsOf(renderer->readLayers()), first) << "after " << view;
      EXPECT_EQ(renderer->readPicture(), picture) << "after " << view;
    }
}

} // namespace
} // namespace brickfield::test
