// Which mesh a command means.
#include "app/mesh_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace brickfield {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// One mesh on every named node but "Empty"; all are shown but "Hidden".
Scene sceneOf(const std::vector<std::string>& names) {
  Scene scene;
  scene.name = "test.glb";
  scene.meshes.emplace_back();
  scene.scenes.emplace_back();
  for (const std::string& name : names) {
    Node node;
    node.name = name;
    node.mesh = name == "Empty" ? -1 : 0;
    if (name != "Hidden") scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()));
    scene.nodes.push_back(node);
  }
  return scene;
}

std::string choose(const std::vector<std::string>& names, const std::string& node) {
  const Scene scene = sceneOf(names);
  const Pose pose = poseScene(scene, {});
  try {
    return std::to_string(chooseMesh(scene, pose, node).node);
  } catch (const BadInput& error) {
    return error.what();
  }
}

TEST(MeshChoice, WithoutNameTakesTheOnlyOne) { EXPECT_EQ(choose({"Empty", "A"}, ""), "1"); }

TEST(MeshChoice, NamesComeBeforeNumbers) {
  EXPECT_EQ(choose({"A", "B", "C"}, "B"), "1");
  EXPECT_EQ(choose({"A", "B", "C"}, "2"), "2");
  EXPECT_EQ(choose({"A", "B", "0"}, "0"), "2");
}

TEST(MeshChoice, RefusesWhatIsNotClear) {
  EXPECT_THAT(choose({"A", "B"}, ""), AllOf(HasSubstr("--node"), HasSubstr("\"A\""), HasSubstr("\"B\"")));
  EXPECT_THAT(choose({"Empty"}, ""), AllOf(HasSubstr("test.glb"), HasSubstr("no mesh")));
  EXPECT_THAT(choose({"A", "A"}, "A"), HasSubstr("several"));
  EXPECT_THAT(choose({"A"}, "Z"), AllOf(HasSubstr("--node"), HasSubstr("\"Z\"")));
  EXPECT_THAT(choose({"A"}, "7"), HasSubstr("neither name nor number"));
  EXPECT_THAT(choose({"A", "Empty"}, "Empty"), HasSubstr("has no mesh"));
  EXPECT_THAT(choose({"A", "Hidden"}, "Hidden"), HasSubstr("not in the scene that is shown"));
}

} // namespace
} // namespace brickfield
