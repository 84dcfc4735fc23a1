// Texture look-ups against values worked out by hand.
#include "scene/texture_sampling.h"

#include <gtest/gtest.h>

using namespace brickfield;

namespace {

/// A scene with one grey image (the same value in R, G, B, alpha 255) under one texture.
Scene greyScene(glm::uvec2 size, const std::vector<std::uint8_t>& greys) {
  Scene scene;
  Image image;
  image.size = size;
  for (const std::uint8_t grey : greys) image.rgba.insert(image.rgba.end(), {grey, grey, grey, 255});
  scene.images.push_back(image);
  scene.textures.emplace_back();
  scene.textures[0].image = 0;
  return scene;
}

float redAt(const Scene& scene, glm::vec2 uv, float footprint = 0.0f) {
  const TextureSampler sampler(scene);
  return 255.0f * sampler.sample(0, TextureEncoding::Linear, uv, glm::mat2(footprint)).x;
}

constexpr float kRounding = 1e-3f; // of 255: far below a step of the image

} // namespace

TEST(TextureSampling, BilinearMeetsTexelsAtTheirCentres) {
  const Scene scene = greyScene({2, 2}, {0, 100, 200, 40});
  EXPECT_NEAR(redAt(scene, {0.25f, 0.25f}), 0.0f, kRounding);
  EXPECT_NEAR(redAt(scene, {0.75f, 0.25f}), 100.0f, kRounding);
  EXPECT_NEAR(redAt(scene, {0.25f, 0.75f}), 200.0f, kRounding) << "v grows downwards from the first row";
  EXPECT_NEAR(redAt(scene, {0.5f, 0.5f}), 85.0f, kRounding);
  EXPECT_NEAR(redAt(scene, {0.375f, 0.25f}), 25.0f, kRounding);
}

TEST(TextureSampling, WrapModesReachTheRightNeighbour) {
  Scene scene = greyScene({4, 1}, {10, 20, 30, 40});
  scene.textures[0].magnify = Filter::Nearest;
  const auto at = [&](Wrap wrap, float u) {
    scene.textures[0].wrapU = wrap;
    return redAt(scene, {u, 0.5f});
  };
  EXPECT_NEAR(at(Wrap::Repeat, 1.1f), 10, kRounding);
  EXPECT_NEAR(at(Wrap::Repeat, -0.1f), 40, kRounding);
  EXPECT_NEAR(at(Wrap::Repeat, -7.6f), 20, kRounding);
  EXPECT_NEAR(at(Wrap::ClampToEdge, 7.0f), 40, kRounding);
  EXPECT_NEAR(at(Wrap::ClampToEdge, -3.0f), 10, kRounding);
  EXPECT_NEAR(at(Wrap::MirroredRepeat, 1.1f), 40, kRounding);
  EXPECT_NEAR(at(Wrap::MirroredRepeat, -0.3f), 20, kRounding);
  EXPECT_NEAR(at(Wrap::MirroredRepeat, 2.3f), 20, kRounding);
  EXPECT_NEAR(at(Wrap::Repeat, 3e30f), at(Wrap::Repeat, 0.0f), kRounding) << "coordinates beyond any integer";
}

TEST(TextureSampling, RepeatBlendsAcrossTheSeam) {
  const Scene scene = greyScene({2, 1}, {0, 100});
  EXPECT_NEAR(redAt(scene, {0.0f, 0.5f}), 50.0f, kRounding);
  EXPECT_NEAR(redAt(scene, {1.0f, 0.5f}), 50.0f, kRounding);
}

TEST(TextureSampling, SrgbIsDecodedBeforeItIsBlended) {
  const Scene scene = greyScene({2, 1}, {0, 255});
  const TextureSampler sampler(scene);
  EXPECT_NEAR(sampler.sample(0, TextureEncoding::Srgb, {0.5f, 0.5f}).x, 0.5f, 1e-6f);
  const Scene grey = greyScene({1, 1}, {188});
  const TextureSampler greySampler(grey);
  EXPECT_NEAR(greySampler.sample(0, TextureEncoding::Srgb, {0.5f, 0.5f}).x, linearFromSrgb(188.0f / 255.0f), 1e-6f);
  EXPECT_EQ(greySampler.sample(0, TextureEncoding::Srgb, {0.5f, 0.5f}).w, 1.0f);
}

TEST(TextureSampling, WholeTextureFootprintIsTheMean) {
  // 5 by 3: odd sides, where a filter that drops a row would be wrong by percents.
  std::vector<std::uint8_t> greys;
  float sum = 0;
  for (int i = 0; i < 15; ++i) greys.push_back(static_cast<std::uint8_t>(i * 17)), sum += static_cast<float>(i * 17);
  const Scene scene = greyScene({5, 3}, greys);
  // Three levels round to 16 bits each: 3 * 0.5 / 65535 of 255.
  EXPECT_NEAR(redAt(scene, {0.3f, 0.8f}, 4.0f), sum / 15.0f, 0.01f);
}

TEST(TextureSampling, FootprintOfTwoTexelsReadsTheFirstLevel) {
  const Scene scene = greyScene({4, 4}, {0, 100, 0, 100, 100, 0, 100, 0, 0, 100, 0, 100, 100, 0, 100, 0});
  EXPECT_NEAR(redAt(scene, {0.125f, 0.125f}), 0.0f, kRounding);
  EXPECT_NEAR(redAt(scene, {0.125f, 0.125f}, 0.25f), 0.0f, kRounding) << "one texel wide: still magnified";
  EXPECT_NEAR(redAt(scene, {0.125f, 0.125f}, 0.5f), 50.0f, 0.01f);
  const float between = redAt(scene, {0.125f, 0.125f}, 0.25f * std::sqrt(2.0f));
  EXPECT_NEAR(between, 25.0f, 0.01f) << "half way between two levels";
}

TEST(TextureSampling, NoMipmapReadsTheFullImageWhateverTheFootprint) {
  Scene scene = greyScene({2, 1}, {0, 100});
  scene.textures[0].mipmap.reset();
  EXPECT_NEAR(redAt(scene, {0.75f, 0.5f}, 8.0f), 100.0f, kRounding);
}

TEST(TextureSampling, TransformMovesScalesAndTurns) {
  const Scene scene = greyScene({4, 4}, {0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33});
  const TextureSampler sampler(scene);
  TextureSlot slot;
  slot.texture = 0;
  MaterialPoint point;
  point.uv[0] = {0.25f, 0.5f};
  // Scale (0.5, 0.25), then offset (0.5, 0.5): lands on (0.625, 0.625), the centre of column 2, row 2.
  slot.textureFromUv = glm::mat3(0.5f, 0, 0, 0, 0.25f, 0, 0.5f, 0.5f, 1);
  EXPECT_NEAR(255.0f * sampler.sampleSlot(slot, TextureEncoding::Linear, point).x, 22.0f, kRounding);
  slot.uvSet = 1;
  point.uv[1] = {-0.75f, -1.5f};
  EXPECT_NEAR(255.0f * sampler.sampleSlot(slot, TextureEncoding::Linear, point).x, 0.0f, kRounding);
}

TEST(TextureSampling, MaterialMultipliesFactorsTexturesAndVertexColour) {
  Scene scene = greyScene({1, 1}, {51}); // 0.2
  Material material;
  material.baseColor = {0.5f, 1.0f, 1.0f, 0.5f};
  material.metallic = 0.5f;
  material.roughness = 1.0f;
  material.occlusionStrength = 0.5f;
  material.emission = {2.0f, 0.0f, 0.0f};
  material.metallicRoughnessTexture.texture = material.occlusionTexture.texture = 0;
  MaterialPoint point;
  point.color = {0.5f, 0.25f, 1.0f, 0.5f};
  const TextureSampler sampler(scene);
  const MaterialSample sample = sampler.sampleMaterial(material, point);
  EXPECT_NEAR(sample.baseColor.x, 0.25f, 1e-6f);
  EXPECT_NEAR(sample.baseColor.y, 0.25f, 1e-6f);
  EXPECT_NEAR(sample.baseColor.w, 0.25f, 1e-6f);
  EXPECT_NEAR(sample.metallic, 0.1f, 1e-6f);
  EXPECT_NEAR(sample.roughness, 0.2f, 1e-6f);
  EXPECT_NEAR(sample.occlusion, 0.6f, 1e-6f);
  EXPECT_EQ(sample.emission, glm::vec3(2, 0, 0));
  EXPECT_EQ(sample.normalTangent, glm::vec3(0, 0, 1));
}

TEST(TextureSampling, NormalScaleBendsMore) {
  Scene scene = greyScene({1, 1}, {0});
  scene.images[0].rgba = {255, 128, 255, 255}; // (1, 0.0039, 1): 45 degrees
  Material material;
  material.normalTexture.texture = 0;
  material.normalScale = 2.0f;
  const TextureSampler sampler(scene);
  const glm::vec3 normal = sampler.sampleMaterial(material, {}).normalTangent;
  EXPECT_NEAR(normal.x / normal.z, 2.0f, 1e-5f);
  EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
}

TEST(TextureSampling, AttributesInterpolateBetweenCorners) {
  Primitive primitive;
  primitive.indices = {2, 0, 1};
  primitive.uvs[0] = {{1, 0}, {0, 1}, {0, 0}};
  const MaterialPoint point = materialPointOf(primitive, 0, {0.25f, 0.5f});
  EXPECT_NEAR(point.uv[0].x, 0.25f, 1e-6f);
  EXPECT_NEAR(point.uv[0].y, 0.5f, 1e-6f);
  EXPECT_EQ(point.uv[1], glm::vec2(0.0f));
  EXPECT_EQ(point.color, glm::vec4(1.0f));
}

TEST(TextureSampling, FootprintOfTriangleFollowsItsStretch) {
  // u grows by 1 over 2 m, v by 1 over 0.5 m, in a plane that is tilted.
  const glm::vec3 alongU = glm::normalize(glm::vec3(1, 1, 0)), alongV = glm::vec3(0, 0, 1);
  const glm::mat2 footprint =
      uvPerFootprintOf({glm::vec3(5), 5.0f + 2.0f * alongU, 5.0f + 0.5f * alongV}, {{{0, 0}, {1, 0}, {0, 1}}}, 0.1f);
  EXPECT_NEAR(glm::length(footprint[0]), 0.05f, 1e-6f);
  EXPECT_NEAR(glm::length(footprint[1]), 0.2f, 1e-5f);
  const glm::mat2 none = uvPerFootprintOf({glm::vec3(1), glm::vec3(1), glm::vec3(2)}, {{{0, 0}, {1, 0}, {0, 1}}}, 0.1f);
  EXPECT_EQ(none, glm::mat2(0.0f));
}
