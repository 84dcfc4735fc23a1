// Surface attributes in bricks: colours of a textured box, factors, vertex colours, alpha, emission.
#include <gtest/gtest.h>

#include "bakers/bake.h"
#include "field/brick_layout.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

BakeSettings settingsOf(int resolution) {
  BakeSettings settings;
  settings.resolution = resolution;
  return settings;
}

struct Nearest {
  glm::vec4 baseColor, material;
  glm::vec3 emission{0};
};

/// Attributes of the stored sample nearest to a point.
Nearest attributesAt(const BrickField& field, std::size_t levelIndex, glm::vec3 pointObject) {
  const BrickLevel& level = field.levels[levelIndex];
  const glm::ivec3 grid(glm::round((pointObject - field.originObject) / level.voxelSizeObject));
  const glm::ivec3 brick = glm::min(grid / kBrickCells, level.brickCounts - 1), sample = grid - kBrickCells * brick;
  const IndirectionCell cell{level.indirection[level.cellIndex(brick)]};
  EXPECT_FALSE(cell.isEmpty());
  const std::size_t i = std::size_t{cell.brickIndex()} * kBrickSampleCount + sampleIndex(sample);
  Nearest result{unpackRgba8(level.baseColor[i]), unpackRgba8(level.material[i])};
  if (!level.emission.empty()) result.emission = unpackRgb9e5(level.emission[i]);
  return result;
}

void expectColor(glm::vec4 actual, glm::vec4 expected, float tolerance = 1.5f / 255) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "channel " << i;
}

/// A box whose left half is red and whose right half is green, by a texture of 64 columns.
MeshCase twoColouredBox() {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  for (const glm::vec3 p : box.primitive().positions) box.primitive().uvs[0].push_back({0.5f + 0.5f * p.x, 0.5f});
  Image image;
  image.size = {64, 64};
  for (int i = 0; i < 64 * 64; ++i) {
    const bool left = i % 64 < 32;
    const std::uint8_t texel[4] = {static_cast<std::uint8_t>(left ? 200 : 0), static_cast<std::uint8_t>(left ? 0 : 100),
                                   0, 128};
    image.rgba.insert(image.rgba.end(), texel, texel + 4);
  }
  box.scene.images.push_back(image);
  box.scene.textures.emplace_back().image = 0;
  box.scene.textures[0].wrapU = Wrap::ClampToEdge;
  box.material().baseColorTexture.texture = 0;
  return box;
}

} // namespace

TEST(BakeAttributes, TexturedBoxHasItsColoursOnEveryLevel) {
  const MeshCase box = twoColouredBox();
  const BrickField field = bakeField(box.input(), settingsOf(64)).field;
  for (std::size_t level = 0; level < field.levels.size(); ++level) {
    for (const glm::vec2 yz : {glm::vec2(1, 0.3f), glm::vec2(-0.2f, 1), glm::vec2(0.4f, -1)}) {
      expectColor(attributesAt(field, level, {-0.5f, yz}).baseColor, {200 / 255.0f, 0, 0, 1});
      expectColor(attributesAt(field, level, {0.5f, yz}).baseColor, {0, 100 / 255.0f, 0, 1});
    }
    expectColor(attributesAt(field, level, {-1, 0.2f, 0.1f}).baseColor, {200 / 255.0f, 0, 0, 1});
  }
  EXPECT_TRUE(field.levels[0].emission.empty());
}

TEST(BakeAttributes, AlphaIsKeptWhereTheMaterialCuts) {
  MeshCase box = twoColouredBox();
  box.material().alphaMode = AlphaMode::Mask;
  const BrickField field = bakeField(box.input(), settingsOf(32)).field;
  EXPECT_NEAR(attributesAt(field, 0, {0.5f, 1, 0}).baseColor.w, 128 / 255.0f, 1.5f / 255);
}

TEST(BakeAttributes, CoverageOfOneHalfIsTheCutoff) {
  MeshCase box = twoColouredBox();
  box.material().alphaMode = AlphaMode::Mask;
  for (const float cutoff : {0.25f, 0.8f}) {
    box.material().alphaCutoff = cutoff;
    const BrickField field = bakeField(box.input(), settingsOf(32)).field;
    const float expected = std::min(1.0f, 0.5f * (128 / 255.0f) / cutoff);
    EXPECT_NEAR(attributesAt(field, 0, {0.5f, 1, 0}).baseColor.w, expected, 1.5f / 255) << cutoff;
  }
}

TEST(BakeAttributes, SingleSidedSheetCoversItsFrontAlone) {
  MeshCase quad;
  quad.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}); // faces up
  for (const bool doubleSided : {false, true}) {
    quad.material().doubleSided = doubleSided;
    const BrickField field = bakeField(quad.input(), settingsOf(64)).field;
    const float voxel = field.levels[0].voxelSizeObject;
    EXPECT_EQ(attributesAt(field, 0, {0.2f, voxel, 0.1f}).baseColor.w, 1.0f);
    EXPECT_GT(attributesAt(field, 0, {0.2f, 0, 0.1f}).baseColor.w, 0.95f);
    const float back = doubleSided ? 1.0f : 2.4f; // the single-sided slab lies behind its front, 1.755 voxels deep
    EXPECT_EQ(attributesAt(field, 0, {0.2f, -back * voxel, 0.1f}).baseColor.w, doubleSided ? 1.0f : 0.0f);
  }
}

TEST(BakeAttributes, TwoSingleSidedQuadsBackToBackCoverBothSides) {
  MeshCase quads;
  quads.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  quads.addQuad({-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1});
  const BrickField field = bakeField(quads.input(), settingsOf(64)).field;
  const float voxel = field.levels[0].voxelSizeObject;
  for (const float side : {-1.0f, 1.0f})
    EXPECT_EQ(attributesAt(field, 0, {0.2f, side * voxel, 0.1f}).baseColor.w, 1.0f) << side;
}

TEST(BakeAttributes, FactorsAndVertexColoursMultiply) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  box.material().baseColor = {0.5f, 0.5f, 0.5f, 1};
  box.material().metallic = 0.25f;
  box.material().roughness = 0.75f;
  box.material().unlit = true;
  for (const glm::vec3 p : box.primitive().positions)
    box.primitive().colors.push_back({0.5f + 0.5f * p.x, 1, 0, 1}); // a ramp along x
  const BrickField field = bakeField(box.input(), settingsOf(64)).field;
  for (const float x : {-0.5f, 0.0f, 0.5f}) {
    const Nearest at = attributesAt(field, 0, {x, 1, 0.2f});
    // The nearest sample is up to half a voxel of 1/32 away: a 128th of the ramp; sRGB stretches that at most threefold
    // here.
    EXPECT_NEAR(at.baseColor.x, srgbFromLinear(0.5f * (0.5f + 0.5f * x)), 0.025f);
    EXPECT_NEAR(at.baseColor.y, srgbFromLinear(0.5f), 1.5f / 255);
    expectColor(at.material, {0.25f, 0.75f, 1, 1});
  }
}

TEST(BakeAttributes, EmissionIsThereOnlyWhereSomethingEmits) {
  MeshCase scene; // two boxes of two materials
  scene.addBox({-1, -1, -1}, {-0.2f, 1, 1});
  Primitive lamp = scene.primitive();
  scene.scene.meshes[0].primitives.push_back(lamp);
  for (glm::vec3& p : scene.scene.meshes[0].primitives[1].positions) p.x += 1.2f;
  scene.scene.meshes[0].primitives[1].material = 1;
  scene.scene.materials.emplace_back().emission = {4, 2, 0.5f};
  const BrickField field = bakeField(scene.input(), settingsOf(64)).field;
  for (const BrickLevel& level : field.levels) EXPECT_EQ(level.emission.size(), level.baseColor.size());
  const glm::vec3 lit = attributesAt(field, 0, {0.6f, 1, 0}).emission,
                  dark = attributesAt(field, 0, {-0.6f, 1, 0}).emission;
  EXPECT_NEAR(glm::length(lit - glm::vec3(4, 2, 0.5f)), 0, 0.02f);
  EXPECT_EQ(dark, glm::vec3(0));
}

TEST(BakeAttributes, NoneWereAskedFor) {
  MeshCase box = twoColouredBox();
  BakeSettings settings = settingsOf(32);
  settings.attributes = false;
  const BrickField field = bakeField(box.input(), settings).field;
  for (const BrickLevel& level : field.levels) {
    EXPECT_TRUE(level.baseColor.empty());
    EXPECT_TRUE(level.material.empty());
  }
}

// Closest triangles are kept for colors and thicknesses alone: all else comes out the same without.
TEST(BakeAttributes, DistancesAreTheSameWithoutThem) {
  struct Case {
    const char* file;
    SignMethod sign = SignMethod::Auto;
    int resolution = 48;
  };
  for (const Case& bake :
       {Case{"stanford_dragon_11k.glb"}, Case{"utah_teapot_1k.glb"}, Case{"tree_leaf_cards.glb"},
        Case{"suzanne.glb", SignMethod::TwoSided}, Case{"stanford_bunny_69k.glb", SignMethod::Auto, 24}}) {
    BRICKFIELD_NEEDS_DATA(bake.file);
    const FileCase file(bake.file);
    BakeSettings settings = settingsOf(bake.resolution);
    settings.sign = bake.sign;
    const BrickField with = bakeField(file.input(), settings).field;
    settings.attributes = false;
    const BrickField without = bakeField(file.input(), settings).field;
    ASSERT_EQ(with.levels.size(), without.levels.size());
    for (std::size_t i = 0; i < with.levels.size(); ++i) {
      const BrickLevel &level = with.levels[i], &bare = without.levels[i];
      EXPECT_EQ(level.rangeVoxels, bare.rangeVoxels) << bake.file << ", level " << i;
      EXPECT_TRUE(level.distances == bare.distances) << bake.file << ", level " << i;
      EXPECT_TRUE(level.indirection == bare.indirection) << bake.file << ", level " << i;
    }
  }
}

// Bands on a beam, plates on a plinth: what lies under less than a voxel of something else is not seen.
TEST(BakeAttributes, ThinCoatHidesWhatItLiesOn) {
  MeshCase scene; // a red box, and a green plate that reaches 0.4 voxels out of its top
  scene.addBox(glm::vec3(-1), glm::vec3(1));
  scene.material().baseColor = {1, 0, 0, 1};
  const float voxel = 2.0f / 64;
  MeshCase plate;
  plate.addBox({-0.5f, 0.9f, -0.5f}, {0.5f, 1 + 0.4f * voxel, 0.5f});
  scene.scene.meshes[0].primitives.push_back(plate.primitive());
  scene.scene.meshes[0].primitives[1].material = 1;
  scene.scene.materials.emplace_back().baseColor = {0, 1, 0, 1};
  const BrickField field = bakeField(scene.input(), settingsOf(64)).field;
  for (const float below : {-1.0f, 0.0f, 1.0f}) { // all samples that a hit on the plate reads
    expectColor(attributesAt(field, 0, {0.1f, 1 - below * voxel, -0.2f}).baseColor, {0, 1, 0, 1});
    expectColor(attributesAt(field, 0, {0.8f, 1 - below * voxel, -0.2f}).baseColor, {1, 0, 0, 1});
  }
}
