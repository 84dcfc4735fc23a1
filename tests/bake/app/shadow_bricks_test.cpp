// Which meshes get bricks for light alone, and how fine.
#include "app/shadow_bricks.h"

#include <gtest/gtest.h>

#include "tests/support/hand_scenes.h"
#include "tests/support/temporary_folder.h"

namespace brickfield::test {
namespace {

// A floor of 4 m, a box of half a metre, another that is an SDF object, and one of the small boxes with a skin.
Scene fourBoxes() {
  Scene scene;
  scene.scenes.push_back({"scene", {0, 1, 2, 3}});
  scene.meshes = {makeBoxMesh({2, 0.1f, 2}), makeBoxMesh(glm::vec3(0.25f)), makeBoxMesh(glm::vec3(0.25f))};
  for (const int mesh : {0, 1, 1, 2}) {
    Node node;
    node.name = "Box";
    node.mesh = mesh;
    scene.nodes.push_back(node);
  }
  scene.nodes[2].translation = {1, 0, 0};
  for (Primitive& primitive : scene.meshes[2].primitives) primitive.morphTargets.resize(1); // shapes that may change
  for (Primitive& primitive : scene.meshes[2].primitives) {
    primitive.morphTargets[0].positions.resize(primitive.positions.size());
  }
  scene.meshes[2].morphWeights = {0};
  return scene;
}

TEST(ShadowBricks, RigidMeshesGetThemByTheirShareOfTheScene) {
  const Scene scene = fourBoxes();
  const Pose pose = poseScene(scene, {});
  SceneFields fields;
  fields.fieldOfNode = {-1, -1, 0, -1};
  fields.fields.resize(1);
  const TemporaryFolder cache;
  const ShadowBrickRequest request{128, std::uint64_t{1} << 30, 0, cache.path()};
  EXPECT_TRUE(addShadowBricks(scene, pose, request, fields, {}).empty());
  EXPECT_EQ(fields.fieldOfNode, (std::vector<int>{-1, -1, 0, -1})) << "drawn as before";
  EXPECT_EQ(fields.lightFieldOfNode[2], -1) << "an SDF object has its own";
  EXPECT_EQ(fields.lightFieldOfNode[3], -1) << "a shape that may change has none";
  ASSERT_GE(fields.lightFieldOfNode[0], 1);
  ASSERT_GE(fields.lightFieldOfNode[1], 1);
  const auto voxelOf = [&](std::size_t node) {
    return fields.fields[static_cast<std::size_t>(fields.lightFieldOfNode[node])].levels.front().voxelSizeObject;
  };
  EXPECT_NEAR(voxelOf(0), 4.0 / 128, 0.05 * 4.0 / 128);
  EXPECT_NEAR(voxelOf(1), 4.0 / 128, 0.05 * 4.0 / 128) << "as fine as the floor's";
}

// A rod as long as its scene.
TEST(ShadowBricks, LongMeshesGetHalfOfTheVoxels) {
  Scene scene;
  scene.scenes.push_back({"scene", {0}});
  scene.meshes = {makeBoxMesh({2, 0.02f, 0.02f})};
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  const Pose pose = poseScene(scene, {});
  for (const auto& [voxels, most] : {std::pair{256, 256}, {1024, 512}, {2048, 1024}, {4096, 1024}}) {
    SceneFields fields;
    addShadowBricks(scene, pose, {voxels, std::uint64_t{1} << 30, 0, {}}, fields, {});
    ASSERT_EQ(fields.fields.size(), 1u);
    EXPECT_NEAR(fields.fields[0].levels.front().voxelSizeObject, 4.0 / most, 0.05 * 4.0 / most) << voxels;
  }
}

} // namespace
} // namespace brickfield::test
