// Shadow maps against closed forms, against the traced hard shadows of the reference, and their wide filter against a
// brute-force one.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>

#include "bakers/reference.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{320, 180};
constexpr int kTexels = 512;

int addNode(Scene& scene, const std::string& name, Mesh mesh, const glm::mat4& place) {
  Node node;
  node.name = name;
  node.mesh = static_cast<int>(scene.meshes.size());
  node.matrix = place;
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(node);
  if (scene.scenes.empty()) scene.scenes.push_back({"scene", {}});
  scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()) - 1);
  return static_cast<int>(scene.nodes.size()) - 1;
}

glm::mat4 at(float x, float y, float z) { return glm::translate(glm::mat4(1), {x, y, z}); }

void addFloor(Scene& scene) { addNode(scene, "Floor", makeBoxMesh({1.5f, 0.1f, 1.5f}), at(0, -0.1f, 0)); }

class ShadowMap : public GlTest {
protected:
  static Lighting lightingOf(const TestScene& scene, const std::string& light) {
    Environment black;
    black.size = {1, 1};
    black.radiance = {glm::vec3(0)};
    return makeLighting(scene.pose(), {light}, black);
  }

  std::unique_ptr<Renderer> draw(const TestScene& scene, const View& view, const std::string& light,
                                 ShadowFilter filter = ShadowFilter::Pcf) const {
    RendererSettings settings;
    settings.shadows.method = ShadowMethod::Maps;
    settings.shadowMaps = {filter, kTexels};
    auto renderer = scene.makeRenderer(context().info(), settings);
    renderer->setLighting(lightingOf(scene, light));
    renderer->render(view);
    return renderer;
  }

  // Hard shadows, traced.
  static FrameLayers trace(const TestScene& scene, const View& view, const std::string& light) {
    const Lighting lighting = lightingOf(scene, light);
    ReferenceRequest request;
    request.scene = &scene.scene();
    request.pose = &scene.pose();
    request.view = &view;
    request.lighting = &lighting;
    request.lightsFromCentres = request.shadowLayers = true;
    request.isSdf = [&](int node) { return scene.isSdf(node); };
    return traceReference(request);
  }

  // Of the pixels that face the light, the share where the map is wrong by more than a half.
  static double wrongShare(const FrameLayers& drawn, const FrameLayers& traced, glm::vec3 towardsLight) {
    std::size_t all = 0, wrong = 0, dark = 0;
    for (std::size_t i = 0; i < drawn.depth.size(); ++i) {
      if (drawn.id[i] < 0 || drawn.id[i] != traced.id[i]) continue;
      if (glm::dot(traced.normalSurface[i], towardsLight) < 0.05f) continue;
      ++all;
      dark += traced.shadow[0][i] < 0.5f;
      wrong += std::abs(drawn.shadow[0][i] - traced.shadow[0][i]) > 0.5f;
    }
    const double share = static_cast<double>(wrong) / static_cast<double>(all);
    std::printf("%zu pixels, %zu dark, %zu wrong (%.3f %%)\n", all, dark, wrong, 100 * share);
    EXPECT_GT(all, 5000u);
    EXPECT_GT(dark, 300u);
    return share;
  }
};

glm::vec3 floorPoint(const View& view, const FrameLayers& frame, std::uint32_t x, std::uint32_t y) {
  const PrimaryRay ray = primaryRay(view, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
  return ray.originWorld + frame.depth[std::size_t{y} * kSize.x + x] * ray.directionWorld;
}

// A slab of [-1, 0] x [0.5, 0.6] x [-1.4, 1.4] under an oblique sun.
constexpr float kLow = 0.5f, kHigh = 0.6f;
bool isSlabBetween(glm::dvec3 point, glm::dvec3 towardsLight) {
  double enter = 0, leave = 1e30;
  const glm::dvec3 low(-1, kLow, -1.4), high(0, kHigh, 1.4);
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - point[axis]) / towardsLight[axis],
                 b = (high[axis] - point[axis]) / towardsLight[axis];
    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

// Where the closed form says the same for two and a half texels around a point (two that the filter reads, and what the
// lift by half a texel shifts under this sun), the map says it too; and along each row of pixels
// the dark stretch is as long as it should be to half a texel.
TEST_F(ShadowMap, AStraightEdgeLiesWhereItShould) {
  Scene built;
  addFloor(built);
  addNode(built, "Slab", makeBoxMesh({0.5f, 0.05f, 1.4f}), at(-0.5f, 0.55f, 0));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({2.4f, 1.2f, 0.3f}, {0.1f, 0, 0}, kSize, 50);
  const glm::dvec3 towardsLight = glm::normalize(glm::dvec3(-0.35, 1, 0.1));
  const auto renderer = draw(scene, view, "sun:0.35,-1,-0.1:0:3");
  const FrameLayers frame = renderer->readLayers();
  const double texel = renderer->shadowViews()[kSunCascades - 1].texelSpan / towardsLight.y; // on the floor, at most
  std::printf("texel on the floor %.4f m\n", texel);
  std::size_t sure = 0, wrong = 0;
  double shift = 0, length = 0;
  for (std::uint32_t y = 0; y < kSize.y; ++y)
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      const std::size_t i = std::size_t{y} * kSize.x + x;
      if (frame.id[i] != 0) continue;
      const glm::dvec3 point(floorPoint(view, frame, x, y));
      if (std::abs(point.y) > 1e-3 || std::abs(point.x) > 1.45 || std::abs(point.z) > 1.2) continue; // not its sides
      const bool dark = isSlabBetween(point, towardsLight);
      bool isSure = true;
      for (const double dx : {-2.5, 0.0, 2.5})
        for (const double dz : {-2.5, 0.0, 2.5})
          isSure = isSure && isSlabBetween(point + texel * glm::dvec3(dx, 0, dz), towardsLight) == dark;
      if (isSure) {
        ++sure;
        wrong += frame.shadow[0][i] != (dark ? 0.0f : 1.0f);
      }
      if (std::abs(point.x) < 0.5 && x > 0) {
        const double step = std::abs(point.x - floorPoint(view, frame, x - 1, y).x);
        if (step > 0.1) continue; // over an edge of the picture
        shift += step * (frame.shadow[0][i] - (dark ? 0 : 1));
        length += step;
      }
    }
  EXPECT_GT(sure, 6000u);
  EXPECT_EQ(wrong, 0u);
  const double rows = length / 1.0; // each is about a metre long
  std::printf("%zu sure pixels; shifted by %.4f texels\n", sure, shift / rows / texel);
  EXPECT_LE(std::abs(shift / rows), 0.5 * texel);
}

// Lit at ten degrees above the floor, and at five: flat surfaces compare with themselves exactly. The blur of EVSM does
// not: at five degrees its 15 texels reach over half the scene's depth, and the floor darkens, so that is not asked of
// it.
TEST_F(ShadowMap, LitPlanesHaveNoAcne) {
  Scene built;
  addFloor(built);
  addNode(built, "Pole", makeBoxMesh({0.05f, 0.2f, 0.05f}), at(0, 0.2f, 0));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({1.5f, 1.2f, 1.8f}, {0, 0, 0}, kSize, 50);
  for (const ShadowFilter filter : {ShadowFilter::Pcf, ShadowFilter::Evsm})
    for (const double degrees : {60.0, 10.0, 5.0}) {
      if (filter == ShadowFilter::Evsm && degrees < 10) continue;
      const double tangent = std::tan(glm::radians(degrees));
      const FrameLayers frame = draw(scene, view, "sun:1," + std::to_string(-tangent) + ",0:0:3", filter)->readLayers();
      std::size_t lit = 0, speckled = 0;
      for (std::uint32_t y = 0; y < kSize.y; ++y)
        for (std::uint32_t x = 0; x < kSize.x; ++x) {
          const std::size_t i = std::size_t{y} * kSize.x + x;
          if (frame.id[i] != 0) continue;
          const glm::vec3 point = floorPoint(view, frame, x, y);
          const float clear = filter == ShadowFilter::Pcf ? 0.03f : 0.1f; // two texels; seven and interpolation
          if (std::abs(point.y) > 1e-3f || (point.x > -0.05f - clear && std::abs(point.z) < 0.05f + clear)) continue;
          if (std::max(std::abs(point.x), std::abs(point.z)) > 1.45f) continue;
          ++lit;
          speckled += frame.shadow[0][i] < 0.98f;
        }
      std::printf("%g degrees: %zu lit, %zu speckled\n", degrees, lit, speckled);
      ASSERT_GT(lit, 10000u);
      EXPECT_LE(speckled, lit / 1000);
    }
}

// A cube that stands on the floor: its shadow begins at its foot. Lifting receivers by half a texel and three texels of
// filter leave less than two texels of light there.
TEST_F(ShadowMap, ShadowsBeginWhereThingsStand) {
  Scene built;
  addFloor(built);
  addNode(built, "Cube", makeBoxMesh({0.3f, 0.3f, 0.3f}), at(0, 0.3f, 0));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({1.8f, 1.4f, 0.4f}, {0.4f, 0, 0}, kSize, 40);
  const auto renderer = draw(scene, view, "sun:1,-1,0:0:3");
  const FrameLayers frame = renderer->readLayers();
  const float texel = renderer->shadowViews()[kSunCascades - 1].texelSpan * std::sqrt(2.0f);
  std::size_t near = 0, leaking = 0, beyond = 0;
  for (std::uint32_t y = 0; y < kSize.y; ++y)
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      const std::size_t i = std::size_t{y} * kSize.x + x;
      if (frame.id[i] != 0) continue;
      const glm::vec3 point = floorPoint(view, frame, x, y);
      if (std::abs(point.y) > 1e-3f || std::abs(point.z) > 0.25f || point.x < 0.3f || point.x > 0.85f) continue;
      const bool isLit = frame.shadow[0][i] > 0.02f;
      if (point.x < 0.3f + 2 * texel)
        ++near, leaking += isLit;
      else
        beyond += isLit;
    }
  std::printf("texel %.4f m: %zu pixels within two of the foot, %zu lit; %zu lit farther away\n", texel, near, leaking,
              beyond);
  EXPECT_GT(near, 50u);
  EXPECT_EQ(beyond, 0u);
}

// Curved meshes, with lights of all kinds, against traced shadows: at most what a texel around outlines makes.
TEST_F(ShadowMap, AgreesWithTracedShadows) {
  Scene built;
  addFloor(built);
  addNode(built, "Torus", makeTorusMesh(0.4f, 0.15f, 48, 24), glm::rotate(at(-0.4f, 0.6f, 0), 0.9f, {1, 0.2f, 0}));
  addNode(built, "Ball", makeSphereMesh(0.3f, 24, 48), at(0.6f, 0.3f, 0.3f));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({1.5f, 1.6f, 2.2f}, {0, 0.2f, 0}, kSize, 45);
  struct Case {
    const char* light;
    glm::vec3 towards;
  };
  for (const Case& c :
       {Case{"sun:0.5,-1,-0.3:0:3", {-0.5f, 1, 0.3f}}, Case{"sphere:-0.3,1.9,0.4:0:9", {-0.1f, 1, 0.1f}}}) {
    const FrameLayers frame = draw(scene, view, c.light)->readLayers();
    EXPECT_LE(wrongShare(frame, trace(scene, view, c.light), glm::normalize(c.towards)), 0.01) << c.light;
  }
}

TEST_F(ShadowMap, MasksLetLightThrough) {
  Scene built = makeSheets();
  addNode(built, "Wall", makeBoxMesh({2.6f, 1.8f, 0.1f}), at(0.3f, -0.2f, -0.8f));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({2.5f, 1.5f, 3.5f}, {0.3f, -0.2f, -0.4f}, kSize, 50);
  const char* light = "sun:0.6,-0.4,-1:0:3";
  const FrameLayers frame = draw(scene, view, light)->readLayers(), traced = trace(scene, view, light);
  EXPECT_LE(wrongShare(frame, traced, glm::normalize(glm::vec3(-0.6f, 0.4f, 1))), 0.01);
}

// A slab whose one joint turns it upright and moves it: unskinned it would lie in the floor.
TEST_F(ShadowMap, SkinnedCastersCastWhereTheyAre) {
  Scene built;
  addFloor(built);
  Mesh slab = makeBoxMesh({0.5f, 0.05f, 0.3f});
  Primitive& primitive = slab.primitives[0];
  primitive.influencesPerVertex = 4;
  for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
    primitive.joints.insert(primitive.joints.end(), {0, 0, 0, 0});
    primitive.jointWeights.insert(primitive.jointWeights.end(), {1, 0, 0, 0});
  }
  const int node = addNode(built, "Slab", std::move(slab), glm::mat4(1));
  Node joint;
  joint.name = "Joint";
  joint.matrix = glm::rotate(at(0.2f, 0.7f, -0.2f), 1.2f, {0, 0.2f, 1});
  built.nodes.push_back(joint);
  built.scenes[0].nodes.push_back(node + 1);
  built.skins.push_back({"skin", {node + 1}, {glm::mat4(1)}});
  built.nodes[static_cast<std::size_t>(node)].skin = 0;
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({1.5f, 1.6f, 2.2f}, {0, 0.2f, 0}, kSize, 45);
  const char* light = "sun:0.5,-1,-0.3:0:3";
  const FrameLayers frame = draw(scene, view, light)->readLayers(), traced = trace(scene, view, light);
  EXPECT_LE(wrongShare(frame, traced, glm::normalize(glm::vec3(-0.5f, 1, 0.3f))), 0.01);
}

// The same torus as mesh and as SDF object: their shadows on the floor differ along the outline alone.
TEST_F(ShadowMap, SdfObjectsCastTheShadowsOfTheirMeshes) {
  const auto build = [] {
    Scene built;
    addFloor(built);
    addNode(built, "Torus", makeTorusMesh(0.4f, 0.15f, 48, 24), glm::rotate(at(-0.2f, 0.6f, 0), 0.9f, {1, 0.2f, 0}));
    return built;
  };
  const TestScene meshes(build(), "none"), fields(build(), "Torus", 64);
  const View view = meshes.view({1.5f, 1.6f, 2.2f}, {0, 0.2f, 0}, kSize, 45);
  for (const char* light : {"sun:0.5,-1,-0.3:0:3", "sphere:-0.3,1.9,0.4:0:9"}) {
    const auto drawn = draw(fields, view, light);
    const FrameLayers a = draw(meshes, view, light)->readLayers(), b = drawn->readLayers();
    std::size_t all = 0, dark = 0, apart = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i) {
      if (a.id[i] != 0 || b.id[i] != 0) continue;
      ++all, dark += a.shadow[0][i]<0.5f, apart += std::abs(a.shadow[0][i] - b.shadow[0][i])> 0.5f;
    }
    std::printf("%s: %zu floor pixels, %zu dark, %zu differ\n", light, all, dark, apart);
    EXPECT_GT(dark, 800u);
    EXPECT_LE(apart, dark / 50); // a voxel is 1.7 cm, the shadow's outline 4 m long over 0.5 m2: 13 % if all were off
  }
}

// The 15x15 filter of the depths themselves: what share of them does not cover the floor, weighted as the blur weighs.
double bruteForce(const std::vector<float>& depths, glm::dvec2 texel, double mine, glm::dvec2 slope) {
  const auto kernel = [](double i) { return std::abs(i) > 7 ? 0.0 : std::exp(-0.5 * i * i / 9.0); };
  const glm::dvec2 corner = texel - 0.5, first = glm::floor(corner), f = corner - first;
  double lit = 0, all = 0;
  for (int y = -7; y <= 8; ++y)
    for (int x = -7; x <= 8; ++x) {
      const double weight =
          ((1 - f.x) * kernel(x) + f.x * kernel(x - 1)) * ((1 - f.y) * kernel(y) + f.y * kernel(y - 1));
      const glm::ivec2 place = glm::clamp(glm::ivec2(first) + glm::ivec2(x, y), glm::ivec2(0), glm::ivec2(kTexels - 1));
      const glm::dvec2 away = glm::dvec2(place) + 0.5 - texel;
      all += weight;
      if (depths[static_cast<std::size_t>(place.y) * kTexels + static_cast<std::size_t>(place.x)] <=
          mine + glm::dot(slope, away) + 1e-4)
        lit += weight;
    }
  return lit / all;
}

// Where all depths are of two planes, the bound by variance is the filter's own result but for the warp's finite
// strength.
TEST_F(ShadowMap, EvsmIsTheBlurOfTheDepths) {
  Scene built;
  addFloor(built);
  addNode(built, "Slab", makeBoxMesh({0.5f, 0.05f, 0.8f}), at(-0.3f, 0.55f, 0));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({2.4f, 1.2f, 0.3f}, {0.1f, 0, 0}, kSize, 50);
  const auto renderer = draw(scene, view, "sun:0.35,-1,-0.1:0:3", ShadowFilter::Evsm);
  const FrameLayers frame = renderer->readLayers();
  const ShadowView& shadow = renderer->shadowViews()[kSunCascades - 1];
  const std::vector<float> depths = renderer->readShadowMap(kSunCascades - 1);
  const glm::dmat4 clip = clipFromEye(shadow.view);
  const auto inMap = [&](glm::dvec3 point) {
    const glm::dvec4 c = clip * glm::dvec4(point - glm::dvec3(shadow.view.eyeWorld), 1.0);
    return glm::dvec3((0.5 + 0.5 * glm::dvec2(c)) * double{kTexels}, c.z);
  };
  // The floor's depth a texel: two steps along it solve for the two slopes.
  const glm::dvec3 o = inMap({0, 0, 0}), u = inMap({1, 0, 0}) - o, v = inMap({0, 0, 1}) - o;
  const double determinant = u.x * v.y - u.y * v.x;
  const glm::dvec2 slope((u.z * v.y - v.z * u.y) / determinant, (v.z * u.x - u.z * v.x) / determinant);
  double squares = 0, worst = 0;
  std::size_t count = 0, partly = 0;
  for (std::uint32_t y = 0; y < kSize.y; ++y)
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      const std::size_t i = std::size_t{y} * kSize.x + x;
      if (frame.id[i] != 0) continue;
      const glm::vec3 point = floorPoint(view, frame, x, y);
      if (std::abs(point.y) > 1e-3f || std::max(std::abs(point.x), std::abs(point.z)) > 1.3f) continue;
      const glm::dvec3 place = inMap(point);
      const double expected = bruteForce(depths, place, place.z, slope), error = frame.shadow[0][i] - expected;
      squares += error * error, worst = std::max(worst, std::abs(error)), ++count;
      partly += expected > 0.05 && expected < 0.95;
    }
  const double rmse = std::sqrt(squares / static_cast<double>(count));
  std::printf("%zu pixels, %zu in penumbrae: rmse %.4f, worst %.3f\n", count, partly, rmse, worst);
  EXPECT_GT(partly, 300u);
  EXPECT_LE(rmse, 0.03);
  EXPECT_LE(worst, 0.15);
}

// Each kind of light says how many maps it has, and SDF objects are counted in them.
TEST_F(ShadowMap, LayersAndFragmentsAreCounted) {
  Scene built;
  addFloor(built);
  addNode(built, "Torus", makeTorusMesh(0.4f, 0.15f, 32, 16), at(0, 0.6f, 0));
  const TestScene scene(std::move(built), "Torus", 32);
  RendererSettings settings;
  settings.shadows.method = ShadowMethod::Maps;
  settings.shadowMaps.size = 64;
  settings.countersOn = true;
  const auto renderer = scene.makeRenderer(context().info(), settings);
  Environment black{{1, 1}, {glm::vec3(0)}};
  renderer->setLighting(makeLighting(scene.pose(), {"sun:0,-1,0:0:3", "sphere:0,2,0:0.1:9"}, black));
  renderer->render(scene.autoView({64, 36}));
  const FrameStats stats = renderer->stats();
  EXPECT_EQ(stats.shadowMapLayers, 4u + 6u);
  // The floor is under the sphere light: below it and to all four sides, not above. All of the sun's squares meet it.
  EXPECT_EQ(stats.shadowMapDraws, 4u + 5u);
  EXPECT_GE(stats.shadowMapBoxes, 4u + 1u);
  EXPECT_LE(stats.shadowMapBoxes, 4u + 5u);
  EXPECT_GT(stats.counters.mapFragments, 200u);
  EXPECT_GT(stats.counters.mapSteps, stats.counters.mapFragments);
  EXPECT_GE(stats.bytes.shadowMaps, 10u * 64 * 64 * 4);
}

} // namespace
} // namespace brickfield::test
