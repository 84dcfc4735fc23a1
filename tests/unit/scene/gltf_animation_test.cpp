// Animation channels: every path and interpolation, and what may not be.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/scene/gltf_builder.h"

namespace brickfield::test {

namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// One node, one channel.
struct ChannelCase {
  std::string path = "translation";
  std::string interpolation = "LINEAR";
  std::vector<float> times = {0, 1};
  int output = -1; // translation of two keys where it is not given
};

GltfBuilder animated(GltfBuilder builder, const ChannelCase& channel) {
  const int output =
      channel.output >= 0 ? channel.output : builder.accessor("VEC3", std::vector<float>{0, 0, 0, 1, 2, 3});
  const int input = builder.accessor("SCALAR", channel.times);
  if (!builder.root.contains("nodes")) builder.append("nodes", "{}");
  builder.append("animations",
                 json{{"name", "Wave"},
                      {"samplers", {{{"input", input}, {"output", output}, {"interpolation", channel.interpolation}}}},
                      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", channel.path}}}}}}});
  return builder;
}

TEST(GltfAnimation, TranslationLinear) {
  const Scene scene = animated({}, {}).import();
  ASSERT_EQ(scene.animations.size(), 1u);
  EXPECT_EQ(scene.animations[0].name, "Wave");
  const AnimationChannel& channel = scene.animations[0].channels[0];
  EXPECT_EQ(channel.node, 0);
  EXPECT_EQ(channel.property, AnimatedProperty::Translation);
  EXPECT_EQ(channel.interpolation, Interpolation::Linear);
  EXPECT_EQ(channel.components, 3);
  EXPECT_THAT(channel.seconds, ElementsAre(0, 1));
  EXPECT_THAT(channel.values, ElementsAre(0, 0, 0, 1, 2, 3));
}

TEST(GltfAnimation, NormalizedRotationIsMadeUnit) {
  GltfBuilder builder;
  const int output = builder.accessor("VEC4", std::vector<std::int8_t>{0, 0, 90, 90, 0, 0, 0, -128}, true);
  const Scene scene = animated(builder, {"rotation", "STEP", {0.5f, 2}, output}).import();
  const AnimationChannel& channel = scene.animations[0].channels[0];
  EXPECT_EQ(channel.components, 4);
  EXPECT_EQ(channel.interpolation, Interpolation::Step);
  EXPECT_FLOAT_EQ(channel.values[2], std::sqrt(0.5f));
  EXPECT_FLOAT_EQ(channel.values[7], -1.0f);
}

TEST(GltfAnimation, CubicSplineHasThreeValuesAKey) {
  GltfBuilder builder;
  std::vector<float> values(18);
  for (std::size_t i = 0; i < 18; ++i) values[i] = static_cast<float>(i);
  const int output = builder.accessor("VEC3", values);
  const Scene scene = animated(builder, {"scale", "CUBICSPLINE", {0, 1}, output}).import();
  EXPECT_EQ(scene.animations[0].channels[0].property, AnimatedProperty::Scale);
  EXPECT_EQ(scene.animations[0].channels[0].interpolation, Interpolation::CubicSpline);
  EXPECT_EQ(scene.animations[0].channels[0].values, values);
  EXPECT_THAT(animated(builder, {"scale", "CUBICSPLINE", {0, 1, 2}, output}).error(),
              HasSubstr("has 6 values for 3 keys, not 9"));
  const int three = builder.accessor("VEC3", std::vector<float>(9));
  EXPECT_THAT(animated(builder, {"scale", "CUBICSPLINE", {0}, three}).error(), HasSubstr("CUBICSPLINE needs two"));
}

TEST(GltfAnimation, WeightsCountTheMorphTargets) {
  GltfBuilder builder;
  const int position = builder.accessor("VEC3", squarePositions());
  builder.mesh({{"POSITION", position}}, {{"targets", {{{"POSITION", position}}, {{"POSITION", position}}}}});
  builder.append("nodes", R"({"mesh":0})");
  const int output = builder.accessor("SCALAR", std::vector<std::uint8_t>{0, 51, 255, 102}, true);
  const Scene scene = animated(builder, {"weights", "LINEAR", {0, 1}, output}).import();
  const AnimationChannel& channel = scene.animations[0].channels[0];
  EXPECT_EQ(channel.components, 2);
  EXPECT_FLOAT_EQ(channel.values[1], 0.2f);
  EXPECT_FLOAT_EQ(channel.values[3], 0.4f);
  EXPECT_THAT(animated(builder, {"weights", "LINEAR", {0, 1, 2}, output}).error(),
              HasSubstr("has 4 values for 3 keys, not 6"));
  EXPECT_THAT(animated({}, {"weights", "LINEAR", {0, 1}, -1}).error(), HasSubstr("node 0, which has no morph targets"));
}

TEST(GltfAnimation, TimesMustIncreaseFromZero) {
  const std::string element = "animation 0 \"Wave\" channel 0: ";
  EXPECT_THAT(animated({}, {"translation", "LINEAR", {1, 1}, -1}).error(),
              HasSubstr(element + "key 1 at 1 s is not after key 0"));
  EXPECT_THAT(animated({}, {"translation", "LINEAR", {1, 0.5f}, -1}).error(), HasSubstr("is not after"));
  EXPECT_THAT(animated({}, {"translation", "LINEAR", {-1, 0}, -1}).error(), HasSubstr("before 0"));
  EXPECT_THAT(animated({}, {"translation", "LINEAR", {0, NAN}, -1}).error(),
              HasSubstr("accessor 1: element 1 holds nan"));
  EXPECT_THAT(animated({}, {"translation", "LINEAR", {0, 1, 2}, -1}).error(),
              HasSubstr("has 2 values for 3 keys, not 3"));
}

TEST(GltfAnimation, TargetsThatCannotMove) {
  GltfBuilder twice = animated({}, {});
  twice.root["animations"][0]["channels"].push_back(twice.root["animations"][0]["channels"][0]);
  EXPECT_THAT(twice.error(), HasSubstr("channel 1: moves the translation of node 0, as another channel does"));
  GltfBuilder fixed;
  fixed.append("nodes", R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]})");
  EXPECT_THAT(animated(fixed, {}).error(), HasSubstr("node 0, which has a matrix"));
  GltfBuilder sampler = animated({}, {});
  sampler.root["animations"][0]["channels"][0]["sampler"] = 1;
  EXPECT_THAT(sampler.error(), HasSubstr("sampler 1 does not exist"));
  GltfBuilder zero;
  const int output = zero.accessor("VEC4", std::vector<float>(8));
  EXPECT_THAT(animated(zero, {"rotation", "LINEAR", {0, 1}, output}).error(), HasSubstr("key 0 is no quaternion"));
  GltfBuilder unknown = animated({}, {"pointer", "LINEAR", {0, 1}, -1});
  EXPECT_TRUE(unknown.import().animations[0].channels.empty());
}

} // namespace

} // namespace brickfield::test
