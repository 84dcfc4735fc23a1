// Reflections of the reference against integrals of the BRDF and mirrors in closed form.
#include "bakers/reference_mirror.h"

#include <algorithm>

#include "bakers/reference_samples.h"
#include "tests/oracle/bakers/reference_scenes.h"

namespace brickfield::test {
namespace {

constexpr int kDirections = 40000;

glm::vec3 viewerAt(float nDotV) { return {std::sqrt(1 - nDotV * nDotV), 0, nDotV}; }

template <typename Visit>
void forEachMirrored(const SurfaceBrdf& brdf, glm::vec3 viewer, const Visit& visit) {
  const PixelSamples samples({3, 5}, 7, kDirections);
  for (int i = 0; i < kDirections; ++i)
    visit(sampleMirrored(brdf, {0, 0, 1}, viewer, samples.point(i, SamplePurpose::Mirror)));
}

/// What the specular lobe sends back of light from a part of the hemisphere, by quadrature.
template <typename IsIn>
double lobeOver(const SurfaceBrdf& brdf, glm::vec3 viewer, const IsIn& isIn) {
  constexpr int kRows = 1500, kColumns = 1500;
  double sum = 0;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double z = (row + 0.5) / kRows, turn = 2 * std::numbers::pi * (column + 0.5) / kColumns;
      const double flat = std::sqrt(1 - z * z);
      const glm::vec3 light(flat * std::cos(turn), flat * std::sin(turn), z);
      if (!isIn(light)) continue;
      sum += static_cast<double>(evaluateBrdf(brdf, {0, 0, 1}, viewer, light).x) * z;
    }
  return sum * 2 * std::numbers::pi / kRows / kColumns;
}

TEST(ReferenceMirror, SendsBackOfEvenLightWhatTheTableSays) {
  for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
    for (const float nDotV : {0.05f, 0.4f, 1.0f}) {
      const SurfaceBrdf brdf = makeBrdf({1, 0.6f, 0.2f}, 1, roughness);
      glm::dvec3 sum(0.0);
      forEachMirrored(brdf, viewerAt(nDotV), [&](const MirroredDirection& way) { sum += way.weight; });
      const glm::vec2 entry = environmentBrdf(roughness, nDotV);
      const glm::vec3 found(sum / double{kDirections});
      expectNear(found, brdf.f0 * entry.x + entry.y, 0.008f); // the table has cells
      if (roughness < 0.5f) continue;                         // too sharp a lobe for the quadrature
      EXPECT_NEAR(found.x, lobeOver(brdf, viewerAt(nDotV), [](glm::vec3) { return true; }), 0.002);
    }
}

TEST(ReferenceMirror, EachPartOfTheHemisphereGetsItsShareOfTheLobe) {
  const auto ahead = [](glm::vec3 light) { return light.x < -0.6f; };
  const auto behind = [](glm::vec3 light) { return light.x > 0; };
  const auto beside = [](glm::vec3 light) { return light.y > 0.3f && light.z > 0.5f; };
  for (const float roughness : {0.4f, 0.8f})
    for (const float nDotV : {0.3f, 0.8f}) {
      SurfaceBrdf brdf = makeBrdf({0.9f, 0.9f, 0.9f}, 1, roughness);
      const glm::vec3 viewer = viewerAt(nDotV);
      glm::dvec3 sums(0.0);
      forEachMirrored(brdf, viewer, [&](const MirroredDirection& way) {
        if (way.weight == glm::vec3(0.0f)) return;
        EXPECT_NEAR(glm::length(way.direction), 1, 1e-5f);
        const double weight = way.weight.x;
        sums += glm::dvec3(ahead(way.direction) ? weight : 0, behind(way.direction) ? weight : 0,
                           beside(way.direction) ? weight : 0);
      });
      expectNear(
          glm::vec3(sums / double{kDirections}),
          glm::vec3(lobeOver(brdf, viewer, ahead), lobeOver(brdf, viewer, behind), lobeOver(brdf, viewer, beside)),
          0.006f);
    }
}

TEST(ReferenceMirror, ViewersBelowTheSurfaceSeeNumbers) {
  for (const float roughness : {0.0f, 1.0f})
    forEachMirrored(makeBrdf({1, 1, 1}, 1, roughness), glm::normalize(glm::vec3(1, 0, -0.3f)),
                    [](const MirroredDirection& way) {
                      ASSERT_TRUE(std::isfinite(way.weight.x) && std::isfinite(way.direction.x));
                      ASSERT_LE(way.weight.x, 1.001f);
                    });
}

/// A floor of white metal, z = 0, and a ball of radius 0.3 that glows, 0.5 above it.
constexpr float kGlow = 2, kRadius = 0.3f;
const glm::vec3 kMiddle(0, 0, 0.5f);

Scene ballOverFloor(float roughness) {
  Scene scene = sceneOf({squarePrimitive(5), spherePrimitive(96, 192)});
  scene.nodes[1].translation = kMiddle;
  scene.nodes[1].scale = glm::vec3(kRadius);
  scene.materials.resize(2);
  scene.materials[0].metallic = 1, scene.materials[0].roughness = roughness;
  scene.materials[1].baseColor = {0, 0, 0, 1}, scene.materials[1].emission = glm::vec3(kGlow);
  scene.materials[1].metallic = 1; // black metal mirrors the rest of white alone
  scene.meshes[1].primitives[0].material = 1;
  return scene;
}

Lighting evenly(float radiance) {
  Lighting lighting = darkness();
  lighting.environment.radiance.assign(8, glm::vec3(radiance));
  return lighting;
}

FrameLayers mirror(const Scene& scene, const View& view, const Lighting& lighting, int reflections, int samples) {
  ReferenceRequest request;
  request.reflections = reflections;
  request.samples = samples;
  return trace(scene, view, lighting, request);
}

TEST(ReferenceReflections, MirrorsShowABallWhereItIs) {
  const View view = viewFrom({1.3f, 0.4f, 1.2f}, {0, 0, 0.1f});
  const FrameLayers layers = mirror(ballOverFloor(0), view, darkness(), 1, 1);
  std::size_t mirrored = 0, wrong = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    if (layers.id[i] != 0) continue;
    const PrimaryRay ray = primaryRay(view, glm::vec2(i % layers.size.x, i / layers.size.x) + 0.5f);
    const glm::vec3 point = ray.originWorld + layers.depth[i] * ray.directionWorld;
    const glm::vec3 direction = glm::reflect(ray.directionWorld, glm::vec3(0, 0, 1)), way = kMiddle - point;
    const float along = glm::dot(way, direction), miss = glm::length(way - along * direction);
    if (std::abs(miss - kRadius) < 0.02f) continue; // no mirror is smoother than kLeastRoughness
    const bool isMirrored = along > 0 && miss < kRadius;
    mirrored += isMirrored;
    wrong += isMirrored != (layers.color[i].x > 0.5f);
    if (isMirrored) {
      EXPECT_NEAR(layers.color[i].x, kGlow, 0.02f) << i;
    }
  }
  EXPECT_GT(mirrored, 100u);
  EXPECT_EQ(wrong, 0u);
}

TEST(ReferenceReflections, RoughFloorsMirrorTheIntegralOfTheirLobe) {
  const float roughness = 0.5f;
  const View view = makePerspectiveView({1.3f, 0.4f, 1.2f}, {0.2f, 0, 0}, 0.001f, 0.01f, {1, 1});
  const FrameLayers layers = mirror(ballOverFloor(roughness), view, darkness(), 1, 8192);
  const PrimaryRay ray = primaryRay(view, {0.5f, 0.5f});
  const glm::vec3 point = ray.originWorld - ray.originWorld.z / ray.directionWorld.z * ray.directionWorld;
  const SurfaceBrdf brdf = makeBrdf({1, 1, 1}, 1, roughness);
  const double expected = kGlow * lobeOver(brdf, -ray.directionWorld, [&](glm::vec3 light) {
                            const glm::vec3 way = kMiddle - point;
                            const float along = glm::dot(way, light);
                            return along > 0 && glm::length(way - along * light) < kRadius;
                          });
  ASSERT_EQ(layers.id[0], 0);
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(layers.color[0].x, expected, 0.02 * expected);
}

TEST(ReferenceReflections, EachReflectionMoreReachesAsManyMirrorsDeeper) {
  // Between two mirrors, z = 0 and z = 1, in the dark; the upper one glows by 1, and both send back nine tenths.
  Scene scene = sceneOf({squarePrimitive(50), squarePrimitive(50)});
  scene.nodes[1].translation = {0, 0, 1};
  scene.nodes[1].rotation = glm::quat(0, 1, 0, 0); // faces down
  scene.materials.resize(2);
  for (Material& material : scene.materials)
    material.baseColor = {0.9f, 0.9f, 0.9f, 1}, material.metallic = 1, material.roughness = 0;
  scene.materials[1].emission = glm::vec3(1);
  scene.meshes[1].primitives[0].material = 1;
  const View view = viewFrom({0, 0, 0.5f}, {0.01f, 0, 0});
  double expected = 0, power = 0.9;
  for (int reflections = 0; reflections < 6; ++reflections) {
    const FrameLayers layers = mirror(scene, view, darkness(), reflections, 16);
    EXPECT_NEAR(layers.color[centreOf(layers)].x, expected, 0.01) << reflections;
    if (reflections % 2 == 0) expected += power, power *= 0.9 * 0.9;
  }
}

TEST(ReferenceReflections, OcclusionDimsNoMirroredRay) {
  const View view = viewFrom({1.3f, 0.4f, 1.2f}, {0, 0, 0.1f});
  ReferenceRequest request;
  request.reflections = 1;
  const Scene scene = ballOverFloor(0);
  const FrameLayers without = trace(scene, view, darkness(), request);
  request.ambientOcclusionMetres = 10.0f;
  const FrameLayers with = trace(scene, view, darkness(), request);
  for (std::size_t i = 0; i < with.id.size(); ++i)
    if (with.id[i] == 0) {
      EXPECT_EQ(with.color[i], without.color[i]) << i;
    }
}

TEST(ReferenceReflections, SameBytesOnAnyNumberOfThreads) {
  const View view = viewFrom({1.3f, 0.4f, 1.2f}, {0, 0, 0.1f});
  const Scene scene = ballOverFloor(0.4f);
  ReferenceRequest request;
  request.reflections = 2, request.samples = 8, request.threads = 1;
  const FrameLayers one = trace(scene, view, evenly(0.5f), request);
  request.threads = 2;
  EXPECT_EQ(trace(scene, view, evenly(0.5f), request).color, one.color);
}

} // namespace
} // namespace brickfield::test
