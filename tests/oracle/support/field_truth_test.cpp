// The oracle of the world field against closed forms.
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/support/field_truth.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

Scene sceneOf(Mesh mesh, const std::vector<glm::mat4>& places) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.scenes.push_back({"scene", {}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = 0;
    scene.nodes.back().matrix = places[i];
    scene.scenes[0].nodes.push_back(static_cast<int>(i));
  }
  return scene;
}

double boxDistance(glm::dvec3 point, glm::dvec3 half) {
  const glm::dvec3 q = glm::abs(point) - half;
  return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

std::vector<glm::dvec3> points(double reach, int count) {
  std::mt19937 engine(17);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  std::vector<glm::dvec3> result;
  for (int i = 0; i < count; ++i) result.emplace_back(uniform(engine), uniform(engine), uniform(engine));
  return result;
}

constexpr glm::vec3 kHalf(1, 0.75f, 0.5f);

TEST(FieldTruthTest, BoxHasTheDistanceOfABox) {
  const Scene scene = sceneOf(makeBoxMesh(kHalf), {glm::mat4(1)});
  const FieldOracle oracle(scene, poseScene(scene, {}));
  EXPECT_EQ(oracle.closedParts(), 1u);
  EXPECT_EQ(oracle.openTriangles(), 0u);
  for (const glm::dvec3& point : points(2, 500)) {
    const FieldTruth truth = oracle.at(point);
    EXPECT_NEAR(truth.unionDistance(0.1), boxDistance(point, kHalf), 1e-12);
    EXPECT_EQ(truth.insideAny, truth.insideClosed);
    EXPECT_EQ(truth.node, 0);
  }
}

TEST(FieldTruthTest, MirroredBoxStaysNegativeInside) {
  const glm::mat4 mirror = glm::scale(glm::translate(glm::mat4(1), {5000, 0, 0}), {-1, 2, 1});
  const Scene scene = sceneOf(makeBoxMesh(kHalf), {mirror});
  const FieldOracle oracle(scene, poseScene(scene, {}));
  for (const glm::dvec3& point : points(2, 500))
    EXPECT_NEAR(oracle.at(point + glm::dvec3(5000, 0, 0)).unionDistance(0.1),
                boxDistance(point, glm::dvec3(kHalf) * glm::dvec3(1, 2, 1)), 1e-12);
}

TEST(FieldTruthTest, InvertedBoxEnclosesWhatIsAround) {
  Mesh mesh = makeBoxMesh(kHalf);
  for (Primitive& primitive : mesh.primitives)
    for (std::size_t i = 0; i < primitive.indices.size(); i += 3)
      std::swap(primitive.indices[i], primitive.indices[i + 1]);
  const Scene scene = sceneOf(std::move(mesh), {glm::mat4(1)});
  const FieldOracle oracle(scene, poseScene(scene, {}));
  for (const glm::dvec3& point : points(2, 200))
    EXPECT_NEAR(oracle.at(point).unionDistance(0.1), -boxDistance(point, kHalf), 1e-12);
}

TEST(FieldTruthTest, OpenBoxIsASheet) {
  Mesh mesh = makeBoxMesh(kHalf);
  mesh.primitives[0].indices.resize(mesh.primitives[0].indices.size() - 3);
  const Scene scene = sceneOf(std::move(mesh), {glm::mat4(1)});
  const FieldOracle oracle(scene, poseScene(scene, {}));
  EXPECT_EQ(oracle.closedParts(), 0u);
  EXPECT_EQ(oracle.openTriangles(), 11u);
  const FieldTruth truth = oracle.at({0, 0, 0});
  EXPECT_FALSE(truth.onClosedComponent());
  EXPECT_NEAR(truth.unionDistance(0.125), 0.5 - 0.125, 1e-12);
}

TEST(FieldTruthTest, PartsThatReachIntoEachOtherSayBoth) {
  const Scene scene = sceneOf(makeBoxMesh(glm::vec3(1)), {glm::mat4(1), glm::scale(glm::mat4(1), glm::vec3(0.25f))});
  const FieldOracle oracle(scene, poseScene(scene, {}));
  const FieldTruth truth = oracle.at({0.375, 0, 0}); // in the large box, outside of the small one, which is nearer
  EXPECT_NEAR(truth.closedDistance, 0.125, 1e-12);
  EXPECT_FALSE(truth.insideClosed);
  EXPECT_TRUE(truth.insideAny);
  EXPECT_EQ(truth.node, 1);
}

// Of a small box in a large one the small one's surface is buried, and the large one's is not.
TEST(FieldTruthTest, BuriedSurfacesAreThoseInsideOnBothSides) {
  const Scene scene = sceneOf(makeBoxMesh(glm::vec3(1)), {glm::mat4(1), glm::scale(glm::mat4(1), glm::vec3(0.25f))});
  const FieldOracle oracle(scene, poseScene(scene, {}));
  const double behind = 0.01;
  EXPECT_TRUE(oracle.seesBuriedSurface({0.375, 0, 0}, 0.2, behind)) << "between both, near the small one";
  EXPECT_FALSE(oracle.seesBuriedSurface({0.375, 0, 0}, 0.1, behind)) << "too far from either";
  EXPECT_TRUE(oracle.seesBuriedSurface({0.1, 0, 0}, 0.2, behind)) << "in both";
  EXPECT_FALSE(oracle.seesBuriedSurface({0.9, 0, 0}, 0.2, behind)) << "near the large one";
  EXPECT_FALSE(oracle.seesBuriedSurface({1.1, 0, 0}, 2.0, behind)) << "outside";
}

TEST(FieldTruthTest, NodesWithFieldsAreLeftOut) {
  const Scene scene = sceneOf(makeBoxMesh(glm::vec3(1)), {glm::mat4(1), glm::translate(glm::mat4(1), {10, 0, 0})});
  const FieldOracle oracle(scene, poseScene(scene, {}), {0, -1});
  EXPECT_NEAR(oracle.at({0, 0, 0}).unionDistance(0), 9, 1e-12);
}

} // namespace
} // namespace brickfield::test
