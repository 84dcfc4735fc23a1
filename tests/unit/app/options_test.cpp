// Flags that commands share: parsing, and how node extras and flags meet.
#include "app/options.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace brickfield {
namespace {

using test::refusalOf;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A mesh on nodes "Dragon Head" (extras: SDF of 64 voxels), "Dragon Tail", "Floor"; "Root" has none.
Scene dragonScene() {
  Scene scene;
  scene.meshes.emplace_back();
  for (const char* name : {"Root", "Dragon Head", "Dragon Tail", "Floor"}) {
    Node node;
    node.name = name;
    node.mesh = scene.nodes.empty() ? -1 : 0;
    scene.nodes.push_back(node);
  }
  scene.nodes[1].sdf.sdf = true;
  scene.nodes[1].sdf.resolution = 64;
  scene.nodes[1].sdf.bits = 16;
  return scene;
}

std::vector<int> numbersOf(const std::vector<std::optional<BakeSettings>>& nodes) {
  std::vector<int> numbers;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i]) numbers.push_back(static_cast<int>(i));
  return numbers;
}

TEST(SdfNodes, WithoutFlagFollowTheExtras) {
  const auto nodes = sdfNodes(dragonScene(), {}, 3);
  EXPECT_THAT(numbersOf(nodes), ElementsAre(1));
  EXPECT_EQ(nodes[1]->resolution, 64);
  EXPECT_EQ(nodes[1]->bits, 16);
  EXPECT_EQ(nodes[1]->threads, 3);
}

TEST(SdfNodes, FollowPatternsInsteadOfExtras) {
  EXPECT_THAT(numbersOf(sdfNodes(dragonScene(), {{"Dragon*"}, {}}, 0)), ElementsAre(1, 2));
  EXPECT_THAT(numbersOf(sdfNodes(dragonScene(), {{"Floor"}, {}}, 0)), ElementsAre(3));
  EXPECT_THAT(numbersOf(sdfNodes(dragonScene(), {{"Floor", "*Tai?"}, {}}, 0)), ElementsAre(2, 3));
  EXPECT_THAT(numbersOf(sdfNodes(dragonScene(), {{"all"}, {}}, 0)), ElementsAre(1, 2, 3));
  EXPECT_THAT(numbersOf(sdfNodes(dragonScene(), {{"none"}, {}}, 0)), ElementsAre());
}

TEST(SdfNodes, GivenResolutionWinsOverExtrasAndDefault) {
  const auto kept = sdfNodes(dragonScene(), {{"Dragon*"}, {}}, 0);
  EXPECT_EQ(kept[1]->resolution, 64);
  EXPECT_EQ(kept[2]->resolution, BakeSettings{}.resolution);
  const auto given = sdfNodes(dragonScene(), {{"Dragon*"}, 32}, 0);
  EXPECT_EQ(given[1]->resolution, 32);
  EXPECT_EQ(given[1]->bits, 16);
  EXPECT_EQ(given[2]->resolution, 32);
}

TEST(SdfNodes, TexturesThatAreProjectedTakeThePlaceOfAttributes) {
  Scene scene = dragonScene();
  scene.nodes[1].sdf.triplanar = 0.5f;
  SdfRequest request{{"Dragon*"}, {}};
  EXPECT_FALSE(sdfNodes(scene, request, 0)[1]->attributes);
  EXPECT_TRUE(sdfNodes(scene, request, 0)[2]->attributes);
  EXPECT_THAT(triplanarNodes(scene, request), ElementsAre(0, 0.5f, 0, 0));
  request.triplanarMetres = 2.0f;
  EXPECT_FALSE(sdfNodes(scene, request, 0)[2]->attributes);
  EXPECT_THAT(triplanarNodes(scene, request), ElementsAre(2, 2, 2, 2));
}

TEST(SdfNodes, PatternWithoutMatchNamesFlagPatternAndNodes) {
  const std::string message = refusalOf([] { sdfNodes(dragonScene(), {{"Dragon*", "Cat*"}, {}}, 0); });
  EXPECT_THAT(message, AllOf(HasSubstr("--sdf"), HasSubstr("Cat*"), HasSubstr("Dragon Head"), HasSubstr("Floor")));
  EXPECT_THAT(refusalOf([] { sdfNodes(dragonScene(), {{"Root"}, {}}, 0); }), HasSubstr("no node with a mesh"));
  EXPECT_THAT(refusalOf([] { sdfNodes(dragonScene(), {{"all", "Floor"}, {}}, 0); }), HasSubstr("stands alone"));
  EXPECT_THAT(refusalOf([] { sdfNodes(dragonScene(), {{""}, {}}, 0); }), HasSubstr("empty pattern"));
}

struct Parsed {
  SceneRequest scene;
  CameraRequest camera;
  LightRequest light;
  BrdfModel brdf = BrdfModel::CookTorrance;
  float exposureEv = 0;
};

Parsed parse(std::vector<std::string> arguments) {
  Parsed parsed;
  CLI::App app;
  addSceneOptions(app, parsed.scene);
  addCameraOptions(app, parsed.camera);
  addLightOptions(app, parsed.light);
  addBrdfOption(app, parsed.brdf);
  addExposureOption(app, parsed.exposureEv);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
  return parsed;
}

TEST(SharedOptions, FillTheirRequests) {
  const Parsed parsed = parse({"--sdf",
                               "A*,B",
                               "--sdf",
                               "C[ab]",
                               "scene.glb",
                               "--size",
                               "64x32",
                               "--camera",
                               "2",
                               "--eye",
                               "-1,-2,-3",
                               "--target",
                               "0,0,0",
                               "--fov",
                               "40",
                               "--time",
                               "-0.5",
                               "--animation",
                               "Walk",
                               "--resolution",
                               "99",
                               "--triplanar",
                               "0.25",
                               "--cache",
                               "bricks",
                               "--threads",
                               "4",
                               "--seed",
                               "7",
                               "--light",
                               "sun:0,-1,0:0.5:3",
                               "--light",
                               "sphere:1,2,3:0.1:5",
                               "--environment",
                               "sky.hdr",
                               "--brdf",
                               "blinn-phong",
                               "--exposure",
                               "-1.5"});
  EXPECT_EQ(parsed.scene.path, "scene.glb");
  EXPECT_THAT(parsed.scene.sdf.patterns, ElementsAre("A*", "B", "C[ab]"));
  EXPECT_EQ(parsed.scene.sdf.resolution, 99);
  EXPECT_EQ(parsed.scene.sdf.triplanarMetres, 0.25f);
  EXPECT_EQ(parsed.scene.pose.seconds, -0.5);
  EXPECT_EQ(parsed.scene.pose.animation, "Walk");
  EXPECT_EQ(parsed.scene.cacheFolder, "bricks");
  EXPECT_EQ(parsed.scene.threads, 4);
  EXPECT_EQ(parsed.scene.seed, 7u);
  EXPECT_EQ(parsed.camera.sizePixels, glm::uvec2(64, 32));
  EXPECT_EQ(parsed.camera.camera, "2");
  EXPECT_EQ(parsed.camera.eye, glm::vec3(-1, -2, -3));
  EXPECT_EQ(parsed.camera.target, glm::vec3(0));
  EXPECT_EQ(parsed.camera.verticalFovDegrees, 40.0f);
  EXPECT_THAT(parsed.light.texts, ElementsAre("sun:0,-1,0:0.5:3", "sphere:1,2,3:0.1:5"));
  EXPECT_EQ(parsed.light.environment, "sky.hdr");
  EXPECT_EQ(parsed.brdf, BrdfModel::BlinnPhong);
  EXPECT_EQ(parsed.exposureEv, -1.5f);
}

TEST(SharedOptions, AreOptional) {
  const Parsed parsed = parse({"scene.glb"});
  EXPECT_FALSE(parsed.scene.pose.seconds);
  EXPECT_TRUE(parsed.scene.sdf.patterns.empty());
  EXPECT_FALSE(parsed.scene.cacheFolder);
  EXPECT_FALSE(parsed.scene.sdf.triplanarMetres);
  EXPECT_THAT(refusalOf([] { parse({"scene.glb", "--triplanar", "0"}); }), HasSubstr("--triplanar: 0: is not above 0"));
  EXPECT_EQ(parsed.camera.sizePixels, glm::uvec2(1280, 720));
  EXPECT_TRUE(parsed.light.texts.empty());
  EXPECT_EQ(parsed.brdf, BrdfModel::CookTorrance);
  EXPECT_EQ(parse({"scene.glb", "--brdf", "cook-torrance"}).brdf, BrdfModel::CookTorrance);
  EXPECT_THAT(refusalOf([] {
                parse({"scene.glb", "--brdf", "phong"});
              }),
              AllOf(HasSubstr("--brdf: "), HasSubstr("phong"), HasSubstr("blinn-phong")));
}

TEST(CheckCamera, WantsEyeAndTargetTogether) {
  CameraRequest request;
  checkCamera(request);
  request.eye = glm::vec3(1);
  EXPECT_THAT(refusalOf([&] { checkCamera(request); }), HasSubstr("--eye: needs --target"));
  request.target = glm::vec3(1);
  EXPECT_THAT(refusalOf([&] { checkCamera(request); }), HasSubstr("same point"));
  request.target = glm::vec3(2);
  checkCamera(request);
  request.eye.reset();
  EXPECT_THAT(refusalOf([&] { checkCamera(request); }), HasSubstr("--target: needs --eye"));
}

TEST(CheckOutputs, RefusesTwoFlagsWithOneFile) {
  const test::TemporaryFolder folder;
  const auto picture = folder / "a.exr";
  checkOutputs({{"-o", picture, {".exr"}}, {"--layers", folder / "b.exr", {".exr"}}, {"--stats", {}, {".json"}}}, {});
  EXPECT_THAT(refusalOf([&] {
                checkOutputs({{"-o", picture, {".exr"}}, {"--layers", picture, {".exr"}}}, {});
              }),
              AllOf(HasSubstr("a.exr"), HasSubstr("--layers"), HasSubstr("-o")));
}

TEST(CheckOutputs, RefusesAFileThatIsRead) {
  const test::TemporaryFolder folder;
  const auto picture = folder / "a.exr";
  EXPECT_THAT(refusalOf([&] {
                checkOutputs({{"-o", picture, {".exr"}}}, {{}, picture});
              }),
              AllOf(HasSubstr("a.exr"), HasSubstr("-o"), HasSubstr("read")));
}

TEST(ParseSign, KnowsEveryMethod) {
  EXPECT_EQ(parseSign("--sign", "two-sided"), SignMethod::TwoSided);
  EXPECT_EQ(parseSign("--sign", "pseudonormal"), SignMethod::Pseudonormal);
  EXPECT_THAT(refusalOf([] { parseSign("--sign", "guess"); }), AllOf(HasSubstr("--sign"), HasSubstr("guess")));
}

} // namespace
} // namespace brickfield
