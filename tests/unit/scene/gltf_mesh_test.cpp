// Primitives of every kind: topology, accessors, normals, influences, morph targets.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scene/gltf_builder.h"

namespace brickfield::test {

namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

Primitive onlyPrimitive(const GltfBuilder& builder) {
  const Scene scene = builder.import();
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].primitives.size(), 1u);
  return scene.meshes[0].primitives[0];
}

std::vector<float> zigzag(int count) {
  std::vector<float> positions;
  for (int i = 0; i < count; ++i)
    positions.insert(positions.end(), {static_cast<float>(i / 2), static_cast<float>(i % 2), 0.0f});
  return positions;
}
std::vector<float> upNormals(int count) {
  std::vector<float> normals;
  for (int i = 0; i < count; ++i) normals.insert(normals.end(), {0, 0, 1});
  return normals;
}

float areaTowardsZ(const Primitive& primitive, std::size_t triangle) {
  const glm::vec3 a = primitive.positions[primitive.indices[3 * triangle]],
                  b = primitive.positions[primitive.indices[3 * triangle + 1]],
                  c = primitive.positions[primitive.indices[3 * triangle + 2]];
  return 0.5f * glm::cross(b - a, c - a).z;
}

TEST(GltfMesh, StripKeepsItsWinding) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", zigzag(6)), normal = builder.accessor("VEC3", upNormals(6));
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}}, {{"mode", 5}});
  const Primitive primitive = onlyPrimitive(builder);
  EXPECT_THAT(primitive.indices, ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4));
  for (std::size_t t = 0; t < 4; ++t)
    EXPECT_FLOAT_EQ(areaTowardsZ(primitive, t), areaTowardsZ(primitive, 0)) << "triangle " << t;
}

TEST(GltfMesh, IndexedStripAndFan) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions()), normal = builder.accessor("VEC3", squareNormals());
  const int indices = builder.accessor("SCALAR", std::vector<std::uint8_t>{0, 1, 3, 2});
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}}, {{"mode", 5}, {"indices", indices}});
  EXPECT_THAT(onlyPrimitive(builder).indices, ElementsAre(0, 1, 3, 1, 2, 3));
  builder.root["meshes"][0]["primitives"][0]["mode"] = 6;
  builder.root["meshes"][0]["primitives"][0].erase("indices");
  const Primitive fan = onlyPrimitive(builder);
  EXPECT_THAT(fan.indices, ElementsAre(1, 2, 0, 2, 3, 0));
  EXPECT_FLOAT_EQ(areaTowardsZ(fan, 0) + areaTowardsZ(fan, 1), 1.0f);
}

TEST(GltfMesh, LinesAndPointsAreLeftOutAloud) {
  for (int mode = 0; mode < 4; ++mode) {
    GltfBuilder builder;
    builder.mesh({{"POSITION", builder.accessor("VEC3", squarePositions())}}, {{"mode", mode}});
    const Scene scene = builder.import();
    EXPECT_TRUE(scene.meshes[0].primitives.empty());
    EXPECT_THAT(scene.warnings,
                ::testing::Contains(HasSubstr(mode == 0 ? "points are left out" : "lines are left out")));
  }
}

TEST(GltfMesh, IndicesAreHeldAgainstTheVertices) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions());
  builder.mesh({{"POSITION", position}},
               {{"indices", builder.accessor("SCALAR", std::vector<std::uint16_t>{0, 1, 4})}});
  EXPECT_THAT(builder.error(), HasSubstr("test.glb: mesh 0 primitive 0: index 4 at 2 is not below the vertex count 4"));
  builder.root["meshes"][0]["primitives"][0]["indices"] =
      builder.accessor("SCALAR", std::vector<std::uint16_t>{0, 1, 65535});
  EXPECT_THAT(builder.error(), HasSubstr("index 65535 at 2 is the primitive restart value"));
  builder.root["meshes"][0]["primitives"][0]["indices"] = builder.accessor("SCALAR", std::vector<float>{0, 1, 2});
  EXPECT_THAT(builder.error(), HasSubstr("has components f32"));
}

TEST(GltfMesh, SparseValuesReplaceBaseAndZeros) {
  GltfBuilder builder;
  const int indexView = builder.view(std::vector<std::uint16_t>{1, 3});
  const int valueView = builder.view(std::vector<float>{5, 6, 7, 8, 9, 10});
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indexView}, {"componentType", 5123}}},
                       {"values", {{"bufferView", valueView}}}};
  const int based = builder.accessor("VEC3", squarePositions());
  builder.root["accessors"][static_cast<std::size_t>(based)]["sparse"] = sparse;
  const int unbased =
      builder.append("accessors", json{{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}, {"sparse", sparse}});
  const int normal = builder.accessor("VEC3", squareNormals());
  const int indices = builder.accessor("SCALAR", std::vector<std::uint8_t>{0, 1, 2});
  builder.mesh({{"POSITION", based}, {"NORMAL", normal}}, {{"indices", indices}});
  builder.mesh({{"POSITION", unbased}, {"NORMAL", normal}}, {{"indices", indices}});
  const Scene scene = builder.import();
  using V = glm::vec3;
  EXPECT_THAT(scene.meshes[0].primitives[0].positions, ElementsAre(V(0, 0, 0), V(5, 6, 7), V(1, 1, 0), V(8, 9, 10)));
  EXPECT_THAT(scene.meshes[1].primitives[0].positions, ElementsAre(V(0), V(5, 6, 7), V(0), V(8, 9, 10)));
}

TEST(GltfMesh, SparseIndicesMustIncreaseWithinRange) {
  const auto errorOf = [](std::vector<std::uint16_t> indices, int count) {
    GltfBuilder builder;
    const int indexView = builder.view(indices);
    const int valueView = builder.view(std::vector<float>{5, 6, 7, 8, 9, 10});
    const int position = builder.accessor("VEC3", squarePositions());
    builder.root["accessors"][static_cast<std::size_t>(position)]["sparse"] = {
        {"count", count},
        {"indices", {{"bufferView", indexView}, {"componentType", 5123}}},
        {"values", {{"bufferView", valueView}}}};
    builder.mesh({{"POSITION", position}});
    return builder.error();
  };
  EXPECT_EQ(errorOf({0, 1}, 2), "");
  EXPECT_THAT(errorOf({1, 1}, 2), HasSubstr("does not increase"));
  EXPECT_THAT(errorOf({2, 1}, 2), HasSubstr("does not increase"));
  EXPECT_THAT(errorOf({0, 4}, 2), HasSubstr("is not below count 4"));
  EXPECT_THAT(errorOf({0, 1}, 3), HasSubstr("needs 6 bytes"));
  EXPECT_THAT(errorOf({0, 1}, 5), HasSubstr("5 sparse values for 4 elements"));
}

TEST(GltfMesh, NormalizedIntegersDecodeAsSpecified) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions()), normal = builder.accessor("VEC3", squareNormals());
  const int uv8 = builder.accessor("VEC2", std::vector<std::uint8_t>{0, 255, 51, 102, 0, 0, 0, 0}, true);
  const int uv16 = builder.accessor("VEC2", std::vector<std::uint16_t>{0, 65535, 13107, 26214, 0, 0, 0, 0}, true);
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv8}, {"TEXCOORD_1", uv16}}, {{"mode", 6}});
  const Primitive primitive = onlyPrimitive(builder);
  for (const auto& uvs : primitive.uvs) {
    EXPECT_EQ(uvs[0], glm::vec2(0, 1));
    EXPECT_FLOAT_EQ(uvs[1].x, 0.2f);
    EXPECT_FLOAT_EQ(uvs[1].y, 0.4f);
  }
}

TEST(GltfMesh, QuantizedAttributesNeedTheirExtension) {
  GltfBuilder builder;
  const int view = builder.view(std::vector<std::int8_t>{-128, 127, 0, 0, 64, 0, 0, 0, -127, 0, 0, 0});
  builder.root["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 4;
  const int position = builder.append(
      "accessors",
      json{{"bufferView", view}, {"componentType", 5120}, {"normalized", true}, {"count", 3}, {"type", "VEC3"}});
  builder.mesh({{"POSITION", position}});
  EXPECT_THAT(builder.error(), HasSubstr("has components i8n, not one of f32"));
  builder.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Primitive primitive = onlyPrimitive(builder);
  EXPECT_EQ(primitive.positions[0], glm::vec3(-1, 1, 0));
  EXPECT_FLOAT_EQ(primitive.positions[1].x, 64.0f / 127.0f);
  EXPECT_EQ(primitive.positions[2].x, -1.0f);
}

TEST(GltfMesh, InterleavedAttributesAreRead) {
  GltfBuilder builder;
  std::vector<float> vertices;
  for (int v = 0; v < 4; ++v) {
    const auto p = squarePositions(), n = squareNormals();
    for (std::size_t k = 0; k < 3; ++k) vertices.push_back(p[3 * static_cast<std::size_t>(v) + k]);
    for (std::size_t k = 0; k < 3; ++k) vertices.push_back(n[3 * static_cast<std::size_t>(v) + k]);
  }
  const int view = builder.view(vertices.data(), vertices.size() * sizeof(float), 24);
  const auto accessor = [&](int byteOffset, int count) {
    return builder.append("accessors", json{{"bufferView", view},
                                            {"byteOffset", byteOffset},
                                            {"componentType", 5126},
                                            {"count", count},
                                            {"type", "VEC3"}});
  };
  builder.mesh({{"POSITION", accessor(0, 4)}, {"NORMAL", accessor(12, 4)}}, {{"mode", 6}});
  const Primitive primitive = onlyPrimitive(builder);
  EXPECT_THAT(primitive.positions,
              ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(primitive.normals, ::testing::Each(glm::vec3(0, 0, 1)));
  accessor(16, 4);
  EXPECT_THAT(builder.error(), HasSubstr("accessor 2: needs 100 bytes, bufferView 0 has 96"));
}

TEST(GltfMesh, MissingNormalsMakeFlatTriangles) {
  GltfBuilder builder;
  // A tent of two triangles that share an edge.
  const int position = builder.accessor("VEC3", std::vector<float>{0, 0, 0, 0, 0, 1, 1, 1, 0, -1, 1, 0});
  const int colors = builder.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0});
  const int indices = builder.accessor("SCALAR", std::vector<std::uint32_t>{0, 1, 2, 0, 3, 1});
  const int morph = builder.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0});
  const int tangent = builder.accessor("VEC4", std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
  builder.mesh({{"POSITION", position}, {"COLOR_0", colors}, {"TANGENT", tangent}},
               {{"indices", indices}, {"targets", {{{"POSITION", morph}}}}});
  const Primitive primitive = onlyPrimitive(builder);
  EXPECT_TRUE(primitive.flatNormals);
  EXPECT_THAT(primitive.indices, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_TRUE(primitive.tangents.empty()) << "tangents without normals must be ignored";
  const float h = std::sqrt(0.5f);
  for (std::size_t v = 0; v < 6; ++v) {
    EXPECT_FLOAT_EQ(primitive.normals[v].x, v < 3 ? -h : h);
    EXPECT_FLOAT_EQ(primitive.normals[v].y, h);
    const float source = std::array{0.0f, 1.0f, 2.0f, 0.0f, 3.0f, 1.0f}[v];
    EXPECT_EQ(primitive.colors[v].x, source);
    EXPECT_EQ(primitive.morphTargets[0].positions[v].x, source);
  }
}

TEST(GltfMesh, NormalsAreMadeUnitAndZeroOnesRebuilt) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions());
  const int normal = builder.accessor("VEC3", std::vector<float>{0, 0, 2, 0, 0, 0, 0, 0, 1, 0, 3, 4});
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}}, {{"mode", 6}});
  const Scene scene = builder.import();
  const auto& normals = scene.meshes[0].primitives[0].normals;
  EXPECT_EQ(normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(normals[1], glm::vec3(0, 0, 1));
  EXPECT_FLOAT_EQ(normals[3].y, 0.6f);
  EXPECT_FALSE(scene.meshes[0].primitives[0].flatNormals);
  EXPECT_THAT(scene.warnings, ::testing::Contains(HasSubstr("2 normals were not unit")));
  EXPECT_THAT(scene.warnings, ::testing::Contains(HasSubstr("1 normals were zero")));
}

TEST(GltfMesh, NumbersThatAreNotFiniteNameTheAccessor) {
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    GltfBuilder builder;
    std::vector<float> positions = squarePositions();
    positions[7] = bad;
    builder.mesh({{"POSITION", builder.accessor("VEC3", positions)}});
    EXPECT_THAT(builder.error(), HasSubstr("accessor 0: element 2 holds"));
    builder.root["meshes"][0]["primitives"][0]["attributes"] = {
        {"POSITION", builder.accessor("VEC3", squarePositions())}, {"NORMAL", 0}};
    EXPECT_THAT(builder.error(), HasSubstr("accessor 0: element 2 holds"));
  }
}

TEST(GltfMesh, ColoursOfEveryTypeBecomeLinearRgba) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int bytes =
      builder.accessor("VEC4", std::vector<std::uint8_t>{255, 0, 51, 102, 0, 0, 0, 0, 0, 0, 0, 255}, true);
  const int words = builder.accessor("VEC3", std::vector<std::uint16_t>{65535, 0, 13107, 0, 0, 0, 0, 0, 0, 0}, true);
  const int floats = builder.accessor("VEC4", std::vector<float>{-1, 2, 0.5f, 3, 0, 0, 0, 0, 0, 0, 0, 1});
  builder.root["accessors"][static_cast<std::size_t>(words)]["count"] = 3;
  for (const int color : {bytes, words, floats}) builder.mesh({{"POSITION", position}, {"COLOR_0", color}});
  // Three u16 numbers a vertex lie 6 bytes apart: readable, if unaligned for a GPU.
  const Scene scene = builder.import();
  const auto colorOf = [&](std::size_t mesh) { return scene.meshes[mesh].primitives[0].colors[0]; };
  EXPECT_FLOAT_EQ(colorOf(0).z, 0.2f);
  EXPECT_FLOAT_EQ(colorOf(0).w, 0.4f);
  EXPECT_FLOAT_EQ(colorOf(1).z, 0.2f);
  EXPECT_EQ(colorOf(1).w, 1.0f);
  EXPECT_EQ(colorOf(2), glm::vec4(0, 2, 0.5f, 1));
  EXPECT_THAT(scene.warnings, ::testing::Contains(HasSubstr("COLOR_0 is clamped")));
}

TEST(GltfMesh, AttributesMustCountAlike) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions());
  const int normal = builder.accessor("VEC3", upNormals(3));
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}});
  EXPECT_THAT(builder.error(), HasSubstr("mesh 0 primitive 0: NORMAL: has 3 elements, POSITION has 4"));
}

TEST(GltfMesh, GivenTangentsKeepTheirHandedness) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", upNormals(3)), normal = builder.accessor("VEC3", upNormals(3));
  const int tangent = builder.accessor("VEC4", std::vector<float>{2, 0, 0, 1, 0, 1, 0, -1, 0, 0, 0, -1});
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}});
  const auto tangents = onlyPrimitive(builder).tangents;
  EXPECT_EQ(tangents[0], glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(tangents[1], glm::vec4(0, 1, 0, -1));
  EXPECT_EQ(tangents[2].w, -1.0f);
  EXPECT_FLOAT_EQ(glm::length(glm::vec3(tangents[2])), 1.0f) << "a zero tangent is replaced";
  const int broken = builder.accessor("VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1});
  builder.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = broken;
  EXPECT_THAT(builder.error(), HasSubstr("TANGENT of vertex 0 has w = 0"));
}

/// A square, a skin of two joints and a node that uses both.
GltfBuilder skinnedSquare(const std::vector<std::uint8_t>& joints, const std::vector<float>& weights) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int normal = builder.accessor("VEC3", upNormals(3));
  const int joint = builder.accessor("VEC4", joints), weight = builder.accessor("VEC4", weights);
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}});
  builder.append("nodes", R"({"mesh":0,"skin":0})");
  builder.append("nodes", R"({"children":[2]})");
  builder.append("nodes", "{}");
  builder.append("skins", R"({"joints":[1,2]})");
  return builder;
}

TEST(GltfMesh, WeightsAreScaledToSumToOne) {
  GltfBuilder builder = skinnedSquare({0, 1, 0, 0, 1, 0, 9, 0, 0, 0, 0, 0}, {1, 3, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
  const Scene scene = builder.import();
  const Primitive& primitive = scene.meshes[0].primitives[0];
  ASSERT_EQ(primitive.influencesPerVertex, 4);
  EXPECT_THAT(primitive.jointWeights,
              ElementsAreArray({0.25f, 0.75f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f}));
  EXPECT_EQ(primitive.joints[6], 0) << "an unweighted joint out of range is harmless and cleared";
  EXPECT_THAT(scene.warnings, ::testing::Contains(HasSubstr("1 vertices have no weights")));
}

TEST(GltfMesh, JointsAreHeldAgainstTheSkin) {
  EXPECT_THAT(skinnedSquare({2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}).error(),
              HasSubstr("vertex 0 names joint 2, a skin that uses it has 2"));
  EXPECT_THAT(skinnedSquare({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}).error(),
              HasSubstr("negative weight"));
}

TEST(GltfMesh, SecondInfluencesInterleaveToEight) {
  GltfBuilder builder = skinnedSquare({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, {1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0});
  const int joints = builder.accessor("VEC4", std::vector<std::uint16_t>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const int weights = builder.accessor(
      "VEC4", std::vector<std::uint16_t>{65535, 65535, 0, 0, 65535, 65535, 0, 0, 65535, 65535, 0, 0}, true);
  auto& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] = joints;
  EXPECT_THAT(builder.error(), HasSubstr("has only one of JOINTS_1 and WEIGHTS_1"));
  attributes["WEIGHTS_1"] = weights;
  const Primitive primitive = onlyPrimitive(builder);
  ASSERT_EQ(primitive.influencesPerVertex, 8);
  EXPECT_EQ(primitive.joints.size(), 24u);
  EXPECT_EQ(primitive.joints[8 + 1], 1);
  EXPECT_EQ(primitive.joints[8 + 4], 1);
  EXPECT_FLOAT_EQ(primitive.jointWeights[8 + 5], 0.25f);
}

TEST(GltfMesh, MeshUnderASkinNeedsJoints) {
  GltfBuilder builder = skinnedSquare({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  builder.root["nodes"][0].erase("skin");
  EXPECT_EQ(onlyPrimitive(builder).influencesPerVertex, 0) << "nobody can say what the joints mean";
  builder.root["nodes"][0]["skin"] = 0;
  builder.root["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}};
  EXPECT_THAT(builder.error(), HasSubstr("it has no JOINTS_0"));
}

TEST(GltfMesh, MorphTargetsAndWeights) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions()), normal = builder.accessor("VEC3", squareNormals());
  const int morph = builder.accessor("VEC3", std::vector<float>{0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4});
  const int sparseIndices = builder.view(std::vector<std::uint8_t>{2});
  const int sparseValues = builder.view(std::vector<float>{0, 1, 0});
  const int sparse =
      builder.append("accessors", json{{"componentType", 5126},
                                       {"count", 4},
                                       {"type", "VEC3"},
                                       {"sparse",
                                        {{"count", 1},
                                         {"indices", {{"bufferView", sparseIndices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", sparseValues}}}}}});
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}},
               {{"mode", 6}, {"targets", {{{"POSITION", morph}}, {{"POSITION", morph}, {"NORMAL", sparse}}}}});
  const Scene plain = builder.import();
  EXPECT_THAT(plain.meshes[0].morphWeights, ElementsAre(0.0f, 0.0f));
  const Primitive& primitive = plain.meshes[0].primitives[0];
  ASSERT_EQ(primitive.morphTargets.size(), 2u);
  EXPECT_EQ(primitive.morphTargets[0].positions[3], glm::vec3(0, 0, 4));
  EXPECT_TRUE(primitive.morphTargets[0].normals.empty());
  EXPECT_EQ(primitive.morphTargets[1].normals[2], glm::vec3(0, 1, 0));
  EXPECT_EQ(primitive.morphTargets[1].normals[1], glm::vec3(0));

  builder.root["meshes"][0]["weights"] = {0.5, 0.25};
  builder.append("nodes", R"({"mesh":0,"weights":[1,2]})");
  const Scene weighted = builder.import();
  EXPECT_THAT(weighted.meshes[0].morphWeights, ElementsAre(0.5f, 0.25f));
  EXPECT_THAT(weighted.nodes[0].morphWeights, ElementsAre(1.0f, 2.0f));
  builder.root["nodes"][0]["weights"] = {1};
  EXPECT_THAT(builder.error(), HasSubstr("node 0: has 1 weights, its mesh has 2 morph targets"));
  builder.root["meshes"][0]["weights"] = {0.5};
  EXPECT_THAT(builder.error(), HasSubstr("mesh 0: has 1 weights for 2 morph targets"));
}

TEST(GltfMesh, NormalMapsGetTangentsOnly) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions()), normal = builder.accessor("VEC3", squareNormals());
  const int uv = builder.accessor("VEC2", std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0});
  builder.mesh({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}, {{"mode", 6}, {"material", 0}});
  builder.append("materials", "{}");
  EXPECT_TRUE(onlyPrimitive(builder).tangents.empty()) << "no normal map, no tangents";
  // A red PNG of one pixel.
  builder.append(
      "images",
      R"({"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC"})");
  builder.append("textures", R"({"source":0})");
  builder.root["materials"][0]["normalTexture"] = {{"index", 0}};
  const Primitive mapped = onlyPrimitive(builder);
  ASSERT_EQ(mapped.tangents.size(), 4u);
  for (const glm::vec4& tangent : mapped.tangents) EXPECT_EQ(tangent, glm::vec4(1, 0, 0, 1));
  builder.root["materials"][0]["normalTexture"]["texCoord"] = 1;
  const Scene lacking = builder.import();
  EXPECT_EQ(lacking.meshes[0].primitives[0].tangents.size(), 4u) << "without uvs some perpendicular";
  EXPECT_THAT(lacking.warnings, ::testing::Contains(HasSubstr("needs TEXCOORD_1")));
}

TEST(GltfMesh, LimitsHoldBeforeAllocation) {
  GltfBuilder builder;
  builder.append("accessors", R"({"componentType":5126,"count":4000000000,"type":"VEC3"})");
  builder.mesh({{"POSITION", 0}});
  EXPECT_THAT(builder.error(), HasSubstr("vertices, keys and instances, the limit"));
  builder.root["accessors"][0]["count"] = 100'000'000;
  EXPECT_THAT(builder.error(), HasSubstr("without a bufferView"));
  ImportLimits limits;
  limits.verticesTotal = 5;
  GltfBuilder square;
  square.mesh(
      {{"POSITION", square.accessor("VEC3", squarePositions())}, {"NORMAL", square.accessor("VEC3", squareNormals())}},
      {{"mode", 6}});
  EXPECT_EQ(square.error(limits), "");
  square.root["meshes"].push_back(square.root["meshes"][0]);
  EXPECT_THAT(square.error(limits), HasSubstr("more than 5 vertices"));
  limits = {};
  limits.indicesTotal = 11;
  EXPECT_THAT(square.error(limits), HasSubstr("more than 11 indices"));
}

} // namespace

} // namespace brickfield::test
