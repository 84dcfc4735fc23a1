// Real animated files posed at several moments: finite, of plausible size, and moving.
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/gltf_import.h"
#include "scene/view.h"
#include "tests/support/data.h"

using namespace brickfield;

namespace {

/// Everything that a frame reads of a pose is finite, unit and within the bounds.
void expectSound(const Scene& scene, const Pose& pose) {
  const Box bounds = pose.boundsWorld.expanded(1e-4f * glm::length(pose.boundsWorld.extent()));
  for (const PosedInstance& instance : pose.instances) {
    ASSERT_TRUE(isFinite(instance.worldFromObject));
    for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
      const DeformedPrimitive deformed = deformPrimitive(primitive, instance);
      ASSERT_EQ(deformed.positions.size(), primitive.positions.size());
      ASSERT_EQ(deformed.tangents.size(), primitive.tangents.size());
      for (std::size_t i = 0; i < deformed.positions.size(); ++i) {
        const glm::vec3 world = transformPoint(instance.worldFromObject, deformed.positions[i]);
        ASSERT_TRUE(bounds.contains(world)) << world.x << " " << world.y << " " << world.z;
        ASSERT_NEAR(glm::length(deformed.normals[i]), 1.0f, 1e-4f);
      }
    }
  }
}

/// Poses a file at some moments; its size must stay within a factor of the rest pose's, and something must move.
void expectMoves(const char* file, float largestFactor) {
  const Scene scene = importGltf(test::dataFile(file));
  const float restSize = glm::length(poseScene(scene, {}).boundsWorld.extent());
  ASSERT_GT(restSize, 0.0f);
  bool moved = false;
  const Pose first = poseScene(scene, {0.0, "all", -1});
  for (const double seconds : {0.0, 0.25, 0.6, 1.1, 1e6}) {
    SCOPED_TRACE(seconds);
    const Pose pose = poseScene(scene, {seconds, "all", -1});
    expectSound(scene, pose);
    const float size = glm::length(pose.boundsWorld.extent());
    EXPECT_GT(size, restSize / largestFactor);
    EXPECT_LT(size, restSize * largestFactor);
    moved = moved || glm::length(pose.boundsWorld.max - first.boundsWorld.max) > 1e-3f * size;
  }
  EXPECT_TRUE(moved);
}

} // namespace

TEST(RealPose, CesiumManWalks) {
  BRICKFIELD_NEEDS_DATA("cesium_man.glb");
  expectMoves("cesium_man.glb", 1.5f);
  const Scene scene = importGltf(test::dataFile("cesium_man.glb"));
  // A man: on the ground, some 1.5 m tall, upright.
  const Box bounds = poseScene(scene, {0.5, "all", -1}).boundsWorld;
  EXPECT_NEAR(bounds.min.y, 0.0f, 0.1f);
  EXPECT_NEAR(bounds.max.y, 1.5f, 0.1f);
  EXPECT_LT(bounds.extent().x, 1.2f);
}

TEST(RealPose, FoxRunsInThreeWays) {
  BRICKFIELD_NEEDS_DATA("fox.glb");
  expectMoves("fox.glb", 1.5f);
  const Scene scene = importGltf(test::dataFile("fox.glb"));
  ASSERT_EQ(scene.animations.size(), 3u);
  const Pose survey = poseScene(scene, {0.3, scene.animations[0].name, -1});
  const Pose run = poseScene(scene, {0.3, scene.animations[2].name, -1});
  EXPECT_NE(survey.boundsWorld.max, run.boundsWorld.max);
  EXPECT_EQ(poseScene(scene, {0.3, "all", -1}).boundsWorld.max, survey.boundsWorld.max) << "the first wins";
}

TEST(RealPose, InterpolationTestUsesEveryKind) {
  BRICKFIELD_NEEDS_DATA("interpolation_test.glb");
  expectMoves("interpolation_test.glb", 1.5f);
}

TEST(RealPose, MorphPrimitivesRiseByTheirWeight) {
  BRICKFIELD_NEEDS_DATA("morph_primitives_test.glb");
  Scene scene = importGltf(test::dataFile("morph_primitives_test.glb"));
  const int node = poseScene(scene, {}).instances.at(0).node;
  std::vector<float>& weights = scene.nodes[static_cast<std::size_t>(node)].morphWeights;
  const auto heightAt = [&](float weight) {
    weights.assign(scene.meshes[0].primitives[0].morphTargets.size(), weight);
    const Pose pose = poseScene(scene, {});
    expectSound(scene, pose);
    return pose.boundsWorld.extent().y;
  };
  EXPECT_EQ(heightAt(0.0f), 0.0f) << "flat at rest";
  const float full = heightAt(1.0f);
  EXPECT_GT(full, 0.01f);
  EXPECT_NEAR(heightAt(0.5f), 0.5f * full, 1e-5f);
}

TEST(RealPose, RecursiveSkeletonsAllStandSomewhereElse) {
  BRICKFIELD_NEEDS_DATA("recursive_skeletons.glb");
  const Scene scene = importGltf(test::dataFile("recursive_skeletons.glb"));
  const Pose pose = poseScene(scene, {});
  EXPECT_EQ(pose.instances.size(), 84u);
  expectSound(scene, pose);
  const View view = makeView(scene, pose, {});
  EXPECT_TRUE(isFinite(view.clipFromWorld));
}

TEST(RealPose, MillionTrianglesHaveTheirMeasuredBounds) {
  BRICKFIELD_NEEDS_DATA("metal_rough_spheres_no_textures.glb");
  const Scene scene = importGltf(test::dataFile("metal_rough_spheres_no_textures.glb"));
  const Pose pose = poseScene(scene, {});
  // Measured with the file's own check: x -0.0009243 to 0.006477, y -0.00101 to 0.006494, z -0.00335 to 0.00035.
  EXPECT_NEAR(pose.boundsWorld.min.x, -0.0009243f, 2e-6f);
  EXPECT_NEAR(pose.boundsWorld.max.y, 0.006494f, 2e-6f);
  EXPECT_NEAR(pose.boundsWorld.min.z, -0.00335f, 2e-6f);
}
