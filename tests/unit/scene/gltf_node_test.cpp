// Hierarchy, transforms, scenes, skins, cameras, lights, instances and the project's extras.
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/pose.h"
#include "tests/unit/scene/gltf_builder.h"

namespace brickfield::test {

namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

GltfBuilder withNodes(const char* nodes) {
  GltfBuilder builder;
  builder.root["nodes"] = json::parse(nodes);
  return builder;
}

TEST(GltfNode, TransformsArriveAsWritten) {
  const Scene scene = withNodes(R"([
    {"matrix":[1,2,3,0, 4,5,6,0, 7,8,-9,0, 10,11,12,1]},
    {"translation":[1,2,3],"rotation":[0,0,0.7071068,0.7071068],"scale":[-1,2,0.5]}, {}])")
                          .import();
  ASSERT_TRUE(scene.nodes[0].matrix.has_value());
  EXPECT_EQ((*scene.nodes[0].matrix)[1], glm::vec4(4, 5, 6, 0));
  EXPECT_EQ((*scene.nodes[0].matrix)[3], glm::vec4(10, 11, 12, 1));
  EXPECT_FALSE(scene.nodes[1].matrix.has_value());
  EXPECT_EQ(scene.nodes[1].translation, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.nodes[1].scale, glm::vec3(-1, 2, 0.5f));
  EXPECT_NEAR(scene.nodes[1].rotation.z, std::sqrt(0.5f), 1e-6f);
  EXPECT_NEAR(scene.nodes[1].rotation.w, std::sqrt(0.5f), 1e-6f);
  EXPECT_EQ(scene.nodes[2].rotation, glm::quat(1, 0, 0, 0));
}

TEST(GltfNode, BrokenTransformsNameTheNode) {
  EXPECT_THAT(withNodes(R"([{"name":"Arm","matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}])").error(),
              HasSubstr("node 0 \"Arm\": its matrix is not affine"));
  EXPECT_THAT(withNodes(R"([{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"scale":[1,1,1]}])").error(),
              HasSubstr("both matrix and scale"));
  EXPECT_THAT(withNodes(R"([{"rotation":[0,0,0,0]}])").error(), HasSubstr("no quaternion"));
  EXPECT_THAT(withNodes(R"([{"translation":[0,0,1e300]}])").error(), HasSubstr("out of range"));
  EXPECT_THAT(withNodes(R"([{"translation":[0,0]}])").error(), HasSubstr("has 2 numbers, not 3"));
  const Scene scene = withNodes(R"([{"rotation":[0,0,0,2]}])").import();
  EXPECT_EQ(scene.nodes[0].rotation, glm::quat(1, 0, 0, 0));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("rotation has length 2")));
}

TEST(GltfNode, HierarchyIsAForest) {
  const Scene scene = withNodes(R"([{"children":[2,1]},{},{"children":[3]},{}])").import();
  EXPECT_EQ(scene.nodes[0].parent, -1);
  EXPECT_EQ(scene.nodes[3].parent, 2);
  EXPECT_THAT(scene.nodes[0].children, ElementsAre(2, 1));
  EXPECT_THAT(withNodes(R"([{"children":[1]},{"children":[0]}])").error(), HasSubstr("node 0: is its own ancestor"));
  EXPECT_THAT(withNodes(R"([{"children":[0]}])").error(), HasSubstr("node 0: is its own ancestor"));
  EXPECT_THAT(withNodes(R"([{"children":[2]},{"children":[2]},{"name":"C"}])").error(),
              HasSubstr("node 2 \"C\": has two parents, node 0 and node 1"));
  EXPECT_THAT(withNodes(R"([{"children":[1,1]},{}])").error(), HasSubstr("1 stands there twice"));
}

TEST(GltfNode, ChainsOfAHundredThousandNodesLoad) {
  GltfBuilder builder;
  json nodes = json::array();
  constexpr int kNodes = 100'000;
  for (int i = 0; i < kNodes; ++i) nodes.push_back(i + 1 < kNodes ? json{{"children", {i + 1}}} : json::object());
  builder.root["nodes"] = std::move(nodes);
  builder.append("skins", json{{"joints", {kNodes - 1, 0}}});
  EXPECT_EQ(builder.import().nodes.back().parent, kNodes - 2);
}

TEST(GltfNode, ScenesAndTheDefaultOne) {
  GltfBuilder builder = withNodes(R"([{"children":[1]},{}])");
  Scene scene = builder.import();
  EXPECT_EQ(scene.defaultScene, -1);
  EXPECT_TRUE(scene.scenes.empty());
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("no scene")));
  builder.root["scenes"] = json::parse(R"([{"nodes":[0],"name":"A"},{}])");
  scene = builder.import();
  EXPECT_EQ(scene.defaultScene, 0);
  EXPECT_THAT(scene.scenes[0].nodes, ElementsAre(0));
  builder.root["scene"] = 1;
  EXPECT_EQ(builder.import().defaultScene, 1);
  builder.root["scene"] = 2;
  EXPECT_THAT(builder.error(), HasSubstr("scene: 2 does not exist"));
  builder.root["scene"] = 0;
  builder.root["scenes"][0]["nodes"] = {1};
  EXPECT_THAT(builder.error(), HasSubstr("scene 0 \"A\": names node 1, which has a parent"));
}

TEST(GltfNode, SkinsHaveOneMatrixAJoint) {
  GltfBuilder builder = withNodes(R"([{"children":[1]},{},{}])");
  builder.append("skins", R"({"joints":[1,0],"skeleton":0,"name":"Bones"})");
  Scene scene = builder.import();
  EXPECT_THAT(scene.skins[0].joints, ElementsAre(1, 0));
  EXPECT_THAT(scene.skins[0].jointFromBind, ElementsAre(glm::mat4(1), glm::mat4(1)));
  std::vector<float> matrices(32, 0.0f);
  for (std::size_t j = 0; j < 2; ++j)
    matrices[16 * j] = matrices[16 * j + 5] = matrices[16 * j + 10] = matrices[16 * j + 15] = 1.0f;
  matrices[16 + 13] = 7.0f;
  builder.root["skins"][0]["inverseBindMatrices"] = builder.accessor("MAT4", matrices);
  EXPECT_EQ(builder.import().skins[0].jointFromBind[1][3], glm::vec4(0, 7, 0, 1));
  matrices[3] = 1.0f;
  builder.root["skins"][0]["inverseBindMatrices"] = builder.accessor("MAT4", matrices);
  EXPECT_THAT(builder.error(), HasSubstr("skin 0 \"Bones\": inverse bind matrix 0 is not affine"));
  matrices.resize(16);
  builder.root["skins"][0]["inverseBindMatrices"] = builder.accessor("MAT4", matrices);
  EXPECT_THAT(builder.error(), HasSubstr("has 1 inverse bind matrices for 2 joints"));
  builder.root["skins"][0] = json::parse(R"({"joints":[1,2]})");
  EXPECT_THAT(builder.error(), HasSubstr("no common root"));
}

TEST(GltfNode, LightsOfEveryKind) {
  GltfBuilder builder = withNodes(R"([{"extensions":{"KHR_lights_punctual":{"light":2}}},{}])");
  builder.root["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
    {"type":"directional","name":"Sun","color":[1,0.5,0.25],"intensity":3},
    {"type":"point","range":7},
    {"type":"spot","intensity":5,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}},
    {"type":"spot","spot":{}}])");
  const Scene scene = builder.import();
  EXPECT_EQ(scene.nodes[0].light, 2);
  EXPECT_EQ(scene.nodes[1].light, -1);
  EXPECT_EQ(scene.lights[0].kind, LightKind::Sun);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(scene.lights[0].intensity, 3.0f);
  EXPECT_EQ(scene.lights[1].kind, LightKind::Point);
  EXPECT_EQ(scene.lights[1].range, 7.0f);
  EXPECT_EQ(scene.lights[2].kind, LightKind::Spot);
  EXPECT_EQ(scene.lights[2].innerConeRadians, 0.25f);
  EXPECT_EQ(scene.lights[2].outerConeRadians, 0.5f);
  EXPECT_FLOAT_EQ(scene.lights[3].outerConeRadians, std::numbers::pi_v<float> / 4);
  builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 4;
  EXPECT_THAT(builder.error(), HasSubstr("4 does not exist, the file has 4 lights"));
  builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"][2]["spot"]["innerConeAngle"] = 0.5;
  EXPECT_THAT(builder.error(), HasSubstr("light 2: innerConeAngle"));
}

TEST(GltfNode, ExtrasGiveLightsASize) {
  GltfBuilder builder = withNodes(R"([{"extensions":{"KHR_lights_punctual":{"light":2}}}])");
  builder.root["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.root["scenes"] = json::parse(R"([{"nodes":[0]}])");
  json& lights = builder.root["extensions"]["KHR_lights_punctual"]["lights"];
  const json good = json::parse(R"([
    {"type":"directional","extras":{"brickfield":{"angle":2}}},
    {"type":"point","extras":{"brickfield":{"radius":0.25},"other":1}},
    {"type":"spot","name":"Panel","spot":{},"extras":{"brickfield":{"size":[0.5,2]}}}])");
  lights = good;
  const Scene scene = builder.import();
  EXPECT_EQ(scene.lights[0].kind, LightKind::Sun);
  EXPECT_FLOAT_EQ(scene.lights[0].angleRadians, glm::radians(2.0f));
  EXPECT_EQ(scene.lights[1].kind, LightKind::Sphere);
  EXPECT_EQ(scene.lights[1].radius, 0.25f);
  EXPECT_EQ(scene.lights[2].kind, LightKind::Rectangle);
  EXPECT_EQ(scene.lights[2].size, glm::vec2(0.5f, 2));
  const Pose pose = poseScene(scene, {});
  ASSERT_EQ(pose.lights.size(), 1u);
  EXPECT_EQ(pose.lights[0].rightWorld, glm::vec3(1, 0, 0)) << "along the node's X";

  for (const auto& [light, settings, reason] :
       {std::tuple(0, R"({"angle":180})", "is not below 180"), std::tuple(0, R"({"radius":1})", "is not known here"),
        std::tuple(1, R"({"radius":-1})", "out of range"), std::tuple(1, R"({"radius":"wide"})", "not a number"),
        std::tuple(1, R"([1])", "not an object"), std::tuple(2, R"({"size":[1]})", "two numbers"),
        std::tuple(2, R"({"size":[1,-2]})", "out of range")}) {
    lights = good;
    lights[static_cast<std::size_t>(light)]["extras"]["brickfield"] = json::parse(settings);
    EXPECT_THAT(builder.error(), HasSubstr(reason)) << settings;
    EXPECT_THAT(builder.error(), HasSubstr("light " + std::to_string(light))) << settings;
  }
}

TEST(GltfNode, InstancesCombineTranslationRotationScale) {
  GltfBuilder builder = withNodes(R"([{"mesh":0}])");
  builder.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  builder.mesh({{"POSITION", builder.accessor("VEC3", squarePositions())}});
  const int translation = builder.accessor("VEC3", std::vector<float>{1, 2, 3, 0, 0, 0});
  // 23170 / 32767 = sqrt(1/2): a quarter turn about z.
  const int rotation = builder.accessor("VEC4", std::vector<std::int16_t>{0, 0, 23170, 23170, 0, 0, 0, 32767}, true);
  const int scale = builder.accessor("VEC3", std::vector<float>{2, 1, 1, 1, 1, -1});
  auto& extension = builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"];
  extension["attributes"] = {{"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
  const Scene scene = builder.import();
  const auto& instances = scene.nodes[0].nodeFromInstance;
  ASSERT_EQ(instances.size(), 2u);
  const glm::vec3 moved = transformPoint(instances[0], {1, 0, 0}); // scaled to 2x, turned to +y, moved
  EXPECT_NEAR(moved.x, 1.0f, 1e-4f);
  EXPECT_NEAR(moved.y, 4.0f, 1e-4f);
  EXPECT_NEAR(moved.z, 3.0f, 1e-4f);
  EXPECT_LT(mirrorSign(instances[1]), 0.0f);
  extension["attributes"]["SCALE"] = builder.accessor("VEC3", std::vector<float>{1, 1, 1});
  EXPECT_THAT(builder.error(), HasSubstr("node 0: instance SCALE has 1 elements, others have 2"));
}

TEST(GltfNode, CamerasOfBothKinds) {
  GltfBuilder builder;
  builder.root["cameras"] = json::parse(R"([
    {"type":"perspective","name":"P","perspective":{"yfov":1,"znear":0.1,"zfar":10,"aspectRatio":1.5}},
    {"type":"perspective","perspective":{"yfov":1,"znear":0.1}},
    {"type":"orthographic","orthographic":{"xmag":2,"ymag":3,"znear":0,"zfar":5}}])");
  const Scene scene = builder.import();
  EXPECT_EQ(scene.cameras[0].verticalFovRadians, 1.0f);
  EXPECT_EQ(scene.cameras[0].aspect, 1.5f);
  EXPECT_EQ(scene.cameras[0].farDistance, 10.0f);
  EXPECT_FALSE(scene.cameras[1].farDistance.has_value()) << "infinite";
  EXPECT_FALSE(scene.cameras[1].aspect.has_value());
  EXPECT_TRUE(scene.cameras[2].orthographic);
  EXPECT_EQ(scene.cameras[2].halfExtent, glm::vec2(2, 3));
  builder.root["cameras"][2]["orthographic"]["xmag"] = 0;
  EXPECT_THAT(builder.error(), HasSubstr("camera 2: xmag"));
  builder.root["cameras"][0]["perspective"]["zfar"] = 0.1;
  EXPECT_THAT(builder.error(), HasSubstr("camera 0 \"P\": zfar 0.1 is not above znear 0.1"));
}

GltfBuilder withExtras(const char* brickfield) {
  GltfBuilder builder = withNodes(R"([{"name":"Arm","mesh":0}])");
  builder.mesh({{"POSITION", builder.accessor("VEC3", squarePositions())}});
  builder.root["nodes"][0]["extras"] = {{"brickfield", json::parse(brickfield)}, {"other", "ignored"}};
  return builder;
}

TEST(GltfExtras, EverySettingArrives) {
  const SdfSettings all = withExtras(R"({"sdf":true,"resolution":128,"bits":16,"sign":"two-sided","thickness":0.5,
                                         "opacity":0.4,"absorption":[0.2,0.9,0],
                                         "triplanar":0.25})")
                              .import()
                              .nodes[0]
                              .sdf;
  EXPECT_TRUE(all.sdf);
  EXPECT_EQ(all.resolution, 128);
  EXPECT_EQ(all.bits, 16);
  EXPECT_EQ(all.sign, SignMethod::TwoSided);
  EXPECT_EQ(all.thickness, 0.5f);
  EXPECT_EQ(all.opacity, 0.4f);
  EXPECT_EQ(all.absorption, glm::vec3(0.2f, 0.9f, 0));
  EXPECT_EQ(all.triplanar, 0.25f);
  const SdfSettings none = withExtras("{}").import().nodes[0].sdf;
  EXPECT_FALSE(none.sdf);
  EXPECT_FALSE(none.resolution || none.bits || none.sign || none.thickness || none.opacity || none.absorption ||
               none.triplanar);
  const std::array<std::pair<const char*, SignMethod>, 5> signs = {{{"auto", SignMethod::Auto},
                                                                    {"winding", SignMethod::Winding},
                                                                    {"parity", SignMethod::Parity},
                                                                    {"pseudonormal", SignMethod::Pseudonormal},
                                                                    {"two-sided", SignMethod::TwoSided}}};
  for (const auto& [text, method] : signs)
    EXPECT_EQ(withExtras(fmt::format(R"({{"sign":"{}"}})", text).c_str()).import().nodes[0].sdf.sign, method);
}

TEST(GltfExtras, AnythingElseNamesFileNodeAndMember) {
  for (const char* bad : {R"({"sdff":true})",
                          R"({"sdf":1})",
                          R"({"sdf":"true"})",
                          R"({"sdf":null})",
                          R"({"resolution":7})",
                          R"({"resolution":1025})",
                          R"({"resolution":64.5})",
                          R"({"resolution":"64"})",
                          R"({"bits":12})",
                          R"({"bits":32})",
                          R"({"sign":"Auto"})",
                          R"({"sign":3})",
                          R"({"thickness":0})",
                          R"({"thickness":-1})",
                          R"({"thickness":1e300})",
                          R"({"opacity":1.5})",
                          R"({"opacity":-0.1})",
                          R"({"triplanar":0})",
                          R"({"triplanar":-1})",
                          R"({"absorption":1})",
                          R"({"absorption":[1,2]})",
                          R"({"absorption":[1,2,-3]})",
                          R"({"absorption":[1,2,"3"]})"}) {
    const std::string member = json::parse(bad).begin().key();
    EXPECT_THAT(withExtras(bad).error(), HasSubstr("test.glb: node 0 \"Arm\": extras.brickfield." + member)) << bad;
  }
  EXPECT_THAT(withExtras("[]").error(), HasSubstr("node 0 \"Arm\": extras.brickfield is not an object"));
  EXPECT_THAT(withExtras("true").error(), HasSubstr("extras.brickfield is not an object"));
  GltfBuilder bare = withNodes(R"([{"extras":{"brickfield":{"sdf":true}}}])");
  EXPECT_THAT(bare.error(), HasSubstr("node 0: extras.brickfield stands on a node without a mesh"));
}

} // namespace

} // namespace brickfield::test
