// Colours, orientation and refusals of a cut.
#include "field/slice.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

glm::ivec3 at(const SliceImage& image, int x, int y) {
  const auto i =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size.x) + static_cast<std::size_t>(x));
  return {image.rgb.at(i), image.rgb.at(i + 1), image.rgb.at(i + 2)};
}
bool isBlue(glm::ivec3 c) { return c.z > c.x + 40; }
bool isOrange(glm::ivec3 c) { return c.x > c.z + 40; }
bool isBlack(glm::ivec3 c) { return std::max({c.x, c.y, c.z}) < 30; }

TEST(CutField, ShowsASphereWhereItIs) {
  // Off the middle of its bounds: x 0 to 4, y 0 to 2, z 0 to 2; the sphere around (1, 1.5, 0.75).
  const glm::vec3 center(1, 1.5f, 0.75f);
  const float radius = 0.4f;
  const BrickField field = makeAnalyticField([&](glm::vec3 p) { return sphereDistance(p, center, radius); },
                                             {glm::vec3(0), glm::vec3(4, 2, 2)}, 100, 8, 2);
  for (int axis = 0; axis < 3; ++axis) {
    const SliceImage image = cutField(field, {axis, center[axis], false, 0, 800});
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    ASSERT_EQ(std::max(image.size.x, image.size.y), 800);
    ASSERT_EQ(image.rgb.size(), static_cast<std::size_t>(3 * image.size.x * image.size.y));
    const glm::vec3 extent = field.boundsObject.extent();
    const float pixel = std::max(extent[right], extent[up]) / 800;
    EXPECT_NEAR(static_cast<float>(image.size.x), extent[right] / pixel, 1.0f);
    EXPECT_NEAR(static_cast<float>(image.size.y), extent[up] / pixel, 1.0f);
    const auto colorAt = [&](float alongRight, float alongUp) {
      return at(image, static_cast<int>((center[right] + alongRight - field.boundsObject.min[right]) / pixel),
                static_cast<int>((field.boundsObject.max[up] - center[up] - alongUp) / pixel));
    };
    EXPECT_TRUE(isBlue(colorAt(radius - 0.06f, 0)));
    EXPECT_TRUE(isOrange(colorAt(radius + 0.06f, 0)));
    EXPECT_TRUE(isBlack(colorAt(radius, 0)));
    EXPECT_TRUE(isBlack(colorAt(-radius, 0)));
    EXPECT_TRUE(isBlack(colorAt(0, radius)));
    EXPECT_TRUE(isBlue(colorAt(0, -radius + 0.06f)));
    // A line a voxel outside is darker than what lies between the lines.
    const float h = field.levels[0].voxelSizeObject;
    int darkest = 255, brightest = 0;
    for (float d = 0.6f; d < 1.5f; d += 0.02f) {
      const int red = colorAt(radius + d * h, 0).x;
      darkest = std::min(darkest, red);
      brightest = std::max(brightest, red);
    }
    EXPECT_LT(darkest, brightest - 40);
  }
}

TEST(CutField, FractionAndMetresAgreeAndLevelsDiffer) {
  const BrickField field = fieldOf(torusBody(), 60, 8, 2);
  const SliceImage byFraction = cutField(field, {1, 0.5f, true, 0, 128});
  const SliceImage byMetres = cutField(field, {1, field.boundsObject.center().y, false, 0, 128});
  EXPECT_EQ(byFraction.rgb, byMetres.rgb);
  EXPECT_NE(cutField(field, {1, 0.5f, true, 1, 128}).rgb, byFraction.rgb);
  for (const float end : {0.0f, 1.0f}) EXPECT_EQ(cutField(field, {2, end, true, 0, 16}).size.x, 16);
  EXPECT_EQ(cutField(field, {0, 0.5f, true, 0, 1}).rgb.size(), 3u);
}

TEST(CutField, RefusesWhatIsNotThere) {
  const BrickField field = fieldOf(sphereBody(), 20, 8, 1);
  EXPECT_THROW(cutField(field, {3, 0.5f}), BadInput);
  EXPECT_THROW(cutField(field, {-1, 0.5f}), BadInput);
  EXPECT_THROW(cutField(field, {0, 1.01f}), BadInput);
  EXPECT_THROW(cutField(field, {0, std::nanf("")}), BadInput);
  EXPECT_THROW(cutField(field, {0, 5.0f, false}), BadInput);
  EXPECT_THROW(cutField(field, {0, 0.5f, true, 1}), BadInput);
  EXPECT_THROW(cutField(field, {0, 0.5f, true, 0, 0}), BadInput);
  EXPECT_THROW(cutField(field, {0, 0.5f, true, 0, 100000}), BadInput);
}

} // namespace
} // namespace brickfield
