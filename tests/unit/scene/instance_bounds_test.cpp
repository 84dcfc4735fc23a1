// Boxes of posed primitives hold every vertex, and are not much larger than they must be.
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "scene/gltf_import.h"
#include "scene/instance_bounds.h"
#include "tests/support/data.h"

namespace brickfield::test {
namespace {

// Where floats put the vertices: in the middle of the pass's roundings, so a box without any slack would fail.
Box vertexBox(const Primitive& primitive, const PosedInstance& instance, glm::dvec3 anchor) {
  Box box;
  for (const glm::vec3& position : deformPrimitive(primitive, instance).positions) {
    const glm::vec3 anchored(glm::dvec3(glm::dmat4(instance.worldFromObject) * glm::dvec4(glm::dvec3(position), 1.0)) -
                             anchor);
    if (isFinite(anchored)) box.extend(anchored);
  }
  return box;
}

bool holds(const Box& outer, const Box& inner) { return outer.contains(inner.min) && outer.contains(inner.max); }

// A limb of 200 vertices along x with two joints, one target that lifts and one that pulls.
Primitive limb() {
  std::mt19937 engine(9);
  const auto unit = [&] { return static_cast<float>(engine() >> 8) / static_cast<float>(1u << 24); };
  Primitive primitive;
  primitive.influencesPerVertex = 4;
  primitive.morphTargets.resize(2);
  for (int v = 0; v < 200; ++v) {
    const glm::vec3 position(4 * unit(), unit() - 0.5f, unit() - 0.5f);
    primitive.positions.push_back(position);
    primitive.normals.emplace_back(0, 0, 1);
    const float share = glm::clamp(position.x - 1.5f, 0.0f, 1.0f);
    for (const std::uint16_t joint : {0, 1, 0, 0}) primitive.joints.push_back(joint);
    for (const float weight : {1 - share, share, 0.0f, 0.0f}) primitive.jointWeights.push_back(weight);
    primitive.morphTargets[0].positions.emplace_back(0, unit(), 0);
    primitive.morphTargets[1].positions.emplace_back(-unit(), 0, unit());
  }
  return primitive;
}

PosedInstance posed(float angle, float lift, float pull, glm::vec3 place) {
  PosedInstance instance;
  instance.skin = 0;
  instance.morphWeights = {lift, pull};
  const glm::mat4 at = glm::translate(glm::mat4(1), place);
  const glm::mat4 bend = glm::translate(glm::mat4(1), {2, 0, 0}) * glm::rotate(glm::mat4(1), angle, {0, 0, 1}) *
                         glm::translate(glm::mat4(1), {-2, 0, 0});
  instance.worldFromBind = {at, at * bend};
  return instance;
}

TEST(InstanceBoundsTest, SkinnedAndMorphedVerticesLieInside) {
  const Primitive primitive = limb();
  const InstanceBounds bounds(primitive);
  for (const float angle : {0.0f, 0.7f, 1.6f, 3.0f})
    for (const float lift : {0.0f, 1.0f, -2.5f})
      for (const glm::vec3& place : {glm::vec3(0), glm::vec3(10000, 20, -5000)}) {
        const PosedInstance instance = posed(angle, lift, 1 - lift, place);
        const glm::dvec3 anchor = glm::dvec3(place) + glm::dvec3(0.5, 0.25, -1);
        const Box box = bounds.anchored(instance, anchor);
        EXPECT_TRUE(holds(box, vertexBox(primitive, instance, anchor))) << angle << " " << lift << " " << place.x;
      }
}

TEST(InstanceBoundsTest, JointsBoxTheirOwnVerticesAlone) {
  const Primitive primitive = limb();
  const PosedInstance instance = posed(glm::radians(90.0f), 0, 0, glm::vec3(0));
  const Box box = InstanceBounds(primitive).anchored(instance, glm::dvec3(0));
  // The whole limb turned by either joint would reach to x = 4 and, below, to y = -2.
  EXPECT_LT(box.max.x, 2.7f);
  EXPECT_GT(box.min.y, -1.1f);
}

TEST(InstanceBoundsTest, RigidOnesAreBoxesOfBoxes) {
  Primitive primitive = limb();
  primitive.influencesPerVertex = 0;
  primitive.joints.clear();
  primitive.jointWeights.clear();
  PosedInstance instance;
  instance.worldFromObject = glm::rotate(glm::translate(glm::mat4(1), {-7000, 3, 1}), 0.3f, {1, 2, 3});
  const glm::dvec3 anchor(-7001, 0, 0);
  const Box box = InstanceBounds(primitive).anchored(instance, anchor);
  EXPECT_TRUE(holds(box, vertexBox(primitive, instance, anchor)));
  EXPECT_LT(glm::length(box.extent()), 7.0f);
  instance.morphWeights = {3, 0};
  EXPECT_TRUE(holds(InstanceBounds(primitive).anchored(instance, anchor), vertexBox(primitive, instance, anchor)));
}

TEST(InstanceBoundsTest, WeightsThatMissOneCount) {
  Primitive primitive = limb();
  for (float& weight : primitive.jointWeights) weight *= 1.1f;
  const PosedInstance instance = posed(0.5f, 0, 0, glm::vec3(20, 0, 0));
  const Box box = InstanceBounds(primitive).anchored(instance, glm::dvec3(0));
  EXPECT_TRUE(holds(box, vertexBox(primitive, instance, glm::dvec3(0))));
}

TEST(InstanceBoundsTest, WhatIsNotFiniteIsLeftOut) {
  const Primitive primitive = limb();
  PosedInstance instance = posed(0, 0, 0, glm::vec3(0));
  instance.worldFromBind[1][3].x = std::numeric_limits<float>::quiet_NaN();
  const Box box = InstanceBounds(primitive).anchored(instance, glm::dvec3(0));
  EXPECT_TRUE(isFinite(box.min) && isFinite(box.max));
  instance.worldFromBind[0][0].x = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(InstanceBounds(primitive).anchored(instance, glm::dvec3(0)).isEmpty());
  EXPECT_TRUE(InstanceBounds(Primitive{}).anchored(PosedInstance{}, glm::dvec3(0)).isEmpty());
}

TEST(InstanceBoundsTest, RealFilesLieInside) {
  for (const char* name : {"cesium_man.glb", "fox.glb", "recursive_skeletons.glb", "morph_primitives_test.glb"}) {
    if (!requireData(name)) continue;
    const Scene scene = importGltf(dataFile(name));
    for (const double seconds : {0.0, 0.4, 0.9}) {
      PoseRequest request;
      request.seconds = seconds;
      const Pose pose = poseScene(scene, request);
      const glm::dvec3 anchor(pose.boundsWorld.min);
      for (const PosedInstance& instance : pose.instances)
        for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
          const Box box = InstanceBounds(primitive).anchored(instance, anchor);
          const Box vertices = vertexBox(primitive, instance, anchor);
          EXPECT_TRUE(holds(box, vertices)) << name;
          EXPECT_LE(glm::length(box.extent()), 2.0f * glm::length(vertices.extent())) << name;
        }
    }
  }
}

} // namespace
} // namespace brickfield::test
