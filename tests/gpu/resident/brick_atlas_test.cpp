// The atlas as shaders see it: everything is read back through the bindings that bind() makes.
#include "resident/brick_atlas.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "shared/bindings.h"
#include "tests/support/gl_fixture.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield::test {
namespace {

// What is bound to a texture unit or a storage binding, on the CPU.
struct Volume {
  glm::ivec3 size{0};
  std::vector<std::uint8_t> bytes;
  std::size_t texelBytes = 0;
};
Volume readVolume(std::uint32_t unit, GLenum format, GLenum type, std::size_t texelBytes) {
  GLint texture = 0;
  glActiveTexture(GL_TEXTURE0 + unit);
  glGetIntegerv(GL_TEXTURE_BINDING_3D, &texture);
  Volume volume;
  volume.texelBytes = texelBytes;
  glGetTextureLevelParameteriv(static_cast<GLuint>(texture), 0, GL_TEXTURE_WIDTH, &volume.size.x);
  glGetTextureLevelParameteriv(static_cast<GLuint>(texture), 0, GL_TEXTURE_HEIGHT, &volume.size.y);
  glGetTextureLevelParameteriv(static_cast<GLuint>(texture), 0, GL_TEXTURE_DEPTH, &volume.size.z);
  volume.bytes.resize(static_cast<std::size_t>(volume.size.x) * static_cast<std::size_t>(volume.size.y) *
                      static_cast<std::size_t>(volume.size.z) * texelBytes);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(static_cast<GLuint>(texture), 0, format, type, static_cast<GLsizei>(volume.bytes.size()),
                    volume.bytes.data());
  return volume;
}
template <typename Element>
std::vector<Element> readStorage(std::uint32_t binding) {
  GLint buffer = 0, bytes = 0;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, binding, &buffer);
  glGetNamedBufferParameteriv(static_cast<GLuint>(buffer), GL_BUFFER_SIZE, &bytes);
  std::vector<Element> elements(static_cast<std::size_t>(bytes) / sizeof(Element));
  glGetNamedBufferSubData(static_cast<GLuint>(buffer), 0, static_cast<GLsizeiptr>(elements.size() * sizeof(Element)),
                          elements.data());
  return elements;
}

// The bytes of a slot, as texelOfSlot of lib/bricks.glsl finds it, in the order of a BrickLevel.
std::vector<std::uint8_t> slotBytes(const Volume& volume, std::uint32_t slot) {
  const glm::uvec3 bricks = glm::uvec3(volume.size) / 8u;
  const glm::uvec3 corner = 8u * glm::uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y));
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t z = 0; z < 8; ++z)
    for (std::uint32_t y = 0; y < 8; ++y) {
      const std::size_t texel =
          (static_cast<std::size_t>(corner.z + z) * static_cast<std::size_t>(volume.size.y) + corner.y + y) *
              static_cast<std::size_t>(volume.size.x) +
          corner.x;
      const auto row = volume.bytes.begin() + static_cast<std::ptrdiff_t>(texel * volume.texelBytes);
      bytes.insert(bytes.end(), row, row + static_cast<std::ptrdiff_t>(8 * volume.texelBytes));
    }
  return bytes;
}

template <typename Element>
std::vector<std::uint8_t> brickBytes(const std::vector<Element>& bricks, std::uint32_t brick, std::size_t texelBytes) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(bricks.data());
  const std::size_t brickBytes = texelBytes * kBrickSampleCount;
  return {bytes + brick * brickBytes, bytes + (brick + 1) * brickBytes};
}

class BrickAtlasTest : public GlTest {
protected:
  // Everything that a shader would find of a field.
  void expectHeld(const BrickAtlas& atlas, BrickAtlas::FieldId id, const BrickField& field) {
    atlas.bind();
    const Volume r8 = readVolume(shared::kDistanceR8Unit, GL_RED, GL_BYTE, 1);
    const Volume r16 = readVolume(shared::kDistanceR16Unit, GL_RED, GL_SHORT, 2);
    const Volume color = readVolume(shared::kBrickBaseColorUnit, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    const Volume material = readVolume(shared::kBrickMaterialUnit, GL_RGBA, GL_UNSIGNED_BYTE, 4);
    const Volume emission = readVolume(shared::kBrickEmissionUnit, GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV, 4);
    const auto rows = readStorage<shared::SdfLevel>(shared::kSdfLevelBinding);
    const auto cells = readStorage<std::uint32_t>(shared::kIndirectionBinding);
    const ResidentField& held = atlas.field(id);
    ASSERT_EQ(held.levelCount, field.levels.size());
    EXPECT_EQ(held.voxelSizeObject, field.levels[0].voxelSizeObject);
    EXPECT_EQ(held.originObject, field.originObject);
    for (std::size_t l = 0; l < field.levels.size(); ++l) {
      const BrickLevel& level = field.levels[l];
      const shared::SdfLevel& row = rows[held.firstLevel + l];
      const bool is16 = level.format == DistanceFormat::R16Snorm;
      EXPECT_EQ(glm::ivec3(row.cells.y, row.cells.z, row.cells.w), level.brickCounts);
      EXPECT_EQ(row.scale.x, 1.0f / static_cast<float>(1 << l));
      EXPECT_EQ(row.scale.y, level.rangeVoxels);
      EXPECT_EQ(row.scale.z, is16 ? 1.0f : 0.0f);
      EXPECT_EQ(row.scale.w, 1.0f / static_cast<float>((is16 ? r16 : r8).size.z));
      ASSERT_EQ(row.attributes.x != shared::SDF_NO_ATTRIBUTES, !level.baseColor.empty());
      for (std::size_t c = 0; c < level.indirection.size(); ++c) {
        const IndirectionCell cell{level.indirection[c]};
        const std::uint32_t bits = cells[row.cells.x + c];
        if (cell.isEmpty()) {
          ASSERT_EQ(bits, cell.bits);
          if (!level.baseColor.empty()) {
            ASSERT_TRUE(IndirectionCell{cells[row.attributes.x + c]}.isEmpty());
          }
          continue;
        }
        const std::uint32_t brick = cell.brickIndex();
        ASSERT_EQ(slotBytes(is16 ? r16 : r8, bits), brickBytes(level.distances, brick, is16 ? 2 : 1))
            << "level " << l << " cell " << c;
        if (level.baseColor.empty()) continue;
        const std::uint32_t slot = cells[row.attributes.x + c];
        ASSERT_EQ(slotBytes(color, slot), brickBytes(level.baseColor, brick, 4)) << "level " << l << " cell " << c;
        ASSERT_EQ(slotBytes(material, slot), brickBytes(level.material, brick, 4)) << "level " << l << " cell " << c;
        if (level.emission.empty())
          ASSERT_EQ(slotBytes(emission, slot), std::vector<std::uint8_t>(4 * kBrickSampleCount, 0));
        else
          ASSERT_EQ(slotBytes(emission, slot), brickBytes(level.emission, brick, 4)) << "level " << l << " cell " << c;
      }
    }
  }
};

BrickField colored(BrickField field, float emission) {
  addAttributes(field, [&](glm::vec3 p) {
    SurfaceAttributes attributes;
    attributes.baseColor = glm::vec4(glm::fract(p * 3.0f), 1);
    attributes.metallic = glm::fract(p.x * 5);
    attributes.roughness = glm::fract(p.y * 5);
    attributes.emission = emission * glm::fract(p * 2.0f);
    return attributes;
  });
  return field;
}

TEST_F(BrickAtlasTest, FieldsOfAllKindsLieSideBySide) {
  BrickAtlas atlas;
  const BrickField sphere = fieldOf(sphereBody(), 48, 8, 3), torus = colored(fieldOf(torusBody(), 40, 16, 2), 0),
                   box = colored(fieldOf(boxBody(), 40, 8, 2), 7), plain = fieldOf(boxBody(), 24, 16, 1);
  const auto a = atlas.add(sphere), b = atlas.add(torus), c = atlas.add(box), d = atlas.add(plain);
  expectHeld(atlas, a, sphere);
  expectHeld(atlas, b, torus);
  expectHeld(atlas, c, box);
  expectHeld(atlas, d, plain);
  std::uint32_t bricks = 0;
  for (const BrickField* field : {&sphere, &torus, &box, &plain})
    for (const BrickLevel& level : field->levels) bricks += level.brickCount();
  EXPECT_EQ(atlas.brickCount(), bricks);
}

TEST_F(BrickAtlasTest, WhatWasRemovedIsGivenToTheNext) {
  BrickAtlas atlas;
  const BrickField sphere = colored(fieldOf(sphereBody(), 48, 8, 3), 2), torus = fieldOf(torusBody(), 40, 8, 2);
  const auto first = atlas.add(sphere);
  const auto kept = atlas.add(torus);
  const ResidentField before = atlas.field(first);
  const std::uint32_t bricks = atlas.brickCount();
  const std::size_t bytes = atlas.bytes();
  for (int round = 0; round < 5; ++round) {
    atlas.remove(round ? kept + static_cast<std::uint32_t>(round) : first);
    const auto again = atlas.add(sphere);
    EXPECT_EQ(again, kept + static_cast<std::uint32_t>(round) + 1);
    EXPECT_EQ(atlas.field(again).firstLevel, before.firstLevel);
    EXPECT_EQ(atlas.brickCount(), bricks);
    EXPECT_EQ(atlas.bytes(), bytes) << "the pools grew though there was room";
    expectHeld(atlas, again, sphere);
  }
  expectHeld(atlas, kept, torus);
}

TEST_F(BrickAtlasTest, RemovedFieldIsUnknown) {
  BrickAtlas atlas;
  const auto id = atlas.add(fieldOf(sphereBody(), 16, 8, 1));
  atlas.remove(id);
  EXPECT_EQ(atlas.brickCount(), 0u);
  EXPECT_THROW(atlas.remove(id), Failure);
  EXPECT_THROW(atlas.field(id), Failure);
}

// Who keeps something by ids outlives scenes and their atlases.
TEST_F(BrickAtlasTest, IdsAreThoseOfNoOtherAtlas) {
  const BrickField field = fieldOf(sphereBody(), 16, 8, 1);
  BrickAtlas one, other;
  EXPECT_NE(one.add(field), other.add(field));
}

// A layer of the pool holds 4096 bricks: a second one makes new textures, and the tables grow with them.
TEST_F(BrickAtlasTest, GrowthKeepsWhatIsThere) {
  BrickAtlas atlas;
  const BrickField early = colored(fieldOf(torusBody(), 40, 8, 2), 3), large = fieldOf(sphereBody(), 128, 8, 3);
  const auto id = atlas.add(early);
  const std::size_t bytes = atlas.bytes();
  std::vector<BrickAtlas::FieldId> others;
  while (atlas.brickCount() < 5000) others.push_back(atlas.add(large));
  while (others.size() < 30) others.push_back(atlas.add(fieldOf(boxBody(), 16, 16, 3)));
  EXPECT_GT(atlas.bytes(), bytes);
  expectHeld(atlas, id, early);
  expectHeld(atlas, others[0], large);
  for (const auto other : others) atlas.remove(other);
  expectHeld(atlas, id, early);
}

TEST_F(BrickAtlasTest, UnsoundFieldIsRefused) {
  BrickAtlas atlas;
  BrickField field = fieldOf(sphereBody(), 16, 8, 1);
  field.levels[0].indirection.pop_back();
  EXPECT_THROW(atlas.add(field), Failure);
}

} // namespace
} // namespace brickfield::test
