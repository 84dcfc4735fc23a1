// Shared mathematics against closed forms and brute force.
#include "core/math.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace brickfield::test {
namespace {

class Random {
public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float between(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_() >> 8) / static_cast<float>(1u << 24);
  }
  glm::vec3 vector(float reach) { return {between(-reach, reach), between(-reach, reach), between(-reach, reach)}; }
  glm::vec3 direction() {
    const float z = between(-1, 1), angle = between(0, 6.2831853f), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  glm::mat4 rotation() { return glm::rotate(glm::mat4(1), between(0, 6.2831853f), direction()); }
  glm::mat4 affine() {
    glm::mat4 m(1);
    for (int column = 0; column < 4; ++column) m[column] = glm::vec4(vector(2), column == 3 ? 1.0f : 0.0f);
    return m;
  }

private:
  std::mt19937 engine_;
};

TEST(Box, DefaultIsEmptyAndTheIdentityOfExtend) {
  Box box;
  EXPECT_TRUE(box.isEmpty());
  EXPECT_EQ(box.extent(), glm::vec3(0));
  box.extend(Box{});
  EXPECT_TRUE(box.isEmpty());
  box.extend(glm::vec3(1, 2, 3));
  EXPECT_FALSE(box.isEmpty());
  EXPECT_EQ(box.min, glm::vec3(1, 2, 3));
  EXPECT_EQ(box.max, glm::vec3(1, 2, 3));
  EXPECT_TRUE((Box{{0, 0, 0}, {1, -1, 1}}).isEmpty());
  EXPECT_TRUE((Box{{0, 0, 0}, {1, std::nanf(""), 1}}).isEmpty());
}

TEST(TransformBox, IsTheBoxOfTheEightCorners) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    const glm::mat4 m = random.affine();
    Box box;
    box.extend(random.vector(5));
    box.extend(random.vector(5));
    Box expected;
    for (int corner = 0; corner < 8; ++corner)
      expected.extend(transformPoint(m, {corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                         corner & 4 ? box.max.z : box.min.z}));
    const Box actual = transformBox(m, box);
    // Three products of at most 2 * 5 and a translation, each rounded: some 1e-7 of 32.
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(actual.min[axis], expected.min[axis], 1e-5f);
      EXPECT_NEAR(actual.max[axis], expected.max[axis], 1e-5f);
    }
  }
}

TEST(TransformBox, EmptyStaysEmpty) {
  EXPECT_TRUE(transformBox(glm::scale(glm::mat4(1), glm::vec3(-2)), Box{}).isEmpty());
}

TEST(NormalMatrix, KeepsNormalsAcrossTheirPlanes) {
  Random random(2);
  for (int round = 0; round < 200; ++round) {
    const glm::mat4 m = random.affine();
    const glm::vec3 a = random.direction(), b = random.direction();
    const glm::vec3 normal = glm::cross(a, b);
    const glm::vec3 carried = normalMatrix(m) * normal;
    const glm::vec3 expected = glm::cross(transformDirection(m, a), transformDirection(m, b));
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(carried[axis], expected[axis], 2e-5f);
  }
}

TEST(NormalMatrix, ExistsWhereTheInverseDoesNot) {
  // Flattened onto y = 0: what is left of a surface faces up or down.
  const glm::mat3 m = normalMatrix(glm::scale(glm::mat4(1), {2, 0, 3}));
  EXPECT_EQ(m * glm::vec3(1, 1, 1), glm::vec3(0, 6, 0));
}

TEST(MirrorSign, FollowsTheDeterminant) {
  EXPECT_EQ(mirrorSign(glm::mat4(1)), 1.0f);
  EXPECT_EQ(mirrorSign(glm::scale(glm::mat4(1), {-1, 2, 3})), -1.0f);
  EXPECT_EQ(mirrorSign(glm::scale(glm::mat4(1), {-1, -2, 3})), 1.0f);
  EXPECT_EQ(mirrorSign(glm::scale(glm::mat4(1), {-1, -2, -3})), -1.0f);
}

TEST(NormalMatrix, PointsOutwardsOnceTheMirrorSignIsApplied) {
  const glm::mat4 mirror = glm::scale(glm::mat4(1), {-2, 1, 1});
  const glm::vec3 outwards = normalMatrix(mirror) * glm::vec3(1, 0, 0) * mirrorSign(mirror);
  EXPECT_LT(outwards.x, 0.0f); // the face at +x lies at -x now, and so does its outside
}

TEST(ScaleRange, RotatedStretchesGiveTheirFactorsBack) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    const glm::vec3 s(random.between(0.1f, 1), random.between(1, 3), random.between(3, 20));
    const glm::vec3 signs(round & 1 ? -1 : 1, round & 2 ? -1 : 1, round & 4 ? -1 : 1);
    const glm::mat4 m = random.rotation() * glm::scale(glm::mat4(1), s * signs) * random.rotation();
    const glm::vec2 range = scaleRange(m);
    // The smallest is a root of a difference of squares up to 20^2, each good to a rounding of the matrix.
    EXPECT_NEAR(range.x, s.x, 1e-6f * 400 / s.x);
    EXPECT_NEAR(range.y, s.z, 2e-6f * s.z);
  }
}

TEST(ScaleRange, BoundsEveryDirectionOfAShear) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    const glm::mat4 m = random.affine();
    const glm::vec2 range = scaleRange(m);
    float least = 1e9f, most = 0;
    for (int i = 0; i < 4000; ++i) {
      const float stretch = glm::length(transformDirection(m, random.direction()));
      least = std::min(least, stretch), most = std::max(most, stretch);
    }
    EXPECT_LE(range.x, least + 1e-4f);
    EXPECT_GE(range.y, most - 1e-4f);
    // 4000 directions lie within 0.08 of any other, where the stretch is flat: off by 0.08^2/2 of the largest.
    EXPECT_NEAR(range.y, most, 0.01f * range.y);
  }
}

TEST(ScaleRange, UniformAndFlatTransforms) {
  EXPECT_EQ(scaleRange(glm::mat4(1)), glm::vec2(1));
  EXPECT_EQ(scaleRange(glm::scale(glm::mat4(1), glm::vec3(-3))), glm::vec2(3));
  EXPECT_NEAR(scaleRange(glm::scale(glm::mat4(1), {2, 0, 3})).x, 0.0f, 1e-6f);
  EXPECT_EQ(scaleRange(glm::mat4(0)), glm::vec2(0));
}

TEST(Octahedral, RoundTripGivesTheDirectionBack) {
  Random random(5);
  for (int round = 0; round < 20000; ++round) {
    const glm::vec3 d = random.direction();
    const glm::vec2 packed = octahedralFromDirection(d);
    EXPECT_LE(std::max(std::abs(packed.x), std::abs(packed.y)), 1.0f);
    ASSERT_LT(glm::distance(directionFromOctahedral(packed), d), 1e-6f);
  }
}

TEST(Octahedral, AxesAndFoldsAreExact) {
  for (const float x : {-1.0f, 0.0f, 1.0f})
    for (const float y : {-1.0f, 0.0f, 1.0f})
      for (const float z : {-1.0f, 0.0f, 1.0f}) {
        if (x == 0 && y == 0 && z == 0) continue;
        const glm::vec3 d = glm::normalize(glm::vec3(x, y, z));
        EXPECT_LT(glm::distance(directionFromOctahedral(octahedralFromDirection(d)), d), 1e-6f) << x << y << z;
      }
  EXPECT_EQ(octahedralFromDirection({0, 0, 1}), glm::vec2(0));
  EXPECT_EQ(directionFromOctahedral({1, 1}), glm::vec3(0, 0, -1));
}

TEST(Srgb, MeetsTheStandardsValuesAndItsOwnInverse) {
  EXPECT_EQ(srgbFromLinear(0.0f), 0.0f);
  EXPECT_NEAR(srgbFromLinear(1.0f), 1.0f, 1e-6f);
  EXPECT_NEAR(linearFromSrgb(0.5f), 0.21404114f, 1e-6f);
  EXPECT_NEAR(srgbFromLinear(0.002f), 0.02584f, 1e-7f); // on the straight part: 12.92 x
  for (int code = 0; code < 256; ++code) {
    const float srgb = static_cast<float>(code) / 255.0f;
    EXPECT_NEAR(srgbFromLinear(linearFromSrgb(srgb)), srgb, 1e-6f);
  }
}

TEST(IsFinite, SeesEveryComponent) {
  for (int i = 0; i < 16; ++i) {
    glm::mat4 m(1);
    m[i / 4][i % 4] = i % 2 ? std::nanf("") : std::numeric_limits<float>::infinity();
    EXPECT_FALSE(isFinite(m)) << i;
  }
  EXPECT_TRUE(isFinite(glm::mat4(1)));
}

TEST(CeilDivide, RoundsUp) {
  EXPECT_EQ(ceilDivide(0, 7), 0u);
  EXPECT_EQ(ceilDivide(7, 7), 1u);
  EXPECT_EQ(ceilDivide(8, 7), 2u);
}

} // namespace
} // namespace brickfield::test
