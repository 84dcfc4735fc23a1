// The measure of a field's errors against fields whose errors are known: made by hand around a ball.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bakers/field_accuracy.h"
#include "tests/support/field_truth.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

constexpr glm::dvec3 kAnchor(3, -2, 1);

// Truth by the oracle, texel by texel, changed by what a test does to it.
template <typename Change>
FieldVolume volumeOf(const FieldOracle& oracle, const Change& change) {
  FieldVolume volume{glm::ivec3(-16), glm::ivec3(32), 1.0 / 8, 16, true, {}, {}};
  for (int i = 0; i < 32 * 32 * 32; ++i) {
    const glm::dvec3 point =
        kAnchor + (glm::dvec3(volume.firstTexel + glm::ivec3(i % 32, i / 32 % 32, i / 1024)) + 0.5) / 8.0;
    const double texels = oracle.at(point).unionDistance(0.5 / 8) * 8;
    volume.distances.push_back(static_cast<float>(std::clamp(change(point - kAnchor, texels), -16.0, 16.0)));
  }
  return volume;
}

struct Ball {
  Scene scene;
  Pose pose;
  explicit Ball(bool isOpen = false) : scene(makeTorusAlone()) {
    scene.meshes[0] = makeSphereMesh(1.0f, 24, 48);
    constexpr std::size_t kRings = 3; // a hole of a twenty-sixth of the ball; smaller ones are closed
    auto& indices = scene.meshes[0].primitives[0].indices;
    if (isOpen) indices.resize(indices.size() - kRings * 48 * 6);
    scene.nodes[0].matrix.reset();
    scene.nodes[0].translation = glm::vec3(kAnchor);
    pose = poseScene(scene, {});
  }
};

TEST(FieldAccuracyTest, TheTruthHasNoError) {
  const Ball ball;
  const FieldOracle oracle(ball.scene, ball.pose);
  const auto same = [](glm::dvec3, double texels) { return texels; };
  const FieldAccuracy error =
      measureAccuracy(volumeOf(oracle, same), kAnchor, oracle, SheetMeaning::Thick, std::size_t(-1) / 2);
  EXPECT_LT(error.rms + error.worst + error.farAbove + error.farBelow, 1e-5);
  EXPECT_EQ(error.wrongSigns, 0);
  EXPECT_EQ(error.overlaps, 0u);
  EXPECT_GT(error.signedTexels, 32000u);
  // Spheres of 1.5 and 0.5 m hold what is within four texels.
  EXPECT_NEAR(static_cast<double>(error.texels), 4.0 / 3 * M_PI * (1.5 * 1.5 * 1.5 - 0.5 * 0.5 * 0.5) * 512, 150);
}

TEST(FieldAccuracyTest, ErrorsAreThoseThatWereMade) {
  const Ball ball;
  const FieldOracle oracle(ball.scene, ball.pose);
  const auto off = [](glm::dvec3, double t) { return std::abs(t) <= 4 ? t + (t > 0 ? 0.25 : -0.25) : t + 0.75; };
  const FieldAccuracy error = measureAccuracy(volumeOf(oracle, off), kAnchor, oracle, SheetMeaning::Thick, 1u << 20);
  EXPECT_NEAR(error.rms, 0.25, 1e-4);
  EXPECT_NEAR(error.p999, 0.25, 1e-4);
  EXPECT_NEAR(error.farAbove, 0.75, 1e-4);
  EXPECT_EQ(error.wrongSigns, 0);
  const FieldAccuracy thinned = measureAccuracy(volumeOf(oracle, off), kAnchor, oracle, SheetMeaning::Thick, 4000);
  EXPECT_NEAR(static_cast<double>(thinned.texels), static_cast<double>(error.texels) / 9, 200);
  EXPECT_NEAR(thinned.rms, 0.25, 1e-4);
}

// Inside and outside alike, and however deep: none is excused.
TEST(FieldAccuracyTest, WrongSidesOfAClosedSurfaceAreCounted) {
  const Ball ball;
  const FieldOracle oracle(ball.scene, ball.pose);
  for (const bool inside : {true, false}) {
    std::size_t turned = 0;
    const auto turn = [&](glm::dvec3 point, double texels) {
      const bool isTurned = point.x > 0 && (texels < 0) == inside && std::abs(texels) < 3.9;
      turned += isTurned;
      return isTurned ? -texels : texels;
    };
    const FieldVolume volume = volumeOf(oracle, turn);
    const FieldAccuracy error = measureAccuracy(volume, kAnchor, oracle, SheetMeaning::Thick, 1u << 20);
    ASSERT_GT(turned, 500u);
    EXPECT_NEAR(error.wrongSigns * static_cast<double>(error.signedTexels), static_cast<double>(turned), 0.5);
    EXPECT_GT(error.farthestWrongSign, 3.5);
    EXPECT_EQ(error.overlaps, 0u);
    EXPECT_LT(error.rms, 1e-5) << "of what is on its side";
  }
}

TEST(FieldAccuracyTest, SheetsAreThickOrWithoutSides) {
  const Ball ball(true);
  const FieldOracle oracle(ball.scene, ball.pose);
  const auto same = [](glm::dvec3, double texels) { return texels; };
  const auto unsignedOnes = [](glm::dvec3 point, double texels) { return (point.y > 0 ? -1 : 1) * (texels + 0.5); };
  EXPECT_LT(measureAccuracy(volumeOf(oracle, same), kAnchor, oracle, SheetMeaning::Thick, 1u << 20).rms, 1e-5);
  EXPECT_LT(measureAccuracy(volumeOf(oracle, unsignedOnes), kAnchor, oracle, SheetMeaning::Unsigned, 1u << 20).rms,
            1e-5);
  EXPECT_NEAR(measureAccuracy(volumeOf(oracle, same), kAnchor, oracle, SheetMeaning::Unsigned, 1u << 20).rms, 0.5,
              0.02);
}

// A second ball in the first, closed or open: around its surface a field may say either side, and is not judged. In a
// room, inside of its walls, things are judged all the same.
TEST(FieldAccuracyTest, WhatLiesWithinASolidIsLeftOut) {
  Ball ball;
  ball.scene.nodes.push_back(ball.scene.nodes[0]);
  ball.scene.nodes[1].scale = glm::vec3(0.4f);
  ball.scene.scenes[0].nodes.push_back(1);
  ball.pose = poseScene(ball.scene, {});
  const FieldOracle oracle(ball.scene, ball.pose);
  // Inside of the large one all is inside, though the small one's outside is nearer.
  const auto allInside = [](glm::dvec3 point, double texels) {
    return glm::length(point) < 0.95 ? -std::abs(texels) : texels;
  };
  const FieldAccuracy error =
      measureAccuracy(volumeOf(oracle, allInside), kAnchor, oracle, SheetMeaning::Thick, 1u << 20);
  EXPECT_GT(error.overlaps, 300u);
  EXPECT_EQ(error.wrongSigns, 0);
  EXPECT_LT(error.rms, 1e-5);
  const auto offBeside = [](glm::dvec3 point, double texels) {
    return glm::length(point) > 0.4 && glm::length(point) < 0.6 ? texels + 0.25 : texels;
  };
  EXPECT_GT(measureAccuracy(volumeOf(oracle, offBeside), kAnchor, oracle, SheetMeaning::Thick, 1u << 20).worst, 0.2);
}

TEST(FieldAccuracyTest, SheetsInASolidAreLeftOutAndThoseInARoomAreNot) {
  Ball ball;
  ball.scene.meshes.push_back(makeSphereMesh(0.4f, 24, 48));
  ball.scene.meshes[1].primitives[0].indices.resize(600); // a cap
  ball.scene.nodes.push_back(ball.scene.nodes[0]);
  ball.scene.nodes[1].mesh = 1;
  ball.scene.scenes[0].nodes.push_back(1);
  ball.pose = poseScene(ball.scene, {});
  const FieldOracle oracle(ball.scene, ball.pose);
  const auto same = [](glm::dvec3, double texels) { return texels; };
  const FieldAccuracy inSolid = measureAccuracy(volumeOf(oracle, same), kAnchor, oracle, SheetMeaning::Thick, 1u << 20);
  EXPECT_GT(inSolid.overlaps, 50u);
  std::vector<std::uint32_t>& indices = ball.scene.meshes[0].primitives[0].indices;
  for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]); // walls that face inwards
  const FieldOracle room(ball.scene, ball.pose);
  EXPECT_EQ(measureAccuracy(volumeOf(room, same), kAnchor, room, SheetMeaning::Thick, 1u << 20).overlaps, 0u);
}

TEST(FieldAccuracyTest, OnlyTexelsInTheBoxCount) {
  const Ball ball;
  const FieldOracle oracle(ball.scene, ball.pose);
  const auto offAbove = [](glm::dvec3 point, double texels) { return point.y > 0 ? texels * 1.01 : texels; };
  const Box below{glm::vec3(-10), glm::vec3(10, kAnchor.y, 10)};
  const FieldAccuracy error =
      measureAccuracy(volumeOf(oracle, offAbove), kAnchor, oracle, SheetMeaning::Thick, 1u << 20, below);
  EXPECT_GT(error.texels, 3000u);
  EXPECT_LT(error.rms, 1e-5);
}

} // namespace
} // namespace brickfield::test
