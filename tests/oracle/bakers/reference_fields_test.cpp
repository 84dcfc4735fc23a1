// SDF objects traced as their own bricks: where they are, what they look like, what they shadow.
#include "field/analytic.h"
#include "tests/oracle/bakers/reference_scenes.h"

namespace brickfield::test {
namespace {

/// A unit sphere of 64 voxels along its box, which is also a mesh of eight triangles that nobody should see.
struct FieldScene {
  explicit FieldScene(int bits = 16) {
    const auto distance = [](glm::vec3 point) { return sphereDistance(point, glm::vec3(0), 1.0f); };
    fields.push_back(makeAnalyticField(distance, {glm::vec3(-1), glm::vec3(1)}, 64, bits, 3));
    scene = sceneOf({spherePrimitive(2, 4), squarePrimitive(50)});
    scene.nodes[1].translation = {0, 0, -1};
  }
  float voxel() const { return fields[0].levels[0].voxelSizeObject; }
  FrameLayers trace(const View& view, const Lighting& lighting, ReferenceRequest request = {}) const {
    request.fields = {&fields, &fieldOfNode};
    return test::trace(scene, view, lighting, request);
  }

  Scene scene;
  std::vector<BrickField> fields;
  std::vector<int> fieldOfNode{0, -1};
};

ReferenceRequest layersOf(int samples) {
  ReferenceRequest request;
  request.samples = samples;
  request.shadowLayers = true;
  return request;
}

} // namespace

// Curvature sinks the reconstructed surface by h²/8 of second derivative 1 along two axes: h²/4, under a hundredth of a
// voxel of 1/32; depth errors grow by one over the cosine.
TEST(ReferenceFields, SphereIsWhereItsBricksSay) {
  FieldScene objects;
  const glm::vec3 centre(1, 2, 0.5f);
  for (const glm::vec3 scale : {glm::vec3(1), glm::vec3(0.5f), glm::vec3(-2, 2, 2)}) {
    objects.scene.nodes[0].translation = centre;
    objects.scene.nodes[0].scale = scale;
    const float radius = std::abs(scale.x);
    const View view = viewFrom(centre + glm::vec3(1, -2, 4) * radius, centre);
    const FrameLayers layers = objects.trace(view, darkness());
    int hits = 0;
    for (std::size_t i = 0; i < layers.id.size(); ++i) {
      const PrimaryRay ray = primaryRay(view, {static_cast<float>(i % 65) + 0.5f, static_cast<float>(i / 65) + 0.5f});
      const glm::dvec3 offset = glm::dvec3(ray.originWorld - centre) / double{radius}, direction(ray.directionWorld);
      const double b = glm::dot(offset, direction), discriminant = b * b - glm::dot(offset, offset) + 1.0;
      if (std::abs(discriminant) < 0.02) continue; // the outline, within a third of a voxel
      ASSERT_EQ(layers.id[i] == 0, discriminant > 0) << i;
      if (layers.id[i] != 0) continue;
      ++hits;
      const double root = std::sqrt(discriminant);
      ASSERT_NEAR(layers.depth[i] / radius, -b - root, 0.01 * objects.voxel() / root);
      ASSERT_EQ(layers.kind[i], SurfaceKind::Sdf);
      ASSERT_GT(glm::dot(glm::dvec3(layers.normal[i]), offset + (-b - root) * direction), 0.9999);
      ASSERT_EQ(layers.albedo[i], glm::vec3(1.0f)) << "without attributes white";
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(ReferenceFields, AttributesOfBricksAreShaded) {
  FieldScene objects;
  addAttributes(objects.fields[0], [](glm::vec3) {
    SurfaceAttributes attributes;
    attributes.baseColor = {0.2f, 0.4f, 0.8f, 1.0f};
    attributes.emission = {0, 3, 0};
    return attributes;
  });
  const FrameLayers layers = objects.trace(viewFrom({0, 0, 4}, {0, 0, 0}), darkness());
  expectNear(layers.albedo[centreOf(layers)], {0.2f, 0.4f, 0.8f}, 0.005f);
  expectNear(layers.color[centreOf(layers)], {0, 3, 0}, 0.02f);
}

// Of the sphere's half that coverage cuts away, nothing is seen and nothing shadows the ground at z = -1.
TEST(ReferenceFields, WhatCoverageCutsAwayIsNotThere) {
  FieldScene objects;
  const float voxel = objects.voxel();
  addAttributes(objects.fields[0], [voxel](glm::vec3 p) {
    SurfaceAttributes attributes;
    attributes.baseColor.w = std::clamp(0.5f + p.x / (4 * voxel), 0.0f, 1.0f);
    return attributes;
  });
  const View view = viewFrom({0, 0.01f, 4}, {0, 0, 0});
  Lighting sun = darkness();
  sun.lights.push_back(sunAlong({0, 0, -1}));
  const FrameLayers layers = objects.trace(view, sun, layersOf(1));
  int kept = 0, cut = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    const PrimaryRay ray = primaryRay(view, {static_cast<float>(i % 65) + 0.5f, static_cast<float>(i / 65) + 0.5f});
    const glm::vec3 o = ray.originWorld, d = ray.directionWorld;
    const float b = glm::dot(o, d), discriminant = b * b - glm::dot(o, o) + 1.0f;
    if (discriminant < 0.05f) continue;
    const glm::vec3 point = o + (-b - std::sqrt(discriminant)) * d;
    if (std::abs(point.x) < voxel) continue;
    (point.x > 0 ? kept : cut) += 1;
    ASSERT_EQ(layers.id[i], point.x > 0 ? 0 : 1) << i;
    const glm::vec3 onGround = o + (-1 - o.z) / d.z * d;
    if (point.x < 0 && onGround.x < -voxel) {
      ASSERT_EQ(layers.shadow.at(0)[i], 1.0f) << i;
    }
  }
  EXPECT_GT(std::min(kept, cut), 200);
}

// The sphere touches the ground at z = -1: its hard shadow under a vertical sun is the unit disk; a lamp's is a disk of
// the tangent cone. A border of a hundredth is left out.
TEST(ReferenceFields, ShadowsFallWhereTheSphereSays) {
  const FieldScene objects;
  Lighting lighting = darkness();
  lighting.lights.push_back(sunAlong({0, 0, -1}));
  PosedLight lamp;
  lamp.light.kind = LightKind::Point;
  lamp.light.intensity = 10;
  lamp.positionWorld = {0, 0, 3};
  lighting.lights.push_back(lamp);
  const View view = viewFrom({2, -6, 1}, {0, 0, -1}, {96, 64});
  const FrameLayers layers = objects.trace(view, lighting, layersOf(1));
  const double coneRadius = 4 * std::tan(std::asin(1.0 / 3.0));
  int lit = 0, dark = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    if (layers.id[i] != 1) continue;
    const PrimaryRay ray = primaryRay(view, {static_cast<float>(i % 96) + 0.5f, static_cast<float>(i / 96) + 0.5f});
    const double radius = glm::length(glm::vec2(ray.originWorld + layers.depth[i] * ray.directionWorld));
    if (std::abs(radius - 1) < 0.01 || std::abs(radius - coneRadius) < 0.02) continue;
    ASSERT_EQ(layers.shadow[0][i], radius > 1 ? 1.0f : 0.0f) << radius;
    ASSERT_EQ(layers.shadow[1][i], radius > coneRadius ? 1.0f : 0.0f) << radius;
    (radius > coneRadius ? lit : dark)++;
  }
  EXPECT_GT(std::min(lit, dark), 100);
}

// No acne: with eight bits, whose codes make the surface ripple by 0.03 voxel, everything that faces the sun by more
// than a degree or so is lit, everything beyond the terminator dark.
TEST(ReferenceFields, FieldsDoNotShadowThemselves) {
  for (const int bits : {8, 16}) {
    const FieldScene objects(bits);
    Lighting lighting = darkness();
    lighting.lights.push_back(sunAlong({-1, 0.3f, -0.5f}));
    const glm::vec3 towardsSun = -lighting.lights[0].directionWorld;
    const View view = viewFrom({1.5f, -3.0f, 2}, {0, 0, 0}, {128, 128});
    const FrameLayers layers = objects.trace(view, lighting, layersOf(1));
    int lit = 0, dark = 0;
    for (std::size_t i = 0; i < layers.id.size(); ++i) {
      if (layers.id[i] != 0) continue;
      const PrimaryRay ray = primaryRay(view, {static_cast<float>(i % 128) + 0.5f, static_cast<float>(i / 128) + 0.5f});
      const float cosine = glm::dot(ray.originWorld + layers.depth[i] * ray.directionWorld, towardsSun);
      if (std::abs(cosine) < 0.03f) continue;
      (cosine > 0 ? lit : dark)++;
      ASSERT_EQ(layers.shadow[0][i], cosine > 0 ? 1.0f : 0.0f) << bits << " bits, cosine " << cosine;
    }
    EXPECT_GT(lit, 1000);
    EXPECT_GT(dark, 150);
  }
}

// Codes of 8 bits make steps across a slanted plane; light at 3 degrees and less would catch on them.
TEST(ReferenceFields, FlatFieldsAreLitEvenly) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.13f, -0.29f, 1));
  const auto distance = [&](glm::vec3 point) { return planeDistance(point, normal, 0.02f); };
  FieldScene objects;
  objects.fields[0] = makeAnalyticField(distance, {glm::vec3(-1, -1, -0.6f), glm::vec3(1, 1, 0.6f)}, 64, 8, 3);
  objects.scene.nodes[1].translation = {0, 0, -3};
  const glm::vec3 along = glm::normalize(glm::cross(glm::vec3(0.7f, 0.4f, 0), normal)); // the sun stands where it rises
  for (const float degrees : {1.5f, 3.0f}) {
    Lighting lighting = darkness();
    lighting.lights.push_back(sunAlong(along - std::tan(glm::radians(degrees)) * normal));
    const FrameLayers layers = objects.trace(viewFrom(3.0f * normal, {0, 0, 0}, {64, 64}), lighting, layersOf(1));
    int hits = 0, dark = 0;
    for (std::size_t i = 0; i < layers.id.size(); ++i) {
      hits += layers.id[i] == 0;
      dark += layers.id[i] == 0 && layers.shadow[0][i] < 1.0f;
    }
    ASSERT_GT(hits, 1000);
    EXPECT_EQ(dark, 0) << "of " << hits << " at " << degrees << " degrees";
  }
}

// Ground at distance x from where a unit sphere stands on it: the sphere's direction cosine over d², with d² = x² + 1,
// is what it hides, as long as it stands wholly above the horizon: it touches it here. sin² of the cone times the
// cosine of its axis is 1 / d² * 1 / d (Nusselt).
TEST(ReferenceFields, OcclusionIsTheSpheresFormFactor) {
  const FieldScene objects;
  ReferenceRequest request = layersOf(1024);
  request.ambientOcclusionMetres = std::numeric_limits<float>::infinity();
  for (const float x : {0.5f, 1.0f, 2.0f, 4.0f}) {
    const View view = makePerspectiveView({x, -0.05f, -0.9f}, {x, 0, -1}, 0.01f, 0.001f, {1, 1});
    const FrameLayers layers = objects.trace(view, darkness(), request);
    ASSERT_EQ(layers.id[0], 1);
    EXPECT_NEAR(layers.ambientOcclusion[0], 1 - std::pow(x * x + 1, -1.5), 0.01) << x;
  }
}

} // namespace brickfield::test
