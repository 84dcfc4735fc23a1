// Morphing and skinning against values worked out by hand.
#include "scene/pose.h"

#include <numbers>

#include <gtest/gtest.h>

using namespace brickfield;

namespace {

void expectNear(glm::vec3 actual, glm::vec3 expected, float tolerance = 1e-6f) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

Primitive triangleWithTangents() {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.normals.assign(3, {0, 0, 1});
  primitive.tangents.assign(3, {1, 0, 0, -1});
  primitive.indices = {0, 1, 2};
  return primitive;
}

void bindAllTo(Primitive& primitive, std::array<float, 2> weights) {
  primitive.influencesPerVertex = 4;
  for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
    primitive.joints.insert(primitive.joints.end(), {0, 1, 0, 0});
    primitive.jointWeights.insert(primitive.jointWeights.end(), {weights[0], weights[1], 0, 0});
  }
}

glm::mat4 movedBy(glm::vec3 offset) {
  glm::mat4 matrix(1.0f);
  matrix[3] = glm::vec4(offset, 1.0f);
  return matrix;
}

} // namespace

TEST(Deform, RigidStaysAsItIs) {
  const Primitive primitive = triangleWithTangents();
  const DeformedPrimitive deformed = deformPrimitive(primitive, {});
  EXPECT_EQ(deformed.positions, primitive.positions);
  EXPECT_EQ(deformed.normals, primitive.normals);
  EXPECT_EQ(deformed.tangents, primitive.tangents);
  EXPECT_FALSE(isDeformed(primitive, {}));
}

TEST(Deform, MorphsAddWeightedOffsets) {
  Primitive primitive = triangleWithTangents();
  primitive.morphTargets.push_back({{{1, 0, 0}, {0, 0, 0}, {0, 0, 2}}, {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {}});
  primitive.morphTargets.push_back({{}, {}, {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}});
  PosedInstance instance;
  instance.morphWeights = {0.5f, 1.0f};
  EXPECT_TRUE(isDeformed(primitive, instance));
  const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
  expectNear(deformed.positions[0], {0.5f, 0, 0});
  expectNear(deformed.positions[1], {1, 0, 0});
  expectNear(deformed.positions[2], {0, 1, 1});
  expectNear(deformed.normals[0], glm::normalize(glm::vec3(0.5f, 0, 1)));
  expectNear(glm::vec3(deformed.tangents[0]), glm::normalize(glm::vec3(1, 0, 1)));
  EXPECT_EQ(deformed.tangents[0].w, -1.0f);
  instance.morphWeights = {0.0f, 0.0f};
  EXPECT_FALSE(isDeformed(primitive, instance));
}

TEST(Deform, SkinsBlendJointMatrices) {
  Primitive primitive = triangleWithTangents();
  bindAllTo(primitive, {0.25f, 0.75f});
  PosedInstance instance;
  instance.worldFromBind = {movedBy({4, 0, 0}), movedBy({0, 0, 8})};
  EXPECT_TRUE(isDeformed(primitive, instance));
  const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
  expectNear(deformed.positions[1], {2, 0, 6});
  expectNear(deformed.normals[1], {0, 0, 1});
}

TEST(Deform, MorphComesBeforeSkin) {
  Primitive primitive = triangleWithTangents();
  bindAllTo(primitive, {1, 0});
  primitive.morphTargets.push_back({{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {}, {}});
  PosedInstance instance;
  instance.morphWeights = {1};
  glm::mat4 scaled(2.0f);
  scaled[3] = {0, 0, 0, 1};
  instance.worldFromBind = {scaled, scaled};
  expectNear(deformPrimitive(primitive, instance).positions[0], {2, 0, 0});
}

TEST(Deform, NormalsStayUprightUnderShear) {
  // x += y: the triangle's plane z = 0 stays, a normal in the plane's own tilt must turn by the cofactor matrix.
  Primitive primitive = triangleWithTangents();
  primitive.normals.assign(3, {1, 0, 0}); // of the plane x = const
  bindAllTo(primitive, {1, 0});
  glm::mat4 shear(1.0f);
  shear[1].x = 1.0f;
  PosedInstance instance;
  instance.worldFromBind = {shear, shear};
  // The plane x = c becomes x - y = c.
  expectNear(deformPrimitive(primitive, instance).normals[0], glm::normalize(glm::vec3(1, -1, 0)));
}

TEST(Deform, NonUniformScaleKeepsNormalsPerpendicular) {
  Primitive primitive = triangleWithTangents();
  primitive.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  primitive.normals.assign(3, glm::normalize(glm::vec3(1, 1, 1)));
  bindAllTo(primitive, {1, 0});
  glm::mat4 scale(1.0f);
  scale[0].x = 4.0f;
  scale[1].y = 0.5f;
  PosedInstance instance;
  instance.worldFromBind = {scale, scale};
  const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
  EXPECT_NEAR(glm::dot(deformed.normals[0], deformed.positions[1] - deformed.positions[0]), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::dot(deformed.normals[0], deformed.positions[2] - deformed.positions[0]), 0.0f, 1e-6f);
}

TEST(Deform, MirroringJointKeepsNormalOnTheWindingsSide) {
  Primitive primitive = triangleWithTangents();
  bindAllTo(primitive, {1, 0});
  glm::mat4 mirror(1.0f);
  mirror[0].x = -1.0f;
  PosedInstance instance;
  instance.worldFromBind = {mirror, mirror};
  const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
  const glm::vec3 winding =
      glm::cross(deformed.positions[1] - deformed.positions[0], deformed.positions[2] - deformed.positions[0]);
  EXPECT_GT(glm::dot(winding, deformed.normals[0]), 0.0f);
}

TEST(Deform, FlatNormalsFollowTheMovedTriangle) {
  Primitive primitive = triangleWithTangents();
  primitive.flatNormals = true;
  primitive.morphTargets.push_back({{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}}, {}, {}});
  PosedInstance instance;
  instance.morphWeights = {1};
  const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
  // Corners (0,0,0), (1,0,1), (0,1,0).
  for (const glm::vec3 normal : deformed.normals) expectNear(normal, glm::normalize(glm::vec3(-1, 0, 1)));
}

TEST(Deform, EightInfluencesAllCount) {
  Primitive primitive = triangleWithTangents();
  primitive.influencesPerVertex = 8;
  for (int vertex = 0; vertex < 3; ++vertex)
    for (std::uint16_t j = 0; j < 8; ++j) {
      primitive.joints.push_back(j);
      primitive.jointWeights.push_back(0.125f);
    }
  PosedInstance instance;
  for (int j = 0; j < 8; ++j) instance.worldFromBind.push_back(movedBy({static_cast<float>(j), 0, 0}));
  expectNear(deformPrimitive(primitive, instance).positions[0], {3.5f, 0, 0});
}
