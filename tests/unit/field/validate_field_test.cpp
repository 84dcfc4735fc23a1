// Every way in which a field can be unsound is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;
using testing::HasSubstr;

BrickField soundField() {
  BrickField field = fieldOf(sphereBody(), 90, 8, 2);
  addAttributes(field, [](glm::vec3) {
    SurfaceAttributes a;
    a.emission = {1, 0, 0};
    return a;
  });
  return field;
}

TEST(ValidateField, AcceptsSoundFields) {
  EXPECT_EQ(validateField(soundField()), "");
  for (const Body& body : bodies())
    for (const int resolution : {8, 9, 13, 50})
      for (const int mips : {1, 2, 4}) EXPECT_EQ(validateField(fieldOf(body, resolution, 16, mips)), "");
}

TEST(ValidateField, NamesWhatIsWrong) {
  struct Case {
    const char* expected;
    std::function<void(BrickField&)> damage;
  };
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  const Case cases[] = {
      {"0 levels", [](BrickField& f) { f.levels.clear(); }},
      {"9 levels", [](BrickField& f) { f.levels.resize(9, f.levels[0]); }},
      {"bounds", [&](BrickField& f) { f.boundsObject.min.y = nan; }},
      {"bounds", [&](BrickField& f) { f.boundsObject.max.x = infinity; }},
      {"bounds", [](BrickField& f) { f.boundsObject = {}; }},
      {"bounds", [](BrickField& f) { std::swap(f.boundsObject.min.x, f.boundsObject.max.x); }},
      {"origin", [&](BrickField& f) { f.originObject.z = nan; }},
      {"along x", [](BrickField& f) { f.originObject.x += 0.5f; }},
      {"along y", [](BrickField& f) { f.boundsObject.max.y += 1; }},
      {"level 0: voxel size", [&](BrickField& f) { f.levels[0].voxelSizeObject = nan; }},
      {"level 0: voxel size", [](BrickField& f) { f.levels[0].voxelSizeObject = 0; }},
      {"level 0: voxel size", [](BrickField& f) { f.levels[0].voxelSizeObject *= -1; }},
      {"level 0: voxel size", [](BrickField& f) { f.levels[0].voxelSizeObject = 1e-40f; }},
      {"level 1: voxel size", [](BrickField& f) { f.levels[1].voxelSizeObject *= 1.5f; }},
      {"level 0: range", [&](BrickField& f) { f.levels[0].rangeVoxels = nan; }},
      {"level 0: range", [](BrickField& f) { f.levels[0].rangeVoxels = 0; }},
      {"level 1: range", [](BrickField& f) { f.levels[1].rangeVoxels = 1e9f; }},
      {"level 1: distance format 2", [](BrickField& f) { f.levels[1].format = static_cast<DistanceFormat>(2); }},
      {"level 0: 0x", [](BrickField& f) { f.levels[0].brickCounts.x = 0; }},
      {"x-1 bricks", [](BrickField& f) { f.levels[0].brickCounts.z = -1; }},
      {"x1025x", [](BrickField& f) { f.levels[0].brickCounts.y = 1025; }},
      {"more than 16777216", [](BrickField& f) { f.levels[0].brickCounts = glm::ivec3(1024); }},
      {"indirection cells", [](BrickField& f) { f.levels[0].indirection.pop_back(); }},
      {"indirection cells", [](BrickField& f) { f.levels[0].brickCounts.x += 1; }},
      {"whole number of bricks", [](BrickField& f) { f.levels[0].distances.pop_back(); }},
      {"for 196 indirection cells", // more bricks than cells, after the cells of a smaller grid
       [](BrickField& f) {
         BrickLevel& level = f.levels[1];
         level.brickCounts.z = 4;
         level.indirection.resize(196);
         f.boundsObject.max.z = f.boundsObject.min.z + 0.1f;
       }},
      {"base colours", [](BrickField& f) { f.levels[0].baseColor.pop_back(); }},
      {"materials", [](BrickField& f) { f.levels[0].material.clear(); }},
      {"base colours", [](BrickField& f) { f.levels[0].baseColor.clear(); }},
      {"emissions", [](BrickField& f) { f.levels[0].emission.pop_back(); }},
      {"without base colour", [](BrickField& f) { f.levels[1].baseColor = {}, f.levels[1].material = {}; }},
      {"names brick", [](BrickField& f) { f.levels[0].indirection[3] = f.levels[0].brickCount(); }},
      {"names brick", [](BrickField& f) { f.levels[1].indirection.back() = 0x7fffffffu; }},
      {"unknown bits", [](BrickField& f) { f.levels[0].indirection[0] = 0x80010000u; }},
      {"must have every brick", [](BrickField& f) { f.levels[1].indirection[5] = 0x80000010u; }},
  };
  const BrickField sound = soundField();
  ASSERT_EQ(sound.levels[1].brickCounts, glm::ivec3(7)) << "the cases count on it";
  for (const Case& c : cases) {
    BrickField field = sound;
    c.damage(field);
    const std::string wrong = validateField(field);
    EXPECT_THAT(wrong, HasSubstr(c.expected));
    EXPECT_EQ(wrong.find('\n'), std::string::npos);
  }
}

} // namespace
} // namespace brickfield
