// What goes into a .bricks file comes out of it, and the same field makes the same bytes.
#include "field/bricks_file.h"

#include <cstring>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"
#include "core/files.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;
namespace fs = std::filesystem;

enum class Attributes { None, NoEmission, All };

BrickField variedField(const Body& body, int bits, int mips, Attributes attributes) {
  BrickField field = fieldOf(body, 48, bits, mips);
  field.sourceHash = {0x0123456789abcdefull, 0xfedcba9876543210ull};
  if (attributes != Attributes::None)
    addAttributes(field, [&](glm::vec3 p) {
      SurfaceAttributes a;
      a.baseColor = glm::vec4(glm::fract(p * 3.0f), 1);
      a.roughness = glm::fract(p.x * 7);
      if (attributes == Attributes::All) a.emission = glm::max(p, glm::vec3(0)) * 10.0f;
      return a;
    });
  return field;
}

void expectSame(const BrickField& a, const BrickField& b) {
  EXPECT_EQ(a.boundsObject.min, b.boundsObject.min);
  EXPECT_EQ(a.boundsObject.max, b.boundsObject.max);
  EXPECT_EQ(a.originObject, b.originObject);
  EXPECT_EQ(a.sourceHash, b.sourceHash);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    const BrickLevel &x = a.levels[i], &y = b.levels[i];
    EXPECT_EQ(x.voxelSizeObject, y.voxelSizeObject);
    EXPECT_EQ(x.brickCounts, y.brickCounts);
    EXPECT_EQ(x.rangeVoxels, y.rangeVoxels);
    EXPECT_EQ(x.format, y.format);
    EXPECT_TRUE(x.indirection == y.indirection);
    EXPECT_TRUE(x.distances == y.distances);
    EXPECT_TRUE(x.baseColor == y.baseColor);
    EXPECT_TRUE(x.material == y.material);
    EXPECT_TRUE(x.emission == y.emission);
  }
}

TEST(BricksFile, RoundTripIsExactAndBytesRepeat) {
  for (const Body& body : bodies())
    for (const int bits : {8, 16})
      for (const int mips : {1, 2, 3})
        for (const Attributes attributes : {Attributes::None, Attributes::NoEmission, Attributes::All}) {
          const BrickField field = variedField(body, bits, mips, attributes);
          const std::vector<std::byte> bytes = encodeBricks(field);
          const BrickField back = decodeBricks(bytes, "memory");
          expectSame(field, back);
          EXPECT_TRUE(encodeBricks(back) == bytes);
          EXPECT_TRUE(encodeBricks(variedField(body, bits, mips, attributes)) == bytes);
        }
}

TEST(BricksFile, LevelWithoutBricksRoundTrips) {
  // Nothing near the surface on the fine level; the coarsest is whole all the same.
  const BrickField field = makeAnalyticField([](glm::vec3) { return 100.0f; }, {glm::vec3(0), glm::vec3(1)}, 40, 8, 2);
  ASSERT_EQ(field.levels[0].brickCount(), 0u);
  expectSame(field, decodeBricks(encodeBricks(field), "memory"));
}

TEST(BricksFile, IsSmallerThanItsField) {
  const BrickField field = variedField(torusBody(), 8, 3, Attributes::None);
  EXPECT_LT(encodeBricks(field).size(), fieldBytes(field) / 2);
}

TEST(BricksFile, HeaderIsAsDescribed) {
  const BrickField field = variedField(sphereBody(), 8, 2, Attributes::None);
  const std::vector<std::byte> bytes = encodeBricks(field);
  EXPECT_EQ(std::memcmp(bytes.data(), "BRICKFLD\x01\0\0\0\x02\0\0\0", 16), 0);
  std::uint64_t fileBytes;
  std::memcpy(&fileBytes, bytes.data() + 16, 8);
  EXPECT_EQ(fileBytes, bytes.size());
  float voxelSize; // of the first level in the file
  std::memcpy(&voxelSize, bytes.data() + 80, 4);
  EXPECT_EQ(voxelSize, field.levels[1].voxelSizeObject) << "the coarsest comes first";
  std::uint64_t offset; // of its first chunk, then that of the second level
  std::memcpy(&offset, bytes.data() + 80 + 32, 8);
  EXPECT_EQ(offset, 88u + 2 * 152);
  std::uint64_t fineOffset;
  std::memcpy(&fineOffset, bytes.data() + 80 + 152 + 32, 8);
  EXPECT_GT(fineOffset, offset);
}

class BricksFileOnDisk : public testing::Test {
protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bricks_file_test." + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(BricksFileOnDisk, RoundTripsAndReplaces) {
  const fs::path path = folder_ / "body.bricks";
  const BrickField first = variedField(sphereBody(), 8, 2, Attributes::All),
                   second = variedField(boxBody(), 16, 1, Attributes::None);
  writeBricksFile(path, first);
  expectSame(first, readBricksFile(path));
  EXPECT_TRUE(readFile(path) == encodeBricks(first));
  writeBricksFile(path, second);
  expectSame(second, readBricksFile(path));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "nothing is left beside it";
}

TEST_F(BricksFileOnDisk, ErrorsNameTheFile) {
  const fs::path path = folder_ / "odd.bricks";
  const auto messageOf = [&](const auto& act) -> std::string {
    try {
      act();
    } catch (const BadInput& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(messageOf([&] { readBricksFile(path); }).find("odd.bricks"), std::string::npos);
  std::ofstream(path) << "solid of another program";
  EXPECT_NE(messageOf([&] { readBricksFile(path); }).find("odd.bricks: header: not a .bricks file"), std::string::npos);
  std::ofstream(path, std::ios::trunc).flush();
  EXPECT_NE(messageOf([&] { readBricksFile(path); }).find("not a .bricks file"), std::string::npos);
  EXPECT_NE(messageOf([&] { readBricksFile(folder_); }).find(folder_.string()), std::string::npos);
  BrickField unsound = variedField(sphereBody(), 8, 2, Attributes::None);
  unsound.levels[0].distances.pop_back();
  EXPECT_NE(messageOf([&] { writeBricksFile(path, unsound); }).find("odd.bricks: level 0"), std::string::npos);
  EXPECT_NE(messageOf([&] { encodeBricks(unsound); }).find("level 0"), std::string::npos);
  EXPECT_NE(messageOf([&] {
              writeBricksFile(folder_ / "no" / "x.bricks", variedField(sphereBody(), 8, 1, Attributes::None));
            }).find("x.bricks"),
            std::string::npos);
}

} // namespace
} // namespace brickfield
