// The reference tracer against closed forms: spheres, planes, masks, mirrored nodes, the edge of a hard shadow.
#include "bakers/reference.h"

#include <atomic>
#include <numbers>

#include "core/error.h"
#include "tests/oracle/bakers/reference_scenes.h"

using namespace brickfield;
using namespace brickfield::test;

TEST(Reference, SphereHasItsDepthsNormalsAndOutline) {
  Scene scene = sceneOf({spherePrimitive(256, 512)});
  const glm::vec3 centre(0.3f, -0.2f, 0.5f);
  const float radius = 0.75f;
  scene.nodes[0].translation = centre;
  scene.nodes[0].scale = glm::vec3(radius);
  const View view = viewFrom({1, 2, 4}, centre);
  const FrameLayers layers = trace(scene, view, darkness());
  // A chord of 2π/512 sinks below the circle by r (1 - cos(π/512)) = 1.9e-5 r, both ways together twice that.
  const float sag = 2.0f * 1.9e-5f * radius;
  int hits = 0, misses = 0;
  for (std::uint32_t y = 0; y < layers.size.y; ++y)
    for (std::uint32_t x = 0; x < layers.size.x; ++x) {
      const std::size_t i = y * layers.size.x + x;
      const PrimaryRay ray = primaryRay(view, {x + 0.5f, y + 0.5f});
      const glm::dvec3 offset = glm::dvec3(ray.originWorld) - glm::dvec3(centre), direction(ray.directionWorld);
      const double b = glm::dot(offset, direction);
      const double discriminant = b * b - glm::dot(offset, offset) + double{radius} * radius;
      if (std::abs(discriminant) < 4.0 * sag * radius) continue; // within the facets of the outline
      if (discriminant < 0.0) {
        ++misses;
        ASSERT_EQ(layers.id[i], -1);
        ASSERT_TRUE(std::isinf(layers.depth[i]));
        ASSERT_EQ(layers.kind[i], SurfaceKind::None);
        ASSERT_EQ(layers.normal[i], glm::vec3(0.0f));
        continue;
      }
      ++hits;
      const double root = std::sqrt(discriminant), t = -b - root;
      // A surface lower by sag is met later by sag over the cosine of incidence, root / radius.
      ASSERT_NEAR(layers.depth[i], t, sag * radius / root + 1e-6);
      ASSERT_EQ(layers.id[i], 0);
      ASSERT_EQ(layers.kind[i], SurfaceKind::Mesh);
      const glm::dvec3 normal = (offset + t * direction) / double{radius};
      const double slip = sag / radius * std::sqrt(double{radius} * radius - root * root) / root; // sideways, in radii
      ASSERT_LT(glm::length(glm::dvec3(layers.normalSurface[i]) - normal), slip + 1e-4);
    }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
}

TEST(Reference, PlaneHasItsDepthAndIdsTellNodesApart) {
  Scene scene = sceneOf({squarePrimitive(10), squarePrimitive(0.5f)});
  scene.nodes[1].translation = {0, 0, 1};
  const View view = viewFrom({0, 0, 3}, {0, 0, 0});
  const FrameLayers layers = trace(scene, view, darkness());
  for (std::uint32_t y = 0; y < 65; ++y)
    for (std::uint32_t x = 0; x < 65; ++x) {
      const std::size_t i = y * 65 + x;
      const PrimaryRay ray = primaryRay(view, {x + 0.5f, y + 0.5f});
      const float toFront = 2.0f / -ray.directionWorld.z, toBack = 3.0f / -ray.directionWorld.z;
      const glm::vec3 onFront = ray.originWorld + toFront * ray.directionWorld;
      const bool front = std::max(std::abs(onFront.x), std::abs(onFront.y)) < 0.5f;
      ASSERT_EQ(layers.id[i], front ? 1 : 0) << x << "," << y;
      ASSERT_NEAR(layers.depth[i], front ? toFront : toBack, 1e-5f);
      ASSERT_EQ(layers.normalSurface[i], glm::vec3(0, 0, 1));
    }
}

TEST(Reference, RaysStartAtTheNearPlane) {
  Scene scene = sceneOf({squarePrimitive(10), squarePrimitive(10)});
  scene.nodes[1].translation = {0, 0, 2};
  EXPECT_EQ(trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}, {9, 9}, 0.9f), darkness()).id[40], 1);
  const FrameLayers clipped = trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}, {9, 9}, 1.1f), darkness());
  EXPECT_EQ(clipped.id[40], 0);
  EXPECT_NEAR(clipped.depth[40], 3.0f, 1e-5f) << "measured from the eye all the same";
}

TEST(Reference, BackFacesOfSingleSidedMaterialsAreCulled) {
  Scene scene = sceneOf({squarePrimitive(1)});
  const View behind = viewFrom({0, 0, -3}, {0, 0, 0});
  FrameLayers layers = trace(scene, behind, darkness());
  EXPECT_EQ(layers.id[centreOf(layers)], -1);
  scene.materials[0].doubleSided = true;
  layers = trace(scene, behind, darkness());
  EXPECT_EQ(layers.id[centreOf(layers)], 0);
  expectNear(layers.normalSurface[centreOf(layers)], {0, 0, -1}, 1e-6f);
  expectNear(layers.normal[centreOf(layers)], {0, 0, -1}, 1e-6f);
}

TEST(Reference, MirroredNodesTurnTheirFrontWithThem) {
  // Mirroring x leaves the square where it is and its front towards +Z, though its winding in the world is reversed.
  Scene scene = sceneOf({squarePrimitive(1)});
  scene.nodes[0].scale = {-1, 1, 1};
  FrameLayers layers = trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness());
  EXPECT_EQ(layers.id[centreOf(layers)], 0);
  expectNear(layers.normalSurface[centreOf(layers)], {0, 0, 1}, 1e-6f);
  layers = trace(scene, viewFrom({0, 0, -3}, {0, 0, 0}), darkness());
  EXPECT_EQ(layers.id[centreOf(layers)], -1);
  // Mirroring z turns it round.
  scene.nodes[0].scale = {1, 1, -1};
  layers = trace(scene, viewFrom({0, 0, -3}, {0, 0, 0}), darkness());
  EXPECT_EQ(layers.id[centreOf(layers)], 0);
  expectNear(layers.normalSurface[centreOf(layers)], {0, 0, -1}, 1e-6f);
}

TEST(Reference, FlattenedNodesAreStillThere) {
  Scene scene = sceneOf({spherePrimitive(32, 64)});
  scene.nodes[0].scale = {1, 1, 0};
  scene.materials[0].doubleSided = true;
  const FrameLayers layers = trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness());
  EXPECT_EQ(layers.id[centreOf(layers)], 0);
  EXPECT_NEAR(layers.depth[centreOf(layers)], 3.0f, 1e-5f);
}

TEST(Reference, ExtremeScalesAreTracedOrRefused) {
  Scene scene = sceneOf({squarePrimitive(1)});
  for (const float scale : {1e-12f, 1e-5f, 1e5f, 1e9f}) {
    scene.nodes[0].scale = glm::vec3(scale);
    const FrameLayers layers = trace(scene, viewFrom({0, 0, 3 * scale}, {0, 0, 0}, {5, 5}, 0.01f * scale), darkness());
    EXPECT_EQ(layers.id[12], 0) << scale;
    EXPECT_NEAR(layers.depth[12] / scale, 3.0f, 1e-4f) << scale;
  }
  scene.nodes[0].scale = glm::vec3(1e15f);
  EXPECT_THROW(trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness()), BadInput);
  scene.nodes[0].scale = glm::vec3(1.0f);
  EXPECT_THROW(trace(scene, viewFrom({0, 0, 1e15f}, {0, 0, 0}), darkness()), BadInput);
}

TEST(Reference, FlatPrimitivesShadeWithTheTriangle) {
  Scene scene = sceneOf({spherePrimitive(8, 16)});
  scene.meshes[0].primitives[0].flatNormals = true;
  const View view = viewFrom({0, 0, 3}, {0, 0, 0}, {33, 33});
  const FrameLayers layers = trace(scene, view, darkness());
  std::size_t hits = 0, sharedWithNeighbour = 0;
  for (std::size_t i = 0; i + 1 < layers.id.size(); ++i) {
    if (layers.id[i] < 0) continue;
    ++hits;
    sharedWithNeighbour += layers.normalSurface[i] == layers.normalSurface[i + 1];
    const PrimaryRay ray = primaryRay(view, {static_cast<float>(i % 33) + 0.5f, static_cast<float>(i / 33) + 0.5f});
    const glm::vec3 onSurface = ray.originWorld + layers.depth[i] * ray.directionWorld;
    // A facet spans 1/8 of a half turn both ways: its normal is off the radius by at most its half diagonal.
    EXPECT_GT(glm::dot(layers.normalSurface[i], glm::normalize(onSurface)), std::cos(kPi / 8.0f));
    EXPECT_NEAR(glm::length(layers.normalSurface[i]), 1.0f, 1e-5f);
  }
  EXPECT_GT(hits, 100u);
  EXPECT_GT(sharedWithNeighbour, hits / 2) << "one normal a facet, where smooth ones never agree";
}

TEST(Reference, MasksAreCutAtTheirCutoffAndShadowsToo) {
  // Left half of the texture has alpha 0.4, the right half 0.6.
  Scene scene = sceneOf({squarePrimitive(1), squarePrimitive(10)});
  scene.images.push_back({"", {2, 1}, {255, 255, 255, 102, 255, 255, 255, 153}});
  scene.textures.emplace_back();
  scene.textures[0].image = 0;
  scene.textures[0].magnify = Filter::Nearest;
  scene.textures[0].mipmap.reset();
  scene.textures[0].minify = Filter::Nearest;
  scene.materials[0].baseColorTexture.texture = 0;
  scene.materials.push_back(Material());
  scene.meshes[1].primitives[0].material = 1;
  scene.nodes[1].translation = {0, 0, -1};
  const View view = viewFrom({0, 0, 4}, {0, 0, 0});
  const auto idsAt = [&](AlphaMode mode, float cutoff) {
    scene.materials[0].alphaMode = mode;
    scene.materials[0].alphaCutoff = cutoff;
    const FrameLayers layers = trace(scene, view, darkness());
    return std::pair(layers.id[32 * 65 + 26], layers.id[32 * 65 + 38]);
  };
  EXPECT_EQ(idsAt(AlphaMode::Opaque, 0.5f), std::pair(0, 0));
  EXPECT_EQ(idsAt(AlphaMode::Mask, 0.5f), std::pair(1, 0));
  EXPECT_EQ(idsAt(AlphaMode::Mask, 0.3f), std::pair(0, 0));
  EXPECT_EQ(idsAt(AlphaMode::Mask, 0.7f), std::pair(1, 1));
  EXPECT_EQ(idsAt(AlphaMode::Blend, 0.3f), std::pair(1, 0)) << "Blend is cut at 0.5 whatever the cutoff";

  // Light along -Z, camera aslant from the right: the wall is lit through the hole and dark behind the rest.
  scene.materials[0].alphaMode = AlphaMode::Mask;
  scene.materials[0].alphaCutoff = 0.5f;
  Lighting lighting = darkness();
  lighting.lights.push_back(sunAlong({0, 0, -1}));
  const auto wallAt = [&](float x) {
    const View aslant = viewFrom({5, 0, 0}, {x, 0.1f, -1}, {5, 5});
    const FrameLayers layers = trace(scene, aslant, lighting);
    EXPECT_EQ(layers.id[12], 1);
    return layers.color[12].x;
  };
  EXPECT_GT(wallAt(-0.5f), 0.01f);
  EXPECT_EQ(wallAt(0.5f), 0.0f);
  EXPECT_GT(wallAt(1.5f), 0.01f);
}

TEST(Reference, LambertPlaneUnderTheSunHasItsRadiance) {
  // Rough dielectric of base colour c facing a sun of π lux from straight above, seen from straight above:
  // (1 - F) c + π F D V with F = 0.04, D = 1/π, V = 1/4 at roughness 1.
  Scene scene = sceneOf({squarePrimitive(10)});
  scene.materials[0].baseColor = {0.5f, 0.25f, 1.0f, 1.0f};
  Lighting lighting = darkness();
  lighting.lights.push_back(sunAlong({0, 0, -1}));
  const View view = viewFrom({0, 0, 3}, {0, 0, 0});
  FrameLayers layers = trace(scene, view, lighting);
  const glm::vec3 base(0.5f, 0.25f, 1.0f);
  expectNear(layers.color[centreOf(layers)], 0.96f * base + 0.04f * 0.25f, 1e-5f);
  expectNear(layers.albedo[centreOf(layers)], base, 1e-6f);
  scene.materials[0].emission = {0, 2, 0};
  layers = trace(scene, view, lighting);
  expectNear(layers.color[centreOf(layers)], 0.96f * base + 0.01f + glm::vec3(0, 2, 0), 1e-5f);
  scene.materials[0].unlit = true;
  layers = trace(scene, view, lighting);
  EXPECT_EQ(layers.color[centreOf(layers)], base);
}

TEST(Reference, WhiteFurnaceReturnsItself) {
  // A white surface in a uniform environment of radiance 1 sends back 1, but for what single scattering loses: a white
  // smooth metal nothing, a white dielectric what its specular share leaves to the diffuse part: nothing either.
  Scene scene = sceneOf({spherePrimitive(64, 128)});
  Lighting lighting = darkness();
  lighting.environment.size = {64, 32};
  lighting.environment.radiance.assign(64 * 32, glm::vec3(1.0f));
  for (const auto& [metallic, roughness] : {std::pair(0.0f, 0.3f), std::pair(0.0f, 1.0f), std::pair(1.0f, 0.1f)}) {
    scene.materials[0].metallic = metallic;
    scene.materials[0].roughness = roughness;
    const FrameLayers layers = trace(scene, viewFrom({0, 0, 4}, {0, 0, 0}), lighting);
    for (const glm::vec3 color : layers.color) {
      ASSERT_LE(color.x, 1.005f);
      ASSERT_GE(color.x, 0.97f) << metallic << " " << roughness;
    }
  }
}

TEST(Reference, HardShadowEndsWhereGeometrySays) {
  // A square of half 0.5 at height 1 over the ground; light at 4 above it: the shadow reaches 0.5 * 5 / 4 = 0.625 for a
  // point light, and 0.5 + tan(30°) on one side for a slanted sun.
  Scene scene = sceneOf({squarePrimitive(20), squarePrimitive(0.5f)});
  scene.nodes[1].translation = {0, 0, 1};
  const auto firstLit = [&](const PosedLight& light, float begin, float end) {
    Lighting lighting = darkness();
    lighting.lights.push_back(light);
    const auto isLit = [&](float x) {
      const FrameLayers layers = trace(scene, viewFrom({x, -8, 0.5f}, {x, 0, 0}, {1, 1}), lighting);
      EXPECT_EQ(layers.id[0], 0);
      return layers.color[0].x > 0.0f;
    };
    EXPECT_FALSE(isLit(begin));
    EXPECT_TRUE(isLit(end));
    for (int step = 0; step < 20; ++step) {
      const float middle = 0.5f * (begin + end);
      (isLit(middle) ? end : begin) = middle;
    }
    return end;
  };
  PosedLight lamp;
  lamp.light.kind = LightKind::Point;
  lamp.light.intensity = 100.0f;
  lamp.positionWorld = {0, 0, 5};
  // Rays start off the ground by some 1e-5 m, which moves the edge by less than that.
  EXPECT_NEAR(firstLit(lamp, 0.2f, 2.0f), 0.625f, 1e-4f);
  EXPECT_NEAR(firstLit(sunAlong({std::tan(kPi / 6), 0, -1}), 0.6f, 3.0f), 0.5f + std::tan(kPi / 6), 1e-4f);
  lamp.positionWorld = {0, 0, 0.9f};
  Lighting below = darkness();
  below.lights.push_back(lamp);
  EXPECT_GT(trace(scene, viewFrom({0.1f, -8, 0.5f}, {0.1f, 0, 0}, {1, 1}), below).color[0].x, 0.0f)
      << "what is beyond the lamp casts no shadow";
}

TEST(Reference, SurfacesDoNotShadowThemselves) {
  // Large coordinates, a slanted plane, grazing light: every pixel must be lit.
  Scene scene = sceneOf({squarePrimitive(50)});
  scene.nodes[0].rotation = glm::angleAxis(0.37f, glm::normalize(glm::vec3(1, 2, 0.5f)));
  scene.nodes[0].translation = {1000, -300, 77};
  scene.nodes[0].scale = {3, 0.7f, 1};
  const glm::vec3 normal = scene.nodes[0].rotation * glm::vec3(0, 0, 1);
  const glm::vec3 along = scene.nodes[0].rotation * glm::vec3(1, 0, 0);
  Lighting lighting = darkness();
  lighting.lights.push_back(sunAlong(-normal * 0.05f - along));
  const View view = viewFrom(scene.nodes[0].translation + 20.0f * normal + 3.0f * along, scene.nodes[0].translation);
  const FrameLayers layers = trace(scene, view, lighting);
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    ASSERT_EQ(layers.id[i], 0);
    ASSERT_GT(layers.color[i].x, 0.0f) << i;
  }
}

TEST(Reference, NormalMapsBendAlongTheTangent) {
  Scene scene = sceneOf({squarePrimitive(1)});
  scene.images.push_back({"", {1, 1}, {255, 128, 255, 255}}); // 45 degrees towards the tangent
  scene.textures.emplace_back();
  scene.textures[0].image = 0;
  scene.materials[0].normalTexture.texture = 0;
  scene.meshes[0].primitives[0].tangents.assign(4, {0, 1, 0, 1});
  const FrameLayers layers = trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness());
  expectNear(layers.normal[centreOf(layers)], glm::normalize(glm::vec3(0, 1, 1)), 5e-3f);
  expectNear(layers.normalSurface[centreOf(layers)], {0, 0, 1}, 1e-6f);

  // The bitangent is cross(n, t) w, and mirrors with the node: +Y of the texture is -X here, +X on a mirrored node.
  scene.images[0].rgba = {128, 255, 255, 255};
  expectNear(trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness()).normal[centreOf(layers)],
             glm::normalize(glm::vec3(-1, 0, 1)), 5e-3f);
  scene.nodes[0].scale = {-1, 1, 1};
  expectNear(trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness()).normal[centreOf(layers)],
             glm::normalize(glm::vec3(1, 0, 1)), 5e-3f);
  scene.images[0].rgba = {255, 128, 255, 255};
  expectNear(trace(scene, viewFrom({0, 0, 3}, {0, 0, 0}), darkness()).normal[centreOf(layers)],
             glm::normalize(glm::vec3(0, 1, 1)), 5e-3f);
}

TEST(Reference, DistantTexturesAreFiltered) {
  // A fine checkerboard far away has its mean colour, not one of its two.
  Scene scene = sceneOf({squarePrimitive(1)});
  Image checker;
  checker.size = {64, 64};
  for (int i = 0; i < 64 * 64; ++i) {
    const std::uint8_t value = (i % 64 + i / 64) % 2 ? 255 : 0;
    checker.rgba.insert(checker.rgba.end(), {value, value, value, 255});
  }
  scene.images.push_back(checker);
  scene.textures.emplace_back();
  scene.textures[0].image = 0;
  scene.materials[0].baseColorTexture.texture = 0;
  const FrameLayers far = trace(scene, viewFrom({0, 0, 100}, {0, 0, 0}), darkness());
  EXPECT_NEAR(far.albedo[centreOf(far)].x, 0.5f, 1e-3f);
  const FrameLayers near = trace(scene, viewFrom({1.0f / 64, 1.0f / 64, 0.02f}, {1.0f / 64, 1.0f / 64, 0}), darkness());
  const float value = near.albedo[centreOf(near)].x;
  EXPECT_TRUE(value < 0.2f || value > 0.8f) << value;
}

TEST(Reference, SdfNodesAreMarked) {
  Scene scene = sceneOf({squarePrimitive(10), squarePrimitive(0.5f)});
  scene.nodes[1].translation = {0, 0, 1};
  const Pose pose = poseScene(scene, {});
  const View view = viewFrom({0, 0, 3}, {0, 0, 0});
  const Lighting lighting = darkness();
  ReferenceRequest request{&scene, &pose, &view, &lighting, [](int node) { return node == 1; }, 1, 0, 0};
  const FrameLayers layers = traceReference(request);
  EXPECT_EQ(layers.kind[centreOf(layers)], SurfaceKind::Sdf);
  EXPECT_EQ(layers.kind[0], SurfaceKind::Mesh);
}

TEST(Reference, ManySamplesSmoothEdgesAndLeaveLayersAlone) {
  Scene scene = sceneOf({spherePrimitive(64, 128)});
  scene.materials[0].unlit = true;
  const View view = viewFrom({0, 0, 3}, {0, 0, 0});
  const FrameLayers one = trace(scene, view, darkness(), 1), many = trace(scene, view, darkness(), 64);
  EXPECT_EQ(one.depth, many.depth);
  EXPECT_EQ(one.id, many.id);
  double area = 0.0;
  int between = 0;
  for (const glm::vec3 color : many.color) {
    area += color.x;
    between += color.x > 0.05f && color.x < 0.95f;
  }
  EXPECT_GT(between, 50);
  // A unit sphere 3 m away covers a disk of tan(asin(1/3)) = 1/√8 on a picture of half height tan(0.4).
  const double pixelRadius = 32.5 / std::sqrt(8.0) / std::tan(0.4);
  const double expected = std::numbers::pi * pixelRadius * pixelRadius;
  // Rounding of each edge pixel to 64 parts, some 170 of them with random sign, and 5e-4 for the facets.
  EXPECT_NEAR(area, expected, expected * 1.5e-3);
}

TEST(Reference, ThreadsChangeNothing) {
  Scene scene = sceneOf({spherePrimitive(64, 128), squarePrimitive(10)});
  scene.nodes[1].translation = {0, 0, -2};
  Lighting lighting = makeLighting({}, {"sun:1,-1,-2:1:3"}, {});
  const View view = viewFrom({1, 2, 4}, {0, 0, 0}, {101, 67});
  const FrameLayers one = trace(scene, view, lighting, 3, 1), two = trace(scene, view, lighting, 3, 2);
  EXPECT_EQ(one.color, two.color);
  EXPECT_EQ(one.depth, two.depth);
  EXPECT_EQ(one.normal, two.normal);
  EXPECT_EQ(one.albedo, two.albedo);
  EXPECT_EQ(one.id, two.id);
}

TEST(Reference, ReportsProgressAndStopsWhenAsked) {
  Scene scene = sceneOf({squarePrimitive(1)});
  const Pose pose = poseScene(scene, {});
  const View view = viewFrom({0, 0, 3}, {0, 0, 0}, {256, 256});
  const Lighting lighting = darkness();
  const ReferenceRequest request{&scene, &pose, &view, &lighting, {}, 1, 0, 0};
  std::uint64_t last = 0, total = 0;
  Progress progress;
  progress.report = [&](std::string_view, std::uint64_t done, std::uint64_t all) {
    EXPECT_GE(done, last);
    last = done, total = all;
  };
  traceReference(request, progress);
  EXPECT_EQ(last, 256u);
  EXPECT_EQ(total, 256u);

  std::atomic<bool> cancelled = false;
  progress.cancelled = &cancelled;
  progress.report = [&](std::string_view, std::uint64_t, std::uint64_t) { cancelled = true; };
  EXPECT_THROW(traceReference(request, progress), Cancelled);
}

TEST(Reference, EmptySceneIsSky) {
  Lighting lighting = darkness();
  lighting.environment.radiance.assign(8, glm::vec3(0.25f));
  const FrameLayers layers = trace({}, viewFrom({0, 0, 3}, {0, 0, 0}, {5, 3}), lighting);
  for (const glm::vec3 color : layers.color) EXPECT_EQ(color, glm::vec3(0.25f));
}
