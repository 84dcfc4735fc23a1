// Hierarchies, animations, instances, skins, lights and bounds against values worked out by hand.
#include "scene/pose.h"

#include <array>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/animation.h"

using namespace brickfield;

namespace {

void expectNear(glm::vec3 actual, glm::vec3 expected, float tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

Primitive trianglePrimitive() {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.normals.assign(3, {0, 0, 1});
  primitive.indices = {0, 1, 2};
  return primitive;
}

/// nodeCount nodes in a chain, the last one with a triangle.
Scene chainScene(int nodeCount) {
  Scene scene;
  scene.name = "chain.glb";
  scene.meshes.push_back({"triangle", {trianglePrimitive()}, {}});
  scene.nodes.resize(static_cast<std::size_t>(nodeCount));
  for (int i = 1; i < nodeCount; ++i) {
    scene.nodes[static_cast<std::size_t>(i)].parent = i - 1;
    scene.nodes[static_cast<std::size_t>(i - 1)].children = {i};
  }
  scene.nodes.back().mesh = 0;
  scene.scenes.push_back({"main", {0}});
  return scene;
}

AnimationChannel channelOf(AnimatedProperty property, Interpolation interpolation, int components,
                           std::vector<float> seconds, std::vector<float> values) {
  AnimationChannel channel;
  channel.node = 0;
  channel.property = property;
  channel.interpolation = interpolation;
  channel.components = components;
  channel.seconds = std::move(seconds);
  channel.values = std::move(values);
  return channel;
}

glm::vec3 sampleVector(const AnimationChannel& channel, double seconds) {
  std::array<float, 3> value{};
  sampleChannel(channel, seconds, value);
  return {value[0], value[1], value[2]};
}

/// Turned about Y by an angle in degrees, as x, y, z, w.
std::array<float, 4> turnAboutY(float degrees) {
  const float half = 0.5f * glm::radians(degrees);
  return {0.0f, std::sin(half), 0.0f, std::cos(half)};
}

float angleAboutY(const AnimationChannel& channel, double seconds) {
  std::array<float, 4> q{};
  sampleChannel(channel, seconds, q);
  const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  EXPECT_NEAR(length, 1.0f, 1e-6f);
  return glm::degrees(2.0f * std::atan2(q[1], q[3]));
}

} // namespace

TEST(Pose, ChainsMultiplyFromTheRoot) {
  Scene scene = chainScene(3);
  scene.nodes[0].translation = {10, 0, 0};
  scene.nodes[1].rotation = glm::angleAxis(std::numbers::pi_v<float> / 2, glm::vec3(0, 0, 1));
  scene.nodes[2].scale = {2, 3, 1};
  const Pose pose = poseScene(scene, {});
  ASSERT_EQ(pose.instances.size(), 1u);
  // (1,1,0) scaled: (2,3,0); turned by 90 degrees: (-3,2,0); moved: (7,2,0).
  expectNear(transformPoint(pose.instances[0].worldFromObject, {1, 1, 0}), {7, 2, 0}, 1e-5f);
  expectNear(pose.boundsWorld.min, {7, 0, 0}, 1e-5f);
  expectNear(pose.boundsWorld.max, {10, 2, 0}, 1e-5f);
}

TEST(Pose, DeepChainNeedsNoCallStack) {
  Scene scene = chainScene(300000);
  for (Node& node : scene.nodes) node.translation = {0, 0, 0.5f};
  const Pose pose = poseScene(scene, {});
  EXPECT_EQ(pose.worldFromNode.back()[3].z, 150000.0f);
}

TEST(Pose, MatrixStandsInsteadOfTheParts) {
  Scene scene = chainScene(1);
  scene.nodes[0].matrix = glm::mat4(2.0f);
  (*scene.nodes[0].matrix)[3] = {1, 2, 3, 1};
  scene.nodes[0].translation = {100, 100, 100};
  expectNear(transformPoint(poseScene(scene, {}).worldFromNode[0], {1, 1, 1}), {3, 4, 5}, 1e-6f);
}

TEST(Pose, OnlyReachedNodesAreShown) {
  Scene scene = chainScene(1);
  Node other;
  other.mesh = 0;
  other.translation = {5, 0, 0};
  scene.nodes.push_back(other);
  scene.scenes.push_back({"second", {1, 0}});
  EXPECT_EQ(poseScene(scene, {}).instances.size(), 1u);
  EXPECT_EQ(poseScene(scene, {}).worldFromNode[1], glm::mat4(1.0f));
  const Pose second = poseScene(scene, {std::nullopt, "all", 1});
  ASSERT_EQ(second.instances.size(), 2u);
  EXPECT_EQ(second.instances[0].node, 1) << "roots in the order of the scene";
  scene.defaultScene = -1;
  EXPECT_TRUE(poseScene(scene, {}).instances.empty());
  EXPECT_TRUE(poseScene(scene, {}).boundsWorld.isEmpty());
}

TEST(Pose, UnknownSceneAndAnimationAreNamed) {
  Scene scene = chainScene(1);
  scene.animations.push_back({"walk", {}});
  EXPECT_THROW(poseScene(scene, {std::nullopt, "all", 7}), BadInput);
  EXPECT_THROW(poseScene(scene, {std::nullopt, "all", -2}), BadInput);
  try {
    poseScene(scene, {0.0, "fly", -1});
    FAIL() << "an unknown animation must not pass";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("chain.glb"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("fly"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(poseScene(scene, {0.0, "walk", -1}));
  EXPECT_NO_THROW(poseScene(scene, {0.0, "0", -1}));
  EXPECT_THROW(poseScene(scene, {0.0, "1", -1}), BadInput);
}

TEST(Pose, OverflowingTransformNamesTheNode) {
  Scene scene = chainScene(3);
  scene.nodes[1].name = "Arm";
  for (Node& node : scene.nodes) node.scale = glm::vec3(1e20f);
  try {
    poseScene(scene, {});
    FAIL() << "1e40 is not finite in single precision";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("\"Arm\""), std::string::npos) << error.what();
  }
}

TEST(Pose, OverflowingGeometryNamesTheNode) {
  Scene scene = chainScene(1);
  scene.meshes[0].primitives[0].positions[1].x = 1e30f;
  scene.nodes[0].scale = glm::vec3(1e10f);
  EXPECT_THROW(poseScene(scene, {}), BadInput);
}

TEST(Animation, StepHoldsUntilTheNextKey) {
  const AnimationChannel channel =
      channelOf(AnimatedProperty::Translation, Interpolation::Step, 3, {1, 2, 4}, {1, 0, 0, 2, 0, 0, 3, 0, 0});
  EXPECT_EQ(sampleVector(channel, 0.0).x, 1);
  EXPECT_EQ(sampleVector(channel, 1.999).x, 1);
  EXPECT_EQ(sampleVector(channel, 2.0).x, 2);
  EXPECT_EQ(sampleVector(channel, 99.0).x, 3);
}

TEST(Animation, LinearIsALineBetweenKeysAndClampedOutside) {
  const AnimationChannel channel =
      channelOf(AnimatedProperty::Scale, Interpolation::Linear, 3, {1, 3}, {0, 1, 2, 4, 1, -2});
  expectNear(sampleVector(channel, 1.5), {1, 1, 1}, 1e-6f);
  expectNear(sampleVector(channel, -5.0), {0, 1, 2}, 0.0f);
  expectNear(sampleVector(channel, 5.0), {4, 1, -2}, 0.0f);
}

TEST(Animation, RotationsTurnAtConstantSpeedTheShortWay) {
  const auto from = turnAboutY(10), to = turnAboutY(130);
  AnimationChannel channel = channelOf(AnimatedProperty::Rotation, Interpolation::Linear, 4, {0, 3},
                                       {from[0], from[1], from[2], from[3], to[0], to[1], to[2], to[3]});
  EXPECT_NEAR(angleAboutY(channel, 1.0), 50.0f, 1e-3f);
  EXPECT_NEAR(angleAboutY(channel, 2.0), 90.0f, 1e-3f);
  for (std::size_t i = 4; i < 8; ++i) channel.values[i] = -channel.values[i]; // the same rotation, on the far side
  EXPECT_NEAR(angleAboutY(channel, 1.0), 50.0f, 1e-3f);
}

TEST(Animation, CubicSplineIsTheHermiteOfItsTangents) {
  // x(s) = s³ on [1, 3]: tangents 3 and 27 a second, reproduced exactly by a cubic.
  const AnimationChannel channel = channelOf(AnimatedProperty::Translation, Interpolation::CubicSpline, 3, {1, 3},
                                             {9, 9, 9, 1, 0, 0, 3, 0, 0, 27, 0, 0, 27, 0, 0, 9, 9, 9});
  for (const double s : {1.0, 1.3, 2.0, 2.9, 3.0})
    expectNear(sampleVector(channel, s), {static_cast<float>(s * s * s), 0, 0}, 1e-5f);
  expectNear(sampleVector(channel, 0.0), {1, 0, 0}, 0.0f);
}

TEST(Animation, CubicRotationsComeOutUnit) {
  const auto from = turnAboutY(0), to = turnAboutY(90);
  std::vector<float> values;
  for (const auto& q : {from, to}) {
    values.insert(values.end(), 4, 0.0f);
    values.insert(values.end(), q.begin(), q.end());
    values.insert(values.end(), 4, 0.0f);
  }
  const AnimationChannel channel = channelOf(AnimatedProperty::Rotation, Interpolation::CubicSpline, 4, {0, 2}, values);
  EXPECT_NEAR(angleAboutY(channel, 1.0), 45.0f, 1e-3f) << "half way, by symmetry";
}

TEST(Animation, FirstOfTwoWins) {
  Scene scene = chainScene(1);
  const auto constantAt = [](float x) {
    return channelOf(AnimatedProperty::Translation, Interpolation::Linear, 3, {0}, {x, 0, 0});
  };
  scene.animations.push_back({"first", {constantAt(1)}});
  scene.animations.push_back(
      {"second", {constantAt(2), channelOf(AnimatedProperty::Scale, Interpolation::Linear, 3, {0}, {7, 7, 7})}});
  const glm::mat4 all = poseScene(scene, {0.0, "all", -1}).worldFromNode[0];
  EXPECT_EQ(all[3].x, 1.0f);
  EXPECT_EQ(all[0].x, 7.0f) << "what only the second moves is the second's";
  EXPECT_EQ(poseScene(scene, {0.0, "second", -1}).worldFromNode[0][3].x, 2.0f);
  EXPECT_EQ(poseScene(scene, {std::nullopt, "all", -1}).worldFromNode[0][3].x, 0.0f) << "without a time: the rest pose";
}

TEST(Pose, MorphWeightsComeFromAnimationNodeOrMesh) {
  Scene scene = chainScene(1);
  scene.meshes[0].primitives[0].morphTargets.push_back({{{0, 0, 5}, {0, 0, 5}, {0, 0, 5}}, {}, {}});
  scene.meshes[0].morphWeights = {0.25f};
  EXPECT_EQ(poseScene(scene, {}).instances[0].morphWeights, std::vector<float>{0.25f});
  EXPECT_EQ(poseScene(scene, {}).boundsWorld.max.z, 1.25f);
  scene.nodes[0].morphWeights = {0.5f};
  EXPECT_EQ(poseScene(scene, {}).instances[0].morphWeights, std::vector<float>{0.5f});
  scene.animations.push_back(
      {"", {channelOf(AnimatedProperty::MorphWeights, Interpolation::Linear, 1, {0, 1}, {0, 2})}});
  EXPECT_EQ(poseScene(scene, {0.5, "all", -1}).instances[0].morphWeights, std::vector<float>{1.0f});
  EXPECT_EQ(poseScene(scene, {0.5, "all", -1}).boundsWorld.max.z, 5.0f);
}

TEST(Pose, GpuInstancesStandBesideEachOther) {
  Scene scene = chainScene(1);
  scene.nodes[0].scale = glm::vec3(2);
  for (const float x : {1.0f, 3.0f}) {
    glm::mat4 nodeFromInstance(1.0f);
    nodeFromInstance[3].x = x;
    scene.nodes[0].nodeFromInstance.push_back(nodeFromInstance);
  }
  const Pose pose = poseScene(scene, {});
  ASSERT_EQ(pose.instances.size(), 2u);
  EXPECT_EQ(pose.instances[1].instance, 1);
  EXPECT_EQ(pose.instances[0].worldFromObject[3].x, 2.0f);
  EXPECT_EQ(pose.instances[1].worldFromObject[3].x, 6.0f);
  EXPECT_EQ(pose.boundsWorld.max.x, 8.0f);
}

TEST(Pose, SkinnedInstancesFollowJointsNotTheirNode) {
  Scene scene = chainScene(1);
  Primitive& primitive = scene.meshes[0].primitives[0];
  primitive.influencesPerVertex = 4;
  primitive.joints.assign(12, 0);
  primitive.jointWeights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  Node joint;
  joint.translation = {0, 10, 0};
  scene.nodes.push_back(joint);
  scene.scenes[0].nodes = {0, 1};
  scene.nodes[0].translation = {100, 0, 0};
  scene.nodes[0].skin = 0;
  glm::mat4 jointFromBind(1.0f);
  jointFromBind[3].y = -3;
  scene.skins.push_back({"", {1}, {jointFromBind}});
  const Pose pose = poseScene(scene, {});
  ASSERT_EQ(pose.instances.size(), 1u);
  EXPECT_EQ(pose.instances[0].worldFromObject, glm::mat4(1.0f));
  ASSERT_EQ(pose.instances[0].worldFromBind.size(), 1u);
  EXPECT_EQ(pose.instances[0].worldFromBind[0][3].y, 7.0f);
  expectNear(pose.boundsWorld.min, {0, 7, 0}, 0.0f);
  expectNear(pose.boundsWorld.max, {1, 8, 0}, 0.0f);
}

TEST(Pose, LightsShineAlongTheirNodeWhateverItsScale) {
  Scene scene = chainScene(2);
  scene.nodes[0].scale = {3, 0.1f, 5};
  scene.nodes[1].rotation = glm::angleAxis(std::numbers::pi_v<float> / 2, glm::vec3(0, 1, 0));
  scene.nodes[1].translation = {1, 1, 1};
  scene.nodes[1].light = 0;
  scene.lights.emplace_back();
  const Pose pose = poseScene(scene, {});
  ASSERT_EQ(pose.lights.size(), 1u);
  EXPECT_EQ(pose.lights[0].node, 1);
  expectNear(pose.lights[0].directionWorld, {-1, 0, 0}, 1e-6f);
  expectNear(pose.lights[0].positionWorld, {3, 0.1f, 5}, 1e-6f);
}

TEST(Pose, CamerasAreCountedDepthFirst) {
  // 0 -> (1 -> 2), 3; cameras on 3, 2 and 1.
  Scene scene;
  scene.nodes.resize(4);
  scene.nodes[0].children = {1, 3};
  scene.nodes[1].children = {2};
  for (const int node : {1, 2, 3}) scene.nodes[static_cast<std::size_t>(node)].camera = 0;
  scene.cameras.emplace_back();
  scene.scenes.push_back({"", {0}});
  EXPECT_EQ(poseScene(scene, {}).cameraNodes, (std::vector<int>{1, 2, 3}));
}

TEST(Scene, LabelsNameNumberAndName) {
  Scene scene = chainScene(2);
  scene.nodes[1].name = "Arm";
  EXPECT_EQ(nodeLabel(scene, 0), "node 0");
  EXPECT_EQ(nodeLabel(scene, 1), "node 1 \"Arm\"");
  EXPECT_EQ(nodeLabel(scene, 9), "node 9");
  EXPECT_EQ(materialOf(scene, scene.meshes[0].primitives[0]).baseColor, glm::vec4(1.0f));
}
