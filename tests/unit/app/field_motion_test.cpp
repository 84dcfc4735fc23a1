// Scenes and motions of the world field's bench.
#include "app/field_motion.h"

#include <gtest/gtest.h>

#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

TEST(FieldMotionTest, MoverJoinsTheSceneAndCircles) {
  const Scene scene = makeInterpenetration();
  const Scene moving = withMover(scene, poseScene(scene, {}));
  ASSERT_EQ(moving.nodes.size(), scene.nodes.size() + 1);
  EXPECT_EQ(moving.meshes.back().primitives[0].indices.size(), 6000u * 3);
  const Pose rest = poseScene(moving, {});
  ASSERT_EQ(rest.instances.size(), 3u);
  const auto movedBetween = [&](FieldMotion motion, int a, int b) {
    const PoseOfFrame poseOf = motionOf(moving, rest, motion);
    std::vector<bool> moved;
    for (std::size_t i = 0; i < 3; ++i)
      moved.push_back(poseOf(a).instances[i].worldFromObject != poseOf(b).instances[i].worldFromObject);
    return moved;
  };
  EXPECT_EQ(movedBetween(FieldMotion::Nothing, 3, 4), (std::vector{false, false, false}));
  EXPECT_EQ(movedBetween(FieldMotion::Mover, 3, 4), (std::vector{false, false, true}));
  EXPECT_EQ(movedBetween(FieldMotion::Everything, 3, 4), (std::vector{true, true, true}));
  EXPECT_EQ(movedBetween(FieldMotion::Everything, 3, 3 + kFramesOfTurn), (std::vector{false, false, false}));
}

// Boxes of bricks: no more of a field is looked at.
SceneFields boxes(std::vector<Box> bounds, std::vector<int> fieldOfNode) {
  SceneFields fields;
  for (const Box& box : bounds) fields.fields.emplace_back().boundsObject = box;
  fields.fieldOfNode = std::move(fieldOfNode);
  return fields;
}

TEST(FieldMotionTest, CrowdTakesTurnsAndStaysInItsBounds) {
  const MoverCrowd crowd = makeMoverCrowd(
      makeInterpenetration(), boxes({{glm::vec3(0), glm::vec3(4, 1, 2)}, {glm::vec3(-1), glm::vec3(1)}}, {0, 1}), 30);
  ASSERT_EQ(crowd.scene.nodes.size(), 30u);
  EXPECT_NE(crowd.scene.nodes[0].mesh, crowd.scene.nodes[1].mesh);
  EXPECT_EQ(crowd.scene.nodes[0].mesh, crowd.scene.nodes[2].mesh);
  EXPECT_EQ(crowd.fields.fieldOfNode[5], 1);
  const PoseOfFrame poseOf = motionOf(crowd);
  for (int frame = 0; frame < kFramesOfTurn; ++frame) {
    const Pose pose = poseOf(frame), next = poseOf(frame + 1);
    EXPECT_EQ(pose.boundsWorld.min, crowd.boundsWorld.min);
    for (std::size_t i = 0; i < 30; ++i) {
      const Box& box = crowd.fields.fields[i % 2].boundsObject;
      Box placed;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                           corner & 4 ? box.max.z : box.min.z);
        placed.extend(glm::vec3(pose.instances[i].worldFromObject * glm::vec4(at, 1)));
      }
      EXPECT_TRUE(crowd.boundsWorld.contains(placed.min) && crowd.boundsWorld.contains(placed.max)) << i;
      EXPECT_NE(pose.instances[i].worldFromObject, next.instances[i].worldFromObject) << i;
      const glm::vec3 side(pose.instances[i].worldFromObject * glm::vec4(i % 2 ? 2 : 4, 0, 0, 0));
      EXPECT_NEAR(glm::length(side), kMoverSize, 1e-5f) << "the longest one";
    }
  }
}

TEST(FieldMotionTest, CrowdsAreTheSameInEveryRunAndSpread) {
  const auto make = [](int count) {
    return makeMoverCrowd(makeTorusAlone(), boxes({{glm::vec3(-1), glm::vec3(1)}}, {0}), count);
  };
  const MoverCrowd crowd = make(1000);
  EXPECT_EQ(crowd.centers, make(1000).centers);
  const glm::vec3 extent = crowd.boundsWorld.extent();
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(extent[axis], 9 * kMoverSpacing + 2.9f, 0.5f);
  float nearest = 1e9f;
  for (std::size_t i = 0; i < 1000; ++i)
    for (std::size_t k = 0; k < i; ++k) nearest = std::min(nearest, glm::distance(crowd.centers[i], crowd.centers[k]));
  EXPECT_GT(nearest, kMoverSpacing - 2 * kMoverJitter - 1e-5f);
  EXPECT_EQ(make(1).centers.size(), 1u);
}

} // namespace
} // namespace brickfield::test
