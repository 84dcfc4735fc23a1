// Real files: everything in the data folder loads, with the triangles that its table counts, and keeps the contract of
// scene.h.
#include "scene/gltf_import.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/tangents.h"
#include "tests/support/data.h"

namespace brickfield::test {

namespace {

namespace fs = std::filesystem;

std::size_t triangleCount(const Scene& scene) {
  std::size_t count = 0;
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& primitive : mesh.primitives) count += primitive.indices.size() / 3;
  return count;
}

// What scene.h promises of a primitive.
void expectWhole(const Scene& scene, const Primitive& primitive) {
  const std::size_t count = primitive.positions.size();
  EXPECT_EQ(primitive.indices.size() % 3, 0u);
  EXPECT_TRUE(
      std::all_of(primitive.indices.begin(), primitive.indices.end(), [&](std::uint32_t i) { return i < count; }));
  EXPECT_EQ(primitive.normals.size(), count);
  EXPECT_TRUE(std::all_of(primitive.normals.begin(), primitive.normals.end(),
                          [](glm::vec3 n) { return std::abs(glm::length(n) - 1.0f) < 1e-5f; }));
  EXPECT_TRUE(primitive.tangents.empty() || primitive.tangents.size() == count);
  EXPECT_TRUE(std::all_of(primitive.tangents.begin(), primitive.tangents.end(), [](glm::vec4 t) {
    return std::abs(glm::length(glm::vec3(t)) - 1.0f) < 1e-5f && std::abs(t.w) == 1.0f;
  }));
  EXPECT_TRUE(!materialOf(scene, primitive).normalTexture.isUsed() || primitive.tangents.size() == count);
  for (const auto& uvs : primitive.uvs) EXPECT_TRUE(uvs.empty() || uvs.size() == count);
  EXPECT_TRUE(primitive.colors.empty() || primitive.colors.size() == count);
  EXPECT_EQ(primitive.joints.size(), count * static_cast<std::size_t>(primitive.influencesPerVertex));
  EXPECT_EQ(primitive.jointWeights.size(), primitive.joints.size());
  for (const MorphTarget& target : primitive.morphTargets)
    for (const auto* offsets : {&target.positions, &target.normals, &target.tangents})
      EXPECT_TRUE(offsets->empty() || offsets->size() == count);
}

TEST(GltfImport, EveryValidFileLoadsWhole) {
  if (!requireData("README.md")) return;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(dataFolder())) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().filename().string());
    ++files;
    Scene scene;
    ASSERT_NO_THROW(scene = importGltf(entry.path()));
    EXPECT_EQ(scene.name, entry.path().string());
    EXPECT_GE(scene.defaultScene, 0);
    EXPECT_GT(triangleCount(scene), 0u);
    for (const Mesh& mesh : scene.meshes)
      for (const Primitive& primitive : mesh.primitives) {
        expectWhole(scene, primitive);
        EXPECT_EQ(primitive.morphTargets.size(), mesh.morphWeights.size());
      }
    for (const Material& material : scene.materials)
      if (material.baseColorTexture.isUsed()) {
        const Image& image = scene.images[static_cast<std::size_t>(
            scene.textures[static_cast<std::size_t>(material.baseColorTexture.texture)].image)];
        EXPECT_GT(image.size.x, 0u);
        EXPECT_EQ(image.rgba.size(), std::size_t{4} * image.size.x * image.size.y);
      }
    for (const std::string& warning : scene.warnings)
      EXPECT_THAT(warning, ::testing::StartsWith("extension ")) << "a valid file needs no repair";
  }
  EXPECT_GE(files, 45);
}

TEST(GltfImport, TrianglesAreThoseOfTheTable) {
  if (!requireData("README.md")) return;
  const std::map<std::string, std::size_t> expected = {{"alpha_blend_mode_test", 61},
                                                       {"animated_cube", 12},
                                                       {"avocado", 682},
                                                       {"blub_fish", 21568},
                                                       {"box", 12},
                                                       {"box_interleaved", 12},
                                                       {"box_vertex_colors", 12},
                                                       {"cesium_man", 4672},
                                                       {"chess_board", 178848},
                                                       {"flight_helmet", 94722},
                                                       {"fox", 576},
                                                       {"glam_velvet_sofa", 4196},
                                                       {"grey_and_white_room", 143163},
                                                       {"lantern", 5394},
                                                       {"living_room_small", 5088},
                                                       {"metal_rough_spheres_no_textures", 1040409},
                                                       {"modern_living_room", 368098},
                                                       {"morph_primitives_test", 32},
                                                       {"negative_scale_test", 3884},
                                                       {"normal_tangent_mirror_test", 5240},
                                                       {"recursive_skeletons", 76},
                                                       {"simple_skin", 8},
                                                       {"stanford_bunny_69k", 69451},
                                                       {"stanford_dragon_871k", 871414},
                                                       {"suzanne", 3936},
                                                       {"torus_5k", 4608},
                                                       {"transmission_test", 128775},
                                                       {"unlit_test", 88},
                                                       {"utah_teapot_2464", 2464}};
  for (const auto& [name, triangles] : expected) {
    if (!requireData(name + ".glb")) continue;
    EXPECT_EQ(triangleCount(importGltf(dataFile(name + ".glb"))), triangles) << name;
  }
}

TEST(GltfImport, FoxIsFlatSkinnedAndAnimated) {
  BRICKFIELD_NEEDS_DATA("fox.glb");
  const Scene scene = importGltf(dataFile("fox.glb"));
  EXPECT_TRUE(scene.meshes[0].primitives[0].flatNormals);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions.size(), 3u * 576u);
  EXPECT_EQ(scene.meshes[0].primitives[0].influencesPerVertex, 4);
  EXPECT_EQ(scene.animations.size(), 3u);
  EXPECT_EQ(scene.skins.size(), 1u);
  EXPECT_EQ(scene.skins[0].joints.size(), scene.skins[0].jointFromBind.size());
}

TEST(GltfImport, InterpolationTestHasAllThree) {
  BRICKFIELD_NEEDS_DATA("interpolation_test.glb");
  const Scene scene = importGltf(dataFile("interpolation_test.glb"));
  std::map<Interpolation, int> counts;
  for (const Animation& animation : scene.animations)
    for (const AnimationChannel& channel : animation.channels) ++counts[channel.interpolation];
  EXPECT_EQ(counts[Interpolation::Step], 3);
  EXPECT_EQ(counts[Interpolation::Linear], 3);
  EXPECT_EQ(counts[Interpolation::CubicSpline], 3);
}

TEST(GltfImport, SimpleInstancingHasItsInstances) {
  BRICKFIELD_NEEDS_DATA("simple_instancing.glb");
  const Scene scene = importGltf(dataFile("simple_instancing.glb"));
  std::size_t instances = 0;
  for (const Node& node : scene.nodes) instances += node.nodeFromInstance.size();
  EXPECT_EQ(instances, 125u);
}

TEST(GltfImport, GivenTangentsAgreeWithOurOwn) {
  // The sample brings tangents made by MikkTSpace in another program: ours must agree.
  BRICKFIELD_NEEDS_DATA("normal_tangent_mirror_test.glb");
  const Scene scene = importGltf(dataFile("normal_tangent_mirror_test.glb"));
  const Primitive& primitive = scene.meshes[0].primitives[0];
  ASSERT_EQ(primitive.tangents.size(), primitive.positions.size());
  const auto corners = cornerTangents(primitive.indices, primitive.positions, primitive.normals, primitive.uvs[0]);
  std::size_t signs = 0, close = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec4 given = primitive.tangents[primitive.indices[i]];
    signs += given.w == corners[i].w;
    close += glm::dot(glm::vec3(given), glm::vec3(corners[i])) > std::cos(glm::radians(1.0f));
  }
  EXPECT_EQ(signs, corners.size());
  EXPECT_GT(close, corners.size() * 99 / 100);
  std::printf("%zu of %zu corners within a degree\n", close, corners.size());
}

TEST(GltfImport, MissingFilesAndFoldersAreBadInput) {
  EXPECT_THROW(importGltf("no/such/file.glb"), BadInput);
  EXPECT_THROW(importGltf(fs::temp_directory_path()), BadInput);
  EXPECT_THROW(importGltf("/dev/zero"), BadInput);
}

} // namespace

} // namespace brickfield::test
