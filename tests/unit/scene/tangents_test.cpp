// MikkTSpace against closed forms: planes with known uv maps, mirrored halves, corners weighted by angle.
#include "scene/tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/primitive_build.h"

namespace brickfield {

namespace {

void expectNear(glm::vec4 actual, glm::vec4 expected, float tolerance = 1e-6f) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
}

// A strip of two squares side by side along x in the plane z = 0, sharing the vertices at x = 1. u grows with x on the
// left and falls again on the right, as a texture mirrored in the middle.
Primitive mirroredQuads() {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  primitive.normals.assign(6, {0, 0, 1});
  primitive.uvs[0] = {{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}};
  primitive.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
  return primitive;
}

TEST(Tangents, PlaneFollowsGrowingU) {
  const std::vector<std::uint32_t> indices = {0, 1, 2};
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::vec3> normals(3, {0, 0, 1});
  // An image that stands upright on the plane: u = x, and v = 1 - y since it grows downwards. Tangent +x and bitangent
  // +y are where red and green of a normal map point, so w is +1: cross(n, t) = +y.
  const std::vector<glm::vec2> uvs = {{0, 1}, {1, 1}, {0, 0}};
  for (const glm::vec4& tangent : cornerTangents(indices, positions, normals, uvs)) expectNear(tangent, {1, 0, 0, 1});
  const std::vector<glm::vec2> turned = {{0, 0}, {0, 1}, {1, 0}}; // u = y, v = x
  for (const glm::vec4& tangent : cornerTangents(indices, positions, normals, turned))
    expectNear(tangent, {0, 1, 0, 1});
  const std::vector<glm::vec2> upright = {{0, 0}, {1, 0}, {0, 1}};
  for (const glm::vec4& tangent : cornerTangents(indices, positions, normals, upright))
    expectNear(tangent, {1, 0, 0, -1});
}

TEST(Tangents, MirroredUvKeepsTheHalvesApart) {
  const Primitive primitive = mirroredQuads();
  const auto tangents = cornerTangents(primitive.indices, primitive.positions, primitive.normals, primitive.uvs[0]);
  for (std::size_t corner = 0; corner < 6; ++corner) expectNear(tangents[corner], {1, 0, 0, 1});
  for (std::size_t corner = 6; corner < 12; ++corner) expectNear(tangents[corner], {-1, 0, 0, -1});
}

TEST(Tangents, MirrorSplitsSharedVerticesWithAllAttributes) {
  Primitive primitive = mirroredQuads();
  primitive.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {2, 0, 0, 1}, {3, 0, 0, 1}, {4, 0, 0, 1}, {5, 0, 0, 1}};
  primitive.influencesPerVertex = 4;
  for (std::uint16_t v = 0; v < 6; ++v)
    for (int k = 0; k < 4; ++k) primitive.joints.push_back(v), primitive.jointWeights.push_back(0.25f);
  primitive.morphTargets.resize(1);
  for (int v = 0; v < 6; ++v) primitive.morphTargets[0].positions.emplace_back(static_cast<float>(v), 0.0f, 0.0f);
  const std::vector<std::uint32_t> before = primitive.indices;
  makeTangents(primitive, 0);
  ASSERT_EQ(primitive.positions.size(), 8u) << "the two vertices of the seam are doubled, no others";
  EXPECT_EQ(primitive.tangents.size(), 8u);
  EXPECT_EQ(primitive.joints.size(), 32u);
  for (std::size_t corner = 0; corner < before.size(); ++corner) {
    const std::uint32_t old = before[corner], now = primitive.indices[corner];
    EXPECT_EQ(primitive.colors[now].x, static_cast<float>(old));
    EXPECT_EQ(primitive.joints[4 * now], old);
    EXPECT_EQ(primitive.morphTargets[0].positions[now].x, static_cast<float>(old));
    EXPECT_EQ(primitive.tangents[now].w, corner < 6 ? 1.0f : -1.0f);
  }
}

TEST(Tangents, SharedVertexWeighsByAngle) {
  // Two triangles meet at the origin in the plane z = 0 and share the edge to (0, 1). The left one has its corner of
  // 90 degrees and its tangent along +x, the right one 45 degrees and a tangent turned by its uv map to d.
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 1, 0}};
  const std::vector<glm::vec3> normals(4, {0, 0, 1});
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 3, 1};
  const std::vector<glm::vec2> uvs = {{0, 0}, {0, 1}, {-1, 0}, {2, 1}};
  // Left: u = x. Right: u(0,1) = 0, u(1,1) = 2, so u = 2x, v = y: tangent +x as well; tilt it by v instead.
  const std::vector<glm::vec2> tilted = {{0, 0}, {0, 1}, {-1, 0}, {1, 3}};
  // Right: u = x, v = 2x + y: along dv = 0, du > 0 the direction is (1, -2).
  const glm::vec2 right = glm::normalize(glm::vec2(1, -2));
  const float angleLeft = std::numbers::pi_v<float> / 2, angleRight = std::numbers::pi_v<float> / 4;
  const glm::vec2 expected = glm::normalize(angleLeft * glm::vec2(1, 0) + angleRight * right);
  const auto tangents = cornerTangents(indices, positions, normals, tilted);
  expectNear(tangents[0], {expected.x, expected.y, 0, -1});
  expectNear(tangents[3], {expected.x, expected.y, 0, -1});
  expectNear(tangents[2], {1, 0, 0, -1});
  expectNear(cornerTangents(indices, positions, normals, uvs)[0], {1, 0, 0, -1});
}

TEST(Tangents, VerticesThatOnlyTouchDoNotMix) {
  // Two triangles share a vertex but no edge: their tangents stay apart (published grouping rule).
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  const std::vector<glm::vec3> normals(5, {0, 0, 1});
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 3, 4};
  const std::vector<glm::vec2> uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}}; // right u = x; left u = y, v = -x
  const auto tangents = cornerTangents(indices, positions, normals, uvs);
  expectNear(tangents[0], {1, 0, 0, -1});
  expectNear(tangents[3], {0, 1, 0, -1});
}

TEST(Tangents, TangentIsPerpendicularToTheNormal) {
  // A triangle whose vertex normals lean: the tangent is projected onto each corner's plane.
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<glm::vec3> normals(3, glm::normalize(glm::vec3(1, 0, 1)));
  const std::vector<glm::vec2> uvs = {{0, 0}, {1, 0}, {0, 1}};
  const std::vector<std::uint32_t> indices = {0, 1, 2};
  const float h = std::sqrt(0.5f);
  for (const glm::vec4& tangent : cornerTangents(indices, positions, normals, uvs)) expectNear(tangent, {h, 0, -h, -1});
}

TEST(Tangents, EqualVerticesAreWelded) {
  // The same square with and without shared vertices gives the same tangents, though the triangles' own differ.
  const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<glm::vec2> cornerUvs = {{0, 0}, {1, 0}, {1, 1.5f}, {0, 1}};
  const std::vector<std::uint32_t> shared = {0, 1, 2, 0, 2, 3};
  std::vector<glm::vec3> positions;
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> separate;
  for (const std::uint32_t v : shared) {
    separate.push_back(static_cast<std::uint32_t>(positions.size()));
    positions.push_back(corners[v]), uvs.push_back(cornerUvs[v]);
  }
  const std::vector<glm::vec3> normals(6, {0, 0, 1});
  const auto a = cornerTangents(shared, corners, std::span(normals).first(4), cornerUvs);
  const auto b = cornerTangents(separate, positions, normals, uvs);
  for (std::size_t i = 0; i < 6; ++i) expectNear(a[i], b[i], 0.0f);
  EXPECT_NE(a[1], a[5]) << "corners of one triangle only keep its own tangent";
}

TEST(Tangents, DegenerateUvCopiesItsNeighbourOrAnything) {
  const std::vector<glm::vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
  const std::vector<glm::vec3> normals(4, {0, 0, 1});
  const std::vector<glm::vec2> uvs = {{0, 0}, {0, -1}, {1, 0}, {0.5f, 0}}; // u = y; the second triangle has no uv area
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
  const auto tangents = cornerTangents(indices, positions, normals, uvs);
  expectNear(tangents[3], {0, 1, 0, -1});
  expectNear(tangents[4], {0, 1, 0, -1});
  EXPECT_NEAR(glm::length(glm::vec3(tangents[5])), 1.0f, 1e-6f);
  EXPECT_NEAR(tangents[5].z, 0.0f, 1e-6f);
}

TEST(Tangents, AnyPerpendicularIsPerpendicularEverywhere) {
  for (int i = 0; i < 1000; ++i) {
    const float a = 0.1f * static_cast<float>(i), z = std::cos(0.37f * static_cast<float>(i));
    const glm::vec3 normal = glm::normalize(glm::vec3(std::cos(a), std::sin(a), z));
    const glm::vec3 tangent = anyPerpendicular(normal);
    EXPECT_NEAR(glm::dot(normal, tangent), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(tangent), 1.0f, 1e-6f);
  }
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 normal(0.0f);
    normal[axis] = -1.0f;
    EXPECT_NEAR(glm::length(anyPerpendicular(normal)), 1.0f, 1e-6f);
  }
}

TEST(Tangents, HubOfManySeparateTrianglesStaysQuick) {
  // 100,000 triangles that share one vertex and no edge: quadratic work would take minutes.
  Primitive primitive;
  constexpr std::uint32_t kTriangles = 100'000;
  primitive.positions = {{0, 0, 0}};
  primitive.uvs[0] = {{0, 0}};
  for (std::uint32_t t = 0; t < kTriangles; ++t) {
    const float a = 6.2f * static_cast<float>(t) / static_cast<float>(kTriangles);
    const float b = a + 3.0f / static_cast<float>(kTriangles);
    primitive.positions.emplace_back(std::cos(a), std::sin(a), 0.0f);
    primitive.positions.emplace_back(std::cos(b), std::sin(b), 0.0f);
    primitive.uvs[0].emplace_back(1.0f, static_cast<float>(t % 2));
    primitive.uvs[0].emplace_back(0.0f, 1.0f);
    primitive.indices.insert(primitive.indices.end(), {0, 2 * t + 1, 2 * t + 2});
  }
  primitive.normals.assign(primitive.positions.size(), {0, 0, 1});
  makeTangents(primitive, 0);
  EXPECT_GT(primitive.positions.size(), 250'000u);
}

} // namespace

} // namespace brickfield
