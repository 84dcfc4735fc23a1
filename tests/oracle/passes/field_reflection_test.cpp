// Reflections by the world field against mirrors in closed form and against Embree's.
//
//      eye            a sphere that glows, over a floor that mirrors; where the ray that the floor sends back meets the
//        \    ( )     sphere, and by how much it misses it, are closed forms
//    _____\__/______
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "bakers/reference.h"
#include "bakers/reference_mirror.h"
#include "bakers/reference_samples.h"
#include "field/analytic.h"
#include "scene/brdf.h"
#include "tests/support/embree_rays.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/posed_triangles.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{160, 120};
constexpr float kGlow = 2, kAround = 0.25f, kRadius = 0.3f;
const glm::vec3 kMiddle(0, 0.45f, 0);

int addNode(Scene& scene, Mesh mesh, const glm::mat4& worldFromObject, const Material& material) {
  const int number = static_cast<int>(scene.nodes.size());
  for (Primitive& primitive : mesh.primitives) primitive.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  Node node;
  node.name = fmt::format("Node{}", number);
  node.mesh = static_cast<int>(scene.meshes.size());
  node.matrix = worldFromObject;
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(node);
  scene.scenes[0].nodes.push_back(number);
  return number;
}

Material mirror(float roughness) {
  Material material;
  material.roughness = roughness; // white metal
  return material;
}
Material glowing(float radiance = kGlow) {
  Material material;
  material.baseColor = {0, 0, 0, 1};
  material.metallic = 0;
  material.emission = glm::vec3(radiance);
  return material;
}

// Node 0 is the floor, whose top is y = 0.
Scene floorScene(float roughness) {
  Scene scene;
  scene.scenes.push_back({"scene", {}});
  addNode(scene, makeBoxMesh({1.5f, 0.05f, 1.5f}), glm::translate(glm::mat4(1), {0, -0.05f, 0}), mirror(roughness));
  return scene;
}
Scene sphereOverFloor(float roughness, float radiance = kGlow) {
  Scene scene = floorScene(roughness);
  addNode(scene, makeSphereMesh(kRadius, 48, 96), glm::translate(glm::mat4(1), kMiddle), glowing(radiance));
  return scene;
}

RendererSettings reflecting(int scale) {
  RendererSettings settings;
  settings.reflections = {ReflectionMethod::Field, scale};
  settings.worldField.shape = {1, 128, 0, true};
  return settings;
}

Lighting evenly(float radiance) { return {{}, {{16, 8}, std::vector<glm::vec3>(128, glm::vec3(radiance))}}; }

// Where a pixel of the floor looks at, and where it mirrors to.
struct FloorRay {
  glm::vec3 point, direction;
  float nDotV;
};
FloorRay floorRay(const View& view, std::size_t i, float depth) {
  const PrimaryRay ray = primaryRay(view, glm::vec2(i % kSize.x, i / kSize.x) + 0.5f);
  const glm::vec3 up(0, 1, 0);
  return {ray.originWorld + depth * ray.directionWorld, glm::reflect(ray.directionWorld, up), -ray.directionWorld.y};
}

class FieldReflection : public GlTest {
protected:
  FrameLayers draw(const TestScene& scene, const View& view, const Lighting& lighting,
                   const RendererSettings& settings) {
    Renderer& renderer = scene.sharedRenderer(context().info(), settings);
    renderer.setLighting(lighting);
    renderer.render(view);
    return renderer.readLayers();
  }
};

// Of one reflection, by rays of the lobes.
FrameLayers tracedMirrors(const TestScene& scene, const View& view, const Lighting& lighting, int samples) {
  ReferenceRequest request;
  request.scene = &scene.scene(), request.pose = &scene.pose();
  request.view = &view, request.lighting = &lighting;
  request.samples = samples, request.reflections = 1;
  return traceReference(request);
}

// Pixels that differ from a mask and have no pixel of the other kind of it within `reach`.
std::size_t countFar(const std::vector<int>& found, const std::vector<int>& expected, int reach) {
  std::size_t count = 0;
  const int width = static_cast<int>(kSize.x), height = static_cast<int>(kSize.y);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x);
      if (expected[at] < 0 || found[at] == expected[at]) continue;
      bool isNear = false;
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u)
          isNear = isNear || expected[static_cast<std::size_t>(v * width + u)] == found[at];
      count += !isNear;
    }
  return count;
}

// A texel is 2.3 cm, a pixel of the floor 2 cm and more: the mirrored outline is where it should be to two pixels, and
// to three where every second one or fourth is traced.
TEST_F(FieldReflection, OutlineOfASphereIsWhereItIsMirrored) {
  for (const bool isSdf : {false, true}) {
    const TestScene scene(sphereOverFloor(0), isSdf ? "Node1" : "none", isSdf ? 64 : 0);
    const View view = scene.view({1.3f, 0.9f, 1.6f}, {0, 0.1f, 0}, kSize, 50);
    for (const int scale : {1, 2, 4}) {
      const FrameLayers layers = draw(scene, view, evenly(kAround), reflecting(scale));
      std::vector<int> found(layers.id.size(), -1), expected = found;
      std::size_t mirrored = 0;
      for (std::size_t i = 0; i < layers.id.size(); ++i) {
        if (layers.id[i] != 0 || layers.normalSurface[i].y < 0.99f) continue;
        const FloorRay ray = floorRay(view, i, layers.depth[i]);
        const glm::vec3 way = kMiddle - ray.point;
        const float along = glm::dot(way, ray.direction);
        expected[i] = along > 0 && glm::length(way - along * ray.direction) < kRadius;
        found[i] = layers.color[i].x > 0.5f * (kGlow + kAround);
        mirrored += expected[i] == 1;
      }
      const std::size_t far = countFar(found, expected, scale == 1 ? 2 : 3);
      fmt::print("{}, 1 in {}: {} of {} pixels off the outline\n", isSdf ? "bricks" : "mesh", scale, far, mirrored);
      EXPECT_GT(mirrored, 300u);
      EXPECT_EQ(far, 0u) << (isSdf ? "bricks" : "mesh") << ", 1 in " << scale;
      std::size_t glows = 0;
      for (std::size_t i = 0; i < found.size(); ++i)
        // At its rim the sphere mirrors the surroundings, too, all of them edge on.
        glows += expected[i] == 1 && layers.color[i].x > 0.95f * kGlow && layers.color[i].x < 1.05f * (kGlow + kAround);
      EXPECT_GT(glows, mirrored * (scale == 4 ? 7 : 8) / 10) << "as bright as it is";
    }
  }
}

// Forty things over the floor, whatever they are: who is met, Embree says.
TEST_F(FieldReflection, CrowdsAreMirroredWhereEmbreeMeetsThem) {
  Scene built = makeCrowd();
  built.materials.assign(1, glowing());
  for (Mesh& mesh : built.meshes)
    for (Primitive& primitive : mesh.primitives) primitive.material = 0;
  const int ground = addNode(built, makeBoxMesh({2, 0.05f, 2}), glm::translate(glm::mat4(1), {0, -1.3f, 0}), mirror(0));
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({1.2f, 1.0f, 2.6f}, {0, -0.9f, 0}, kSize, 50);
  const FrameLayers layers = draw(scene, view, evenly(kAround), reflecting(1));
  const EmbreeRays oracle(gatherTriangles(scene.scene(), scene.pose()).rows);
  std::vector<int> found(layers.id.size(), -1), expected = found;
  std::size_t count = 0, mirrored = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    if (layers.id[i] != ground || layers.normalSurface[i].y < 0.99f) continue;
    const FloorRay ray = floorRay(view, i, layers.depth[i]);
    expected[i] = std::isfinite(oracle.trace(ray.point + 1e-4f * ray.direction, ray.direction).distance);
    found[i] = layers.color[i].x > 0.5f * (kGlow + kAround);
    ++count, mirrored += expected[i] == 1;
  }
  const std::size_t far = countFar(found, expected, 2);
  fmt::print("crowd: {} of {} pixels off the outlines, {} mirror something\n", far, count, mirrored);
  EXPECT_GT(mirrored, 500u);
  EXPECT_LE(far, count / 200);
}

// With nothing around but the floor itself, smooth floors mirror the surroundings, whatever the view, and those that
// are too rough to be traced are lit as ever. Between them the lobe's parts, which are drawn as the viewer sees them,
// come nearer to the truth than the prefiltered surroundings, whose lobes are round.
TEST_F(FieldReflection, AloneAFloorMirrorsTheSurroundings) {
  const Lighting lighting{{}, makeSky(glm::normalize(glm::vec3(1, 1, 1)))};
  for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
    const TestScene scene(floorScene(roughness), "none");
    for (const glm::vec3 eye : {glm::vec3(1.4f, 0.9f, 1.6f), glm::vec3(2.4f, 0.15f, 0.3f)}) {
      const View view = scene.view(eye, glm::vec3(0), kSize, 50);
      const FrameLayers truth = tracedMirrors(scene, view, lighting, 64);
      RendererSettings off = reflecting(1);
      off.reflections.method = ReflectionMethod::Off;
      const FrameLayers without = draw(scene, view, lighting, off);
      for (const int scale : {1, 2}) {
        const FrameLayers with = draw(scene, view, lighting, reflecting(scale));
        double squares = 0, squaresWithout = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < with.id.size(); ++i) {
          if (with.id[i] < 0 || truth.id[i] < 0) continue;
          ++count;
          squares += std::pow(static_cast<double>(with.color[i].y) - static_cast<double>(truth.color[i].y), 2);
          squaresWithout +=
              std::pow(static_cast<double>(without.color[i].y) - static_cast<double>(truth.color[i].y), 2);
          const float slack =
              (scale == 2 ? 0.05f : 2e-3f) * (1 + without.color[i].y); // at half resolution between places
          if (roughness == 0 || roughness == 1) {
            ASSERT_NEAR(with.color[i].y, without.color[i].y, slack) << "roughness " << roughness << " pixel " << i;
          }
        }
        ASSERT_GT(count, 2000u);
        const double error = std::sqrt(squares / static_cast<double>(count));
        const double errorWithout = std::sqrt(squaresWithout / static_cast<double>(count));
        fmt::print("roughness {}, every {}. pixel: RMS {:.4f}, {:.4f} without\n", roughness, scale, error,
                   errorWithout);
        if (roughness == 0.3f || roughness == 0.6f) {
          EXPECT_LE(error, 0.95 * errorWithout);
        }
      }
    }
  }
}

// Of what a rough floor mirrors the sphere fills as much as it fills of its lobe.
TEST_F(FieldReflection, LobesAreAsWideAsSurfacesAreRough) {
  for (const float roughness : {0.2f, 0.4f}) {
    const TestScene scene(sphereOverFloor(roughness), "Node1", 64);
    const View view = scene.view({1.3f, 0.9f, 1.6f}, {0, 0.1f, 0}, kSize, 50);
    const SurfaceBrdf brdf = makeBrdf({1, 1, 1}, 1, roughness);
    for (const int scale : {1, 2}) {
      const FrameLayers layers = draw(scene, view, evenly(kAround), reflecting(scale));
      std::size_t partly = 0;
      double sum = 0, signedSum = 0;
      for (std::size_t i = 0; i < layers.id.size(); ++i) {
        if (layers.id[i] != 0 || layers.normalSurface[i].y < 0.99f) continue;
        const FloorRay ray = floorRay(view, i, layers.depth[i]);
        constexpr int kRays = 256;
        const PixelSamples samples({0, 0}, i, kRays);
        float all = 0, met = 0;
        for (int sample = 0; sample < kRays; ++sample) {
          const glm::vec3 toViewer = -glm::reflect(ray.direction, glm::vec3(0, 1, 0));
          const auto [direction, weight] =
              sampleMirrored(brdf, {0, 1, 0}, toViewer, samples.point(sample, SamplePurpose::Mirror));
          const glm::vec3 way = kMiddle - ray.point;
          const float along = glm::dot(way, direction);
          all += weight.x;
          met += along > 0 && glm::length(way - along * direction) < kRadius ? weight.x : 0;
        }
        const glm::vec2 entry = environmentBrdf(roughness, ray.nDotV);
        const float found = (layers.color[i].x / (entry.x + entry.y) - kAround) / (kGlow - kAround);
        const float share = met / all;
        if (share < 0.05f || share > 0.95f) continue;
        ++partly, sum += std::abs(found - share), signedSum += found - share;
        ASSERT_NEAR(found, share, 0.4f) << "roughness " << roughness << " pixel " << i;
      }
      const double mean = sum / static_cast<double>(partly), bias = signedSum / static_cast<double>(partly);
      fmt::print("roughness {}, 1 in {}: share of the sphere within {:.3f} on average, {:+.3f}, {} pixels\n", roughness,
                 scale, mean, bias, partly);
      EXPECT_GT(partly, 100u);
      EXPECT_LE(mean, 0.1);
      EXPECT_LE(std::abs(bias), 0.08);
    }
  }
}

// Whatever a rough cone meets, its middle alone does not fill it: at most one over the square of its width. A mirror
// shows it as it is.
TEST_F(FieldReflection, LampsMakeNoSparksOnRoughSurfaces) {
  constexpr float kLamp = 5000;
  for (const float roughness : {0.0f, 0.2f, 0.4f}) {
    const TestScene scene(sphereOverFloor(roughness, kLamp), "Node1", 64);
    const View view = scene.view({1.3f, 0.9f, 1.6f}, {0, 0.1f, 0}, kSize, 50);
    const FrameLayers layers = draw(scene, view, evenly(0), reflecting(1));
    float brightest = 0;
    for (std::size_t i = 0; i < layers.id.size(); ++i)
      if (layers.id[i] == 0) brightest = std::max(brightest, layers.color[i].x);
    const float alpha = roughness * roughness, width = 2 * alpha / (1 - alpha * alpha);
    const float most = std::min(kLamp, 1 / (width * width));
    EXPECT_LE(brightest, 1.01f * most) << roughness;
    EXPECT_GE(brightest, 0.7f * most) << roughness;
  }
}

// A scene a thousand times as bright, exposed as much less, mirrors a thousand times as much.
TEST_F(FieldReflection, LampsAreAsBrightAsThePictureIsExposed) {
  constexpr float kLamp = 100, kStops = 10;
  const float times = std::exp2(kStops);
  const auto drawn = [&](float scale, float exposureEv) {
    const TestScene scene(sphereOverFloor(0.4f, kLamp * scale), "none");
    RendererSettings settings = reflecting(1);
    settings.exposureEv = exposureEv;
    return draw(scene, scene.view({1.3f, 0.9f, 1.6f}, {0, 0.1f, 0}, kSize, 50), evenly(0), settings);
  };
  const FrameLayers dim = drawn(1, 0), bright = drawn(times, -kStops);
  std::size_t lit = 0;
  for (std::size_t i = 0; i < dim.id.size(); ++i) {
    if (dim.id[i] != 0) continue;
    lit += dim.color[i].x > 1;
    ASSERT_NEAR(bright.color[i].x / times, dim.color[i].x, 2e-3f * dim.color[i].x + 1e-4f) << "pixel " << i;
  }
  EXPECT_GT(lit, 300u);
}

// A mirror before the viewer shows the wall behind, which the picture does not: its material by who is nearest, its
// light by the formula; of an SDF object its own attributes.
TEST_F(FieldReflection, WhatThePictureDoesNotShowIsShadedByWhoIsNearest) {
  Scene built;
  built.scenes.push_back({"scene", {}});
  addNode(built, makeBoxMesh({0.6f, 0.6f, 0.05f}), glm::translate(glm::mat4(1), {0, 0, -0.05f}), mirror(0));
  Material paint;
  paint.baseColor = {0.7f, 0.4f, 0.1f, 1};
  paint.metallic = 0;
  const glm::vec3 half(1.2f, 1.2f, 0.1f);
  addNode(built, makeBoxMesh(half), glm::translate(glm::mat4(1), {0, 0, 2.1f}), paint);
  PosedLight sun;
  sun.light.kind = LightKind::Sun;
  sun.light.intensity = 3;
  sun.directionWorld = glm::normalize(glm::vec3(0.3f, -0.4f, 1));
  Lighting lighting = evenly(0);
  lighting.lights.push_back(sun);
  const TestScene scene(built, "none");
  const View view = scene.view({0, 0, 1}, {0, 0, 0}, kSize, 40);
  const glm::vec3 normal(0, 0, -1), toMirror(0, 0, -1);
  const auto expected = [&](glm::vec3 color) {
    const float cosine = glm::dot(normal, -sun.directionWorld);
    return evaluateBrdf(makeBrdf(color, 0, 1), normal, toMirror, -sun.directionWorld) * (sun.light.intensity * cosine);
  };
  const std::size_t middle = (kSize.y / 2 - 12) * kSize.x + kSize.x / 2; // above the seam of the two halves below
  const glm::vec3 ofMesh = draw(scene, view, lighting, reflecting(1)).color[middle];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(ofMesh[c], expected(glm::vec3(paint.baseColor))[c], 0.02f) << c;

  SceneFields fields;
  fields.fields.push_back(
      makeAnalyticField([&](glm::vec3 p) { return boxDistance(p, glm::vec3(0), half); }, {-half, half}, 64, 8, 2));
  const glm::vec3 upper(0.1f, 0.6f, 0.3f), lower(0.8f, 0.1f, 0.2f);
  addAttributes(fields.fields[0], [&](glm::vec3 p) {
    SurfaceAttributes attributes;
    attributes.baseColor = glm::vec4(p.y > 0 ? upper : lower, 1);
    return attributes;
  });
  fields.fieldOfNode = {-1, 0};
  Renderer renderer(context().info());
  renderer.setScene(scene.scene(), fields);
  renderer.setPose(scene.pose());
  renderer.setLighting(lighting);
  renderer.setSettings(reflecting(1));
  renderer.render(view);
  const FrameLayers layers = renderer.readLayers();
  const std::size_t below = (kSize.y / 2 + 12) * kSize.x + kSize.x / 2;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(layers.color[middle][c], expected(upper)[c], 0.02f) << c;
    EXPECT_NEAR(layers.color[below][c], expected(lower)[c], 0.02f) << c;
  }
}

// Smooth and rough floors of metal under forty things, against rays of their lobes.
TEST_F(FieldReflection, MirrorsACrowdAsTracedRaysDo) {
  for (const float roughness : {0.1f, 0.3f, 0.5f}) {
    Scene built = makeCrowd();
    built.materials.assign(1, glowing());
    for (Mesh& mesh : built.meshes)
      for (Primitive& primitive : mesh.primitives) primitive.material = 0;
    const int ground =
        addNode(built, makeBoxMesh({2, 0.05f, 2}), glm::translate(glm::mat4(1), {0, -1.3f, 0}), mirror(roughness));
    const TestScene scene(std::move(built), "none");
    const View view = scene.view({1.2f, 1.0f, 2.6f}, {0, -0.9f, 0}, kSize, 50);
    const Lighting lighting = evenly(kAround);
    const FrameLayers truth = tracedMirrors(scene, view, lighting, 128);
    RendererSettings off = reflecting(1);
    off.reflections.method = ReflectionMethod::Off;
    const auto errorOf = [&](const RendererSettings& settings) {
      const FrameLayers layers = draw(scene, view, lighting, settings);
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t i = 0; i < layers.id.size(); ++i) {
        if (layers.id[i] != ground || truth.id[i] != ground || layers.normalSurface[i].y < 0.99f) continue;
        const double difference = static_cast<double>(layers.color[i].x) - static_cast<double>(truth.color[i].x);
        sum += difference * difference, ++count;
      }
      return std::sqrt(sum / static_cast<double>(count));
    };
    const double without = errorOf(off), full = errorOf(reflecting(1)), half = errorOf(reflecting(2));
    fmt::print("roughness {}: RMS {:.3f} at full, {:.3f} at half resolution, {:.3f} without\n", roughness, full, half,
               without);
    EXPECT_LE(full, 0.2 * without);
    EXPECT_LE(half, 0.2 * without);
  }
}

// A black wall stands before a bright band of the surroundings: what of a rough floor's lobe meets the wall brings none
// of it in.
TEST_F(FieldReflection, WallsHideWhatIsBehindThem) {
  for (const float roughness : {0.3f, 0.5f}) {
    Scene built = floorScene(roughness);
    addNode(built, makeBoxMesh({1.5f, 0.5f, 0.05f}), glm::translate(glm::mat4(1), {0, 0.5f, -1}), glowing(0));
    const TestScene scene(std::move(built), "none");
    const View view = scene.view({0, 0.8f, 2}, {0, 0, -0.3f}, kSize, 50);
    Lighting lighting = evenly(0);
    for (std::size_t y = 2; y < 4; ++y) // of the half before the camera the lower sky
      for (std::size_t x = 4; x < 12; ++x) lighting.environment.radiance[16 * y + x] = glm::vec3(8);
    const FrameLayers truth = tracedMirrors(scene, view, lighting, 256);
    RendererSettings off = reflecting(1);
    off.reflections.method = ReflectionMethod::Off;
    const FrameLayers without = draw(scene, view, lighting, off);
    // Of pixels that the wall takes most of their light.
    const auto meanOf = [&](const FrameLayers& layers) {
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t i = 0; i < truth.id.size(); ++i) {
        if (truth.id[i] != 0 || without.id[i] != 0 || truth.color[i].x > 0.1f * without.color[i].x) continue;
        sum += static_cast<double>(layers.color[i].x), ++count;
      }
      EXPECT_GT(count, 500);
      return sum / static_cast<double>(count);
    };
    const double expected = meanOf(truth), open = meanOf(without);
    for (const int scale : {1, 2}) {
      const double found = meanOf(draw(scene, view, lighting, reflecting(scale)));
      fmt::print("roughness {}, every {}. pixel: mean {:.3f}, traced {:.3f}, without {:.3f}\n", roughness, scale, found,
                 expected, open);
      EXPECT_NEAR(found, expected, 0.03 * open);
    }
  }
}

// Smooth stripes before a black wall mirror as well with rough ones between them as with gaps, of the same mesh all.
TEST_F(FieldReflection, PartsOfLobesAreSharedWithinASurface) {
  const auto striped = [](bool hasRough) {
    Scene built;
    built.scenes.push_back({"scene", {}});
    Mesh whole;
    for (int stripe = 0; stripe < 7; ++stripe) {
      const bool isRough = stripe % 2 == 1;
      Mesh box = makeBoxMesh({0.2f, 0.05f, 1});
      const glm::vec3 middle(0.4f * static_cast<float>(stripe) - 1.2f, -0.05f, 0);
      Material material = mirror(isRough ? 0.9f : 0.3f);
      if (isRough) material.baseColor = {0.5f, 0.5f, 0.5f, 1};
      if (isRough && !hasRough) continue;
      for (Primitive& primitive : box.primitives) {
        for (glm::vec3& position : primitive.positions) position += middle;
        primitive.material = static_cast<int>(built.materials.size());
        whole.primitives.push_back(primitive);
      }
      built.materials.push_back(material);
    }
    Node node;
    node.name = "Stripes", node.mesh = 0;
    built.meshes.push_back(std::move(whole));
    built.nodes.push_back(node);
    built.scenes[0].nodes.push_back(0);
    addNode(built, makeBoxMesh({1.5f, 0.5f, 0.05f}), glm::translate(glm::mat4(1), {0, 0.5f, -1}), glowing(0));
    return built;
  };
  const TestScene among(striped(true), "none"), lonely(striped(false), "none");
  const View view = among.view({0, 0.9f, 2}, {0, 0.1f, -0.2f}, kSize, 50);
  const Lighting lighting = evenly(1);
  const FrameLayers truthAmong = tracedMirrors(among, view, lighting, 64),
                    truthLonely = tracedMirrors(lonely, view, lighting, 64);
  const auto errorOf = [&](const TestScene& scene, const FrameLayers& truth, int scale) {
    const FrameLayers layers = draw(scene, view, lighting, reflecting(scale));
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.id.size(); ++i) {
      if (truth.id[i] < 0 || truth.albedo[i].x < 0.75f || truth.normalSurface[i].y < 0.99f) continue;
      const double off = static_cast<double>(layers.color[i].x) - static_cast<double>(truth.color[i].x);
      sum += off * off, ++count;
    }
    EXPECT_GT(count, 1000);
    return std::sqrt(sum / static_cast<double>(count));
  };
  for (const int scale : {1, 2, 4}) {
    const double between = errorOf(among, truthAmong, scale), alone = errorOf(lonely, truthLonely, scale);
    fmt::print("every {}. pixel: RMS {:.3f} between rough ones, {:.3f} alone\n", scale, between, alone);
    EXPECT_LE(between, 1.15 * alone);
  }
}

TEST_F(FieldReflection, SameFrameIsTheSameBytes) {
  const TestScene scene(sphereOverFloor(0.3f), "Node1", 64);
  const View view = scene.view({1.3f, 0.9f, 1.6f}, {0, 0.1f, 0}, {64, 48}, 50);
  RendererSettings settings = reflecting(1);
  settings.worldField.shape.texels = 64;
  for (const int scale : {1, 2}) {
    settings.reflections.scale = scale;
    std::vector<std::vector<glm::vec3>> pictures;
    for (int run = 0; run < 2; ++run) {
      const auto renderer = scene.makeRenderer(context().info(), settings);
      renderer->setLighting(evenly(kAround));
      renderer->render(view);
      pictures.push_back(renderer->readLayers().color);
    }
    EXPECT_EQ(pictures[0], pictures[1]);
  }
}

} // namespace
} // namespace brickfield::test
