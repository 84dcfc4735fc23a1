// Alpha-masked sheets are cut to the shape of their mask.
#include "bakers/mask_cut.h"

#include <set>

#include <gtest/gtest.h>

#include "core/error.h"
#include "field/brick_layout.h"
#include "field/card_crossing.h"
#include "field/surface_attributes.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr float kDiskRadius = 0.7f;

/// A card over [-1,1]^2 at y = 0 whose mask keeps a red disk; what is cut away is blue.
MeshCase diskCard(float cutoff = 0.5f) {
  MeshCase card;
  card.addQuad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
  for (const glm::vec3 p : card.primitive().positions)
    card.primitive().uvs[0].push_back({0.5f + 0.5f * p.x, 0.5f + 0.5f * p.z});
  Image image;
  image.size = {256, 256};
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const glm::vec2 at = (glm::vec2(x, y) + 0.5f) / 128.0f - 1.0f;
      const bool isKept = glm::length(at) < kDiskRadius;
      const std::uint8_t texel[4] = {static_cast<std::uint8_t>(isKept ? 255 : 0), 0,
                                     static_cast<std::uint8_t>(isKept ? 0 : 255),
                                     static_cast<std::uint8_t>(isKept ? 200 : 0)};
      image.rgba.insert(image.rgba.end(), texel, texel + 4);
    }
  card.scene.images.push_back(image);
  card.scene.textures.emplace_back().image = 0;
  card.scene.textures[0].wrapU = card.scene.textures[0].wrapV = Wrap::ClampToEdge;
  card.material().baseColorTexture.texture = 0;
  card.material().alphaMode = AlphaMode::Mask;
  card.material().alphaCutoff = cutoff;
  card.material().doubleSided = true;
  return card;
}

BakeSettings settingsOf(int resolution) {
  BakeSettings settings;
  settings.resolution = resolution;
  return settings;
}

} // namespace

TEST(MaskCut, PiecesCoverWhatTheMaskKeeps) {
  const MeshCase card = diskCard();
  TriangleSoup soup = card.soup();
  const std::vector<std::uint32_t> pieces = cutMaskedSheets(card.input(), soup, {0, 1}, 2.0 / 64 * soup.unitsPerMetre);
  double area = 0;
  for (const std::uint32_t piece : pieces) {
    EXPECT_GE(piece, soup.firstPiece());
    const auto [a, b, c] = soup.corners(piece);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
    const double farthest = std::max({glm::length(a), glm::length(b), glm::length(c)}) / soup.unitsPerMetre;
    EXPECT_LT(farthest, static_cast<double>(kDiskRadius) + 1.0 / 64); // half a voxel
  }
  // Within the border by what three quarters of the disk around them ask for (0.24 voxels); pieces of the rim, half a
  // voxel in size, are in or out by their centroids: the errors cancel out but for a few.
  const double radius = static_cast<double>(kDiskRadius) - 0.24 * 2.0 / 64, disk = std::numbers::pi * radius * radius;
  EXPECT_NEAR(area / (soup.unitsPerMetre * soup.unitsPerMetre), disk, 0.01 * disk);
  EXPECT_LT(pieces.size(), 3000u); // the inside is made of large ones
}

TEST(MaskCut, FieldHasTheShapeAndColourOfTheDisk) {
  const BrickField field = bakeField(diskCard().input(), settingsOf(96)).field;
  const BrickLevel& level = field.levels[0];
  const float voxel = level.voxelSizeObject;
  for (int i = 0; i < 60; ++i) {
    const float angle = 0.105f * static_cast<float>(i), half = 0.5625f * voxel;
    const auto distanceAt = [&](float radius) {
      return sampleDistance(field, 0, {radius * std::cos(angle), 0, radius * std::sin(angle)});
    };
    EXPECT_LT(distanceAt(kDiskRadius - 2 * voxel), 0);
    EXPECT_GT(distanceAt(kDiskRadius + half + voxel), 0);
  }
  std::size_t isBlue = 0;
  for (const std::uint32_t texel : level.baseColor) isBlue += unpackRgba8(texel).z > unpackRgba8(texel).x;
  EXPECT_EQ(isBlue, 0u);
}

TEST(MaskCut, CoverageCutsWhatSlabsAddBeyondTheMask) {
  constexpr float kTexel = 1.0f / 128; // alpha falls off over one at the border, and the cutoff says where in it
  for (const auto& [resolution, cutoff] : {std::pair(48, 0.5f), std::pair(96, 0.5f), std::pair(96, 0.78f)}) {
    const BrickField field = bakeField(diskCard(cutoff).input(), settingsOf(resolution)).field;
    const float voxel = field.levels[0].voxelSizeObject;
    for (int i = 0; i < 60; ++i) {
      const float angle = 0.105f * static_cast<float>(i);
      const auto coverageAt = [&](float radius) {
        return attributesAt(field, 0, {radius * std::cos(angle), 0, radius * std::sin(angle)}).value().baseColor.w;
      };
      EXPECT_GT(coverageAt(kDiskRadius - 0.2f * voxel - kTexel), 0.5f) << resolution << " " << i;
      EXPECT_LT(coverageAt(kDiskRadius + 0.2f * voxel), 0.5f) << resolution << " " << i;
      EXPECT_GT(coverageAt(kDiskRadius - 2 * voxel), 0.999f);
    }
  }
}

TEST(MaskCut, CardsAreAsThinAsTheirMiddleAllowsAndNeverLost) {
  for (int tilt = 0; tilt < 12; ++tilt) {
    MeshCase card = diskCard();
    const float angle = 0.07f * static_cast<float>(tilt), height = 0.013f * static_cast<float>(tilt);
    const glm::vec3 normal(-std::sin(angle), std::cos(angle), 0);
    for (glm::vec3& p : card.primitive().positions)
      p = glm::vec3(std::cos(angle) * p.x, std::sin(angle) * p.x + height, p.z);
    const BrickField field = bakeField(card.input(), settingsOf(48)).field;
    const float voxel = field.levels[0].voxelSizeObject;
    double thickness = 0;
    for (int i = 0; i < 100; ++i) {
      const float x = 0.4f * std::cos(0.37f * static_cast<float>(i)),
                  z = 0.4f * std::sin(0.53f * static_cast<float>(i));
      const glm::vec3 on(std::cos(angle) * x, std::sin(angle) * x + height, z);
      EXPECT_LT(sampleDistance(field, 0, on), 0) << tilt << " " << i;
      thickness +=
          0.01 * static_cast<double>((sampleDistance(field, 0, on + 2.0f * voxel * normal) - 2.0f * voxel) / -voxel);
    }
    EXPECT_NEAR(thickness, 0.525, 0.02) << tilt; // half of it; steps of the code are 0.031
  }
}

TEST(MaskCut, CardsAsThinAsCanBeTellWhichWayTheyFace) {
  const auto bytesOf = [](const MeshCase& card, float thickness) {
    BakeSettings settings = settingsOf(48);
    settings.thickness = thickness;
    const BrickField field = bakeField(card.input(), settings).field;
    std::set<std::uint32_t> bytes;
    for (const BrickLevel& level : field.levels)
      for (const std::uint32_t material : level.material) bytes.insert(material >> 24);
    return bytes;
  };
  MeshCase card = diskCard();
  const glm::vec3 normal = glm::normalize(glm::vec3(-0.3f, 1, 0));
  for (glm::vec3& p : card.primitive().positions) p.y = 0.3f * p.x;
  using Bytes = std::set<std::uint32_t>;
  EXPECT_EQ(bytesOf(card, 0), Bytes{cardByte(nearestCardAxis(normal), false)});
  card.material().unlit = true;
  EXPECT_EQ(bytesOf(card, 0), Bytes{cardByte(nearestCardAxis(normal), true)});
  EXPECT_EQ(bytesOf(card, 0.2f), Bytes{255}) << "as thick as asked for";
  card.material().doubleSided = false;
  EXPECT_EQ(bytesOf(card, 0), Bytes{255}) << "coverage tells its sides apart, and nothing of its middle";
  card.material().doubleSided = true, card.material().unlit = false;
  card.material().alphaMode = AlphaMode::Opaque;
  EXPECT_EQ(bytesOf(card, 0), Bytes{0});
}

TEST(MaskCut, CutoffDecides) {
  EXPECT_GT(bakeField(diskCard(0.78f).input(), settingsOf(32)).stats.bricks, 0u);
  try {
    bakeField(diskCard(0.8f).input("card"), settingsOf(32)); // 200 / 255 is 0.784
    FAIL() << "baked nothing";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("card"), std::string::npos) << error.what();
  }
}

TEST(MaskCut, OpaqueCardsStayWhole) {
  MeshCase card = diskCard();
  card.material().alphaMode = AlphaMode::Opaque;
  const BakeResult result = bakeField(card.input(), settingsOf(64));
  EXPECT_LT(sampleDistance(result.field, 0, {0.95f, 0, 0.95f}), 0);
  EXPECT_EQ(result.stats.triangles, 2u);
  EXPECT_EQ(result.stats.sheetTriangles, 2u);
}

TEST(MaskCut, BlendedCardsAreCutAtOneHalfUnlessNothingWouldBeLeft) {
  MeshCase card = diskCard();
  card.material().alphaMode = AlphaMode::Blend;
  EXPECT_GT(sampleDistance(bakeField(card.input(), settingsOf(64)).field, 0, {0.95f, 0, 0.95f}), 0);
  card.material().baseColor.w = 0.3f; // glass: the disk's alpha is 0.24 now
  const BrickField glass = bakeField(card.input(), settingsOf(64)).field;
  EXPECT_LT(sampleDistance(glass, 0, {0.95f, 0, 0.95f}), 0);
  EXPECT_GT(attributesAt(glass, 0, {0.95f, 0, 0.95f}).value().baseColor.w, 0.999f);
}
