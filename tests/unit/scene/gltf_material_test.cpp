// Materials, textures, samplers, images.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/data.h"
#include "tests/unit/scene/gltf_builder.h"

namespace brickfield::test {

namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

// One pixel, pure red: PNG of 8-bit RGB.
constexpr const char* kRedPng =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/"
    "pLvAAAAAElFTkSuQmCC";

GltfBuilder textured() {
  GltfBuilder builder;
  builder.append("images", json{{"uri", kRedPng}, {"name", "Red"}});
  builder.append("textures", json{{"source", 0}});
  builder.append("materials", json{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  return builder;
}

TEST(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
  GltfBuilder builder;
  builder.append("materials", "{}");
  const Material material = builder.import().materials[0];
  EXPECT_EQ(material.baseColor, glm::vec4(1));
  EXPECT_EQ(material.metallic, 1.0f);
  EXPECT_EQ(material.roughness, 1.0f);
  EXPECT_EQ(material.emission, glm::vec3(0));
  EXPECT_EQ(material.alphaMode, AlphaMode::Opaque);
  EXPECT_EQ(material.alphaCutoff, 0.5f);
  EXPECT_FALSE(material.doubleSided);
  EXPECT_FALSE(material.unlit);
}

// Of light of the attenuation colour that is left after the attenuation distance.
TEST(GltfMaterial, LightThatPassesThrough) {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = {"KHR_materials_diffuse_transmission", "KHR_materials_volume"};
  builder.append("materials", R"({"extensions":{
    "KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.25,"diffuseTransmissionColorFactor":[1,0.5,2]},
    "KHR_materials_volume":{"attenuationDistance":0.5,"attenuationColor":[0.1,1,0]}}})");
  builder.append("materials", R"({"extensions":{"KHR_materials_diffuse_transmission":{},"KHR_materials_volume":{}}})");
  const Scene scene = builder.import();
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("extension KHR_materials_volume is read without its textures")));
  const Material& first = scene.materials[0];
  EXPECT_EQ(first.diffuseTransmission, 0.25f);
  EXPECT_EQ(first.diffuseTransmissionColor, glm::vec3(1, 0.5f, 2));
  EXPECT_NEAR(std::exp(-0.5f * first.absorption.x), 0.1f, 1e-6f);
  EXPECT_EQ(first.absorption.y, 0.0f);
  EXPECT_NEAR(std::exp(-0.5f * first.absorption.z), 0.0f, 2e-6f);
  EXPECT_EQ(scene.materials[1].diffuseTransmission, 0.0f);
  EXPECT_EQ(scene.materials[1].diffuseTransmissionColor, glm::vec3(1));
  EXPECT_EQ(scene.materials[1].absorption, glm::vec3(0));
  for (const char* wrong :
       {R"({"KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":1.5}})",
        R"({"KHR_materials_diffuse_transmission":{"diffuseTransmissionColorFactor":[1,-1,1]}})",
        R"({"KHR_materials_diffuse_transmission":7})", R"({"KHR_materials_volume":{"attenuationDistance":0}})",
        R"({"KHR_materials_volume":{"attenuationColor":[1,1]}})"}) {
    GltfBuilder refused;
    refused.root["extensionsUsed"] = {"KHR_materials_diffuse_transmission", "KHR_materials_volume"};
    refused.append("materials", json{{"extensions", json::parse(wrong)}});
    EXPECT_THAT(refused.error(), HasSubstr("KHR_materials")) << wrong;
  }
}

TEST(GltfMaterial, EveryMemberArrives) {
  GltfBuilder builder = textured();
  builder.root["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_materials_unlit"};
  builder.append("materials", R"({"name":"All","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
    "emissiveFactor":[0.5,0.25,1],"emissiveTexture":{"index":0},"normalTexture":{"index":0,"scale":2},
    "occlusionTexture":{"index":0,"strength":0.5,"texCoord":1},
    "pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.6,"roughnessFactor":0.7,
    "metallicRoughnessTexture":{"index":0}},
    "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},"KHR_materials_unlit":{}}})");
  const Material material = builder.import().materials[1];
  EXPECT_EQ(material.name, "All");
  EXPECT_TRUE(material.doubleSided);
  EXPECT_TRUE(material.unlit);
  EXPECT_EQ(material.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(material.alphaCutoff, 0.25f);
  EXPECT_EQ(material.emission, glm::vec3(2, 1, 4));
  EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.6f);
  EXPECT_EQ(material.roughness, 0.7f);
  EXPECT_EQ(material.normalScale, 2.0f);
  EXPECT_EQ(material.occlusionStrength, 0.5f);
  EXPECT_EQ(material.occlusionTexture.uvSet, 1);
  EXPECT_FALSE(material.baseColorTexture.isUsed());
  for (const TextureSlot* slot : {&material.emissionTexture, &material.normalTexture, &material.occlusionTexture,
                                  &material.metallicRoughnessTexture})
    EXPECT_EQ(slot->texture, 0);
}

TEST(GltfMaterial, TextureTransformTurnsScalesAndShifts) {
  GltfBuilder builder = textured();
  builder.root["extensionsUsed"] = {"KHR_texture_transform"};
  builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
      {"KHR_texture_transform",
       {{"offset", {0.5, 0.25}}, {"rotation", std::numbers::pi / 2}, {"scale", {2, 3}}, {"texCoord", 1}}}};
  const TextureSlot slot = builder.import().materials[0].baseColorTexture;
  EXPECT_EQ(slot.uvSet, 1) << "the extension's set wins";
  const auto apply = [&](float u, float v) { return glm::vec2(slot.textureFromUv * glm::vec3(u, v, 1)); };
  const auto expectAt = [&](glm::vec2 actual, glm::vec2 expected) {
    EXPECT_NEAR(actual.x, expected.x, 1e-6f);
    EXPECT_NEAR(actual.y, expected.y, 1e-6f);
  };
  // Scale to (2u, 3v), then turn by 90 degrees, (x, y) -> (y, -x) counter-clockwise with v downwards, then shift.
  expectAt(apply(0, 0), {0.5f, 0.25f});
  expectAt(apply(1, 0), {0.5f, 0.25f - 2.0f});
  expectAt(apply(0, 1), {0.5f + 3.0f, 0.25f});
}

TEST(GltfMaterial, RotationTurnsAsTheSampleMarks) {
  // The quad "Rotation" shows an arrow that starts in its upper left corner; child nodes mark where it should point and
  // where it points when turned the wrong way.
  BRICKFIELD_NEEDS_DATA("texture_transform_test.glb");
  const Scene scene = importGltf(dataFile("texture_transform_test.glb"));
  const auto quad =
      std::find_if(scene.nodes.begin(), scene.nodes.end(), [](const Node& n) { return n.name == "Rotation"; });
  ASSERT_NE(quad, scene.nodes.end());
  const Primitive& primitive = scene.meshes[static_cast<std::size_t>(quad->mesh)].primitives[0];
  const TextureSlot& slot = materialOf(scene, primitive).baseColorTexture;
  const Image& image =
      scene.images[static_cast<std::size_t>(scene.textures[static_cast<std::size_t>(slot.texture)].image)];
  const auto redTowards = [&](const char* marker) {
    const auto node =
        std::find_if(scene.nodes.begin(), scene.nodes.end(), [&](const Node& n) { return n.name == marker; });
    const glm::vec2 corner(-0.5f, 0.5f);
    const glm::vec2 place = corner + 0.5f * (glm::vec2(node->translation) - corner);
    const glm::vec2 uv(slot.textureFromUv * glm::vec3(place.x + 0.5f, 0.5f - place.y, 1.0f));
    const auto column = static_cast<std::size_t>(uv.x * static_cast<float>(image.size.x));
    const auto row = static_cast<std::size_t>(uv.y * static_cast<float>(image.size.y));
    return static_cast<int>(image.rgba[4 * (row * image.size.x + column)]);
  };
  EXPECT_LT(redTowards("Rotation - Correct"), 50) << "the black arrow";
  EXPECT_GT(redTowards("Rotation - Error"), 200) << "the white ground";
  EXPECT_GT(redTowards("Rotation - Not Supported"), 200);
}

TEST(GltfMaterial, SamplersOfEveryKind) {
  GltfBuilder builder;
  builder.append("images", json{{"uri", kRedPng}});
  struct Case {
    int code;
    Filter minify;
    std::optional<Filter> mipmap;
  };
  const std::vector<Case> cases = {{9728, Filter::Nearest, std::nullopt},    {9729, Filter::Linear, std::nullopt},
                                   {9984, Filter::Nearest, Filter::Nearest}, {9985, Filter::Linear, Filter::Nearest},
                                   {9986, Filter::Nearest, Filter::Linear},  {9987, Filter::Linear, Filter::Linear}};
  for (const Case& each : cases) {
    const int sampler = builder.append(
        "samplers", json{{"minFilter", each.code}, {"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
    builder.append("textures", json{{"sampler", sampler}, {"source", 0}});
  }
  builder.append("textures", json{{"source", 0}});
  const Scene scene = builder.import();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const SceneTexture& texture = scene.textures[i];
    EXPECT_EQ(texture.minify, cases[i].minify) << cases[i].code;
    EXPECT_EQ(texture.mipmap, cases[i].mipmap) << cases[i].code;
    EXPECT_EQ(texture.magnify, Filter::Nearest);
    EXPECT_EQ(texture.wrapU, Wrap::ClampToEdge);
    EXPECT_EQ(texture.wrapV, Wrap::MirroredRepeat);
  }
  EXPECT_EQ(scene.textures.back().wrapU, Wrap::Repeat);
  EXPECT_EQ(scene.textures.back().mipmap, Filter::Linear);
}

TEST(GltfMaterial, UsedImagesAreDecodedUnusedOnesAreNot) {
  GltfBuilder builder = textured();
  builder.append("images", json{{"uri", "missing.png"}});
  const Scene scene = builder.import();
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[0].size, glm::uvec2(1, 1));
  EXPECT_THAT(scene.images[0].rgba, ::testing::ElementsAre(255, 0, 0, 255));
  EXPECT_EQ(scene.images[1].size, glm::uvec2(0));
  builder.root["textures"][0]["source"] = 1;
  EXPECT_THAT(builder.error(),
              HasSubstr("test.glb: image 1: uri \"missing.png\" names a file, but this glTF has no folder"));
}

TEST(GltfMaterial, BrokenAndLargeImagesNameTheImage) {
  GltfBuilder builder = textured();
  builder.root["images"][0]["uri"] = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAA";
  EXPECT_THAT(builder.error(), HasSubstr("image 0 \"Red\": is neither a PNG nor a JPEG"));
  builder.root["images"][0]["uri"] = kRedPng;
  ImportLimits limits;
  limits.imagePixelsTotal = 0;
  EXPECT_THAT(builder.error(limits), HasSubstr("image 0 \"Red\": the images have more than 0 pixels"));
  limits = {};
  limits.imageSidePixels = 0;
  EXPECT_THAT(builder.error(limits), HasSubstr("has 1 x 1 pixels, at most 0 a side"));
}

TEST(GltfMaterial, SlotsThatCannotBeServedAreLeftOutAloud) {
  GltfBuilder builder = textured();
  builder.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 2;
  Scene scene = builder.import();
  EXPECT_FALSE(scene.materials[0].baseColorTexture.isUsed());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("baseColorTexture uses TEXCOORD_2")));
  builder = textured();
  builder.root["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  scene = builder.import();
  EXPECT_FALSE(scene.materials[0].baseColorTexture.isUsed());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("no image that is read")));
}

TEST(GltfMaterial, ExtensionsAreReportedOrRefused) {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_unlit"};
  const Scene scene = builder.import();
  EXPECT_THAT(scene.warnings, Contains("extension KHR_materials_sheen is not supported and left out"));
  EXPECT_EQ(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                          [](const std::string& w) { return w.starts_with("extension "); }),
            1);
  builder.root["extensionsRequired"] = {"KHR_materials_unlit"};
  EXPECT_EQ(builder.error(), "");
  builder.root["extensionsRequired"] = {"KHR_materials_sheen"};
  EXPECT_THAT(builder.error(), HasSubstr("test.glb: extensionsRequired: KHR_materials_sheen is not supported"));
}

} // namespace

} // namespace brickfield::test
