// Attributes that change evenly through space come back from between the samples.
#include "field/surface_attributes.h"

#include <gtest/gtest.h>

#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

SurfaceAttributes evenAttributes(glm::vec3 p) {
  const glm::vec3 unit = glm::clamp((p - kCenter) / 3.0f + 0.5f, 0.0f, 1.0f);
  SurfaceAttributes a;
  a.baseColor = glm::vec4(unit, 1.0f - unit.x);
  a.metallic = unit.y, a.roughness = unit.z, a.occlusion = unit.x;
  a.unlit = p.x > kCenter.x;
  a.emission = 2.0f * unit;
  return a;
}

TEST(SurfaceAttributesAt, GiveWhatTheSamplesAroundSay) {
  const Body body = sphereBody();
  BrickField field = fieldOf(body, 48, 8, 2);
  addAttributes(field, evenAttributes);
  Random random(3);
  for (std::size_t level = 0; level < field.levels.size(); ++level)
    for (int i = 0; i < 500; ++i) {
      const glm::vec3 point = kCenter + kRadius * random.direction();
      const std::optional<SurfaceAttributes> found = attributesAt(field, level, point);
      ASSERT_TRUE(found);
      const SurfaceAttributes expected = evenAttributes(point);
      // Linear in space, so that interpolation is exact; the codes are 8 bits, where the sRGB curve is steep up to
      // 2.4 / 2 of a step of them, and the emission has 9.
      constexpr float kCode = 0.0055f;
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(found->baseColor[k], expected.baseColor[k], kCode);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(found->emission[k], expected.emission[k], 0.005f);
      ASSERT_NEAR(found->metallic, expected.metallic, kCode);
      ASSERT_NEAR(found->roughness, expected.roughness, kCode);
      ASSERT_NEAR(found->occlusion, expected.occlusion, kCode);
      if (std::abs(point.x - kCenter.x) > 2 * field.levels[level].voxelSizeObject) {
        ASSERT_EQ(found->unlit, expected.unlit);
      }
    }
}

TEST(SurfaceAttributesAt, AreNothingWhereThereAreNone) {
  BrickField field = fieldOf(sphereBody(), 100, 8, 1);
  const glm::vec3 onSurface = kCenter + glm::vec3(kRadius, 0, 0);
  EXPECT_FALSE(attributesAt(field, 0, onSurface));
  field = fieldOf(sphereBody(), 100, 8, 2);
  addAttributes(field, evenAttributes);
  EXPECT_TRUE(attributesAt(field, 0, onSurface));
  EXPECT_FALSE(attributesAt(field, 0, kCenter)) << "no brick of the finest level lies in the middle";
}

} // namespace
} // namespace brickfield
