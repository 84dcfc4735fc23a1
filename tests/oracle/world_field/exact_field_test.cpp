// The exact world field against the exact distance: errors near surfaces, bounds far from them, signs, updates.
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>

#include "bakers/field_accuracy.h"
#include "scene/gltf_import.h"
#include "tests/support/data.h"
#include "tests/support/field_truth.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"
#include "tests/support/world_field_stage.h"

namespace brickfield::test {
namespace {

constexpr std::size_t kMostTexels = 300000; // all of 64^3, a seventh of 128^3
constexpr std::size_t kAllTexels = std::size_t{1} << 30;

FieldAccuracy accuracyOf(const FieldSnapshot& field, const FieldOracle& oracle, std::size_t mostTexels,
                         const Box& box = {glm::vec3(-INFINITY), glm::vec3(INFINITY)}) {
  const FieldVolume volume{field.window.firstTexel,
                           glm::ivec3(field.window.texels),
                           field.window.texelSize,
                           static_cast<float>(field.window.rangeTexels()),
                           field.window.isWhole,
                           field.distances,
                           {}};
  return measureAccuracy(volume, field.anchorWorld, oracle, SheetMeaning::Thick, mostTexels, box);
}

void print(const std::string& name, const FieldAccuracy& e) {
  std::printf("%-28s near: rms %.4f p99.9 %.4f worst %.3f (%zu texels) | beyond: above %.3f below %.3f mean %.4f | "
              "wrong signs %.4f %% farthest %.2f, in overlaps %zu\n",
              name.c_str(), e.rms, e.p999, e.worst, e.texels, e.farAbove, e.farBelow, e.farMean, 100 * e.wrongSigns,
              e.farthestWrongSign, e.overlaps);
}

class ExactField : public GlTest {
protected:
  static FieldAccuracy measure(const std::string& name, const Scene& scene, int texels, double seconds,
                               std::size_t mostTexels = kMostTexels) {
    PoseRequest request;
    if (seconds >= 0) request.seconds = seconds;
    const Pose pose = poseScene(scene, request);
    WorldFieldStage stage(scene, {}, {1, texels, 0, true});
    stage.frame(pose, glm::dvec3(0));
    const FieldAccuracy error = accuracyOf(stage.read(), FieldOracle(scene, pose), mostTexels);
    print(name, error);
    return error;
  }
};

// What a texel of the band may err by: the numbers that the field is to keep.
void expectExact(const FieldAccuracy& error) {
  EXPECT_GT(error.texels, 1000u);
  EXPECT_LE(error.rms, 0.01);
  EXPECT_LE(error.p999, 0.12);
  EXPECT_LE(error.farAbove, 0.05) << "a ray would step through";
  EXPECT_LE(error.wrongSigns, 1e-4);
  EXPECT_LE(error.farthestWrongSign, 0.5);
}

TEST_F(ExactField, SphereIsExact) {
  Scene scene = makeTorusAlone();
  scene.meshes[0] = makeSphereMesh(1.0f, 64, 128);
  expectExact(measure("sphere", scene, 64, -1));
}

TEST_F(ExactField, BoxesAndToriThatOverlapAreExact) { expectExact(measure("crowd", makeCrowd(), 128, -1)); }

TEST_F(ExactField, RealMeshesAreExact) {
  if (!hasData()) return;
  for (const char* file : {"torus_5k.glb", "stanford_dragon_11k.glb"})
    expectExact(measure(file, importGltf(dataFile(file)), 128, -1));
  // Its mesh was thinned out and has flaps without inside, whose edges are nearest to few texels, but to some far away.
  expectExact(measure("scorpion_100k.glb", importGltf(dataFile("scorpion_100k.glb")), 128, -1, kAllTexels));
}

// Thin glass with flowers in it that are sheets: these win ties, so a few texels in the glass count as outside. None in
// the air counts as inside, however far the nearest surface.
TEST_F(ExactField, SignsInTheAirAreRight) {
  if (!hasData()) return;
  const FieldAccuracy error =
      measure("glass_vase_flowers.glb", importGltf(dataFile("glass_vase_flowers.glb")), 128, -1, kAllTexels);
  EXPECT_LE(error.farthestWrongSign, 4.0);
  EXPECT_LE(error.wrongSigns, 4e-4);
}

// Limbs reach into the body, and skin is pinched so that it turns inside out.
TEST_F(ExactField, SkinsAreExactAtThreeTimes) {
  if (!hasData()) return;
  for (const char* file : {"fox.glb", "cesium_man.glb"}) {
    const Scene scene = importGltf(dataFile(file));
    for (const double seconds : {0.0, 0.3, 0.9}) expectExact(measure(file, scene, 64, seconds));
    expectExact(measure(file, scene, 128, 0, kAllTexels));
  }
}

// A sphere circles through a torus; after each frame the field is to the bit what it would be without a past.
TEST_F(ExactField, UpdatesEqualTheFieldMadeFromNothing) {
  const Scene scene = makeInterpenetration();
  const FieldShape shape{2, 64, 0.05, false};
  const auto poseAt = [&](int frame) {
    Pose pose = poseScene(scene, {});
    const float angle = 0.3f * static_cast<float>(frame);
    pose.instances[1].worldFromObject =
        glm::translate(glm::mat4(1), glm::vec3(std::cos(angle), 0.4f * std::sin(2 * angle), std::sin(angle)));
    return pose;
  };
  WorldFieldStage moving(scene, {}, shape);
  for (int frame = 0; frame < 8; ++frame) {
    const glm::dvec3 eye(0.3 * frame, 0.1, -0.45 * frame); // the windows scroll as well
    moving.frame(poseAt(frame), eye);
    if (frame > 0) {
      EXPECT_LT(moving.field().exact().lengthOf(brickfield::ExactField::List::Keys), 2u * 512u) << "all was made anew";
    }
    WorldFieldStage fromNothing(scene, {}, shape);
    fromNothing.frame(poseAt(frame), eye);
    for (std::size_t cascade = 0; cascade < 2; ++cascade) {
      const FieldSnapshot updated = moving.read(cascade), made = fromNothing.read(cascade);
      std::size_t differing = 0;
      for (std::size_t i = 0; i < made.distances.size(); ++i)
        differing += made.distances[i] != updated.distances[i] || made.nodes[i] != updated.nodes[i];
      EXPECT_EQ(differing, 0u) << "frame " << frame << ", cascade " << cascade;
    }
  }
}

// A torus of bricks and a sphere of triangles, apart. More of this in sdf_objects_test.cpp.
TEST_F(ExactField, SdfObjectsJoinMeshes) {
  Scene built = makeInterpenetration();
  built.nodes[1].matrix = glm::translate(glm::mat4(1), glm::vec3(1.6f, 0.2f, 0.1f));
  const TestScene scene(std::move(built), "Torus", 128);
  WorldFieldStage stage(scene.scene(), scene.fields(), {1, 64, 0, true});
  stage.frame(scene.pose(), glm::dvec3(0));
  const FieldSnapshot field = stage.read();
  const FieldOracle oracle(scene.scene(), scene.pose());
  const FieldAccuracy inBox =
      accuracyOf(field, oracle, kMostTexels, {glm::vec3(-0.82f, -0.82f, -0.22f), glm::vec3(0.82f, 0.82f, 0.22f)});
  print("in the box of the bricks", inBox);
  EXPECT_LE(inBox.rms, 0.01);
  EXPECT_LE(inBox.p999, 0.12);
  const FieldAccuracy error = accuracyOf(field, oracle, kMostTexels);
  print("torus of bricks, sphere", error);
  EXPECT_LE(error.rms, 0.01);
  EXPECT_LE(error.p999, 0.12);
  EXPECT_LE(error.wrongSigns, 1e-4);
  EXPECT_LE(error.farAbove, 0.05);
  const auto nodeAt = [&](glm::vec3 point) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < field.nodes.size(); ++i)
      if (glm::distance(field.centerAnchored(i) + field.anchorWorld, glm::dvec3(point)) <
          glm::distance(field.centerAnchored(nearest) + field.anchorWorld, glm::dvec3(point)))
        nearest = i;
    return field.nodes[nearest] & shared::FIELD_NODE_MASK;
  };
  EXPECT_EQ(nodeAt({0.6f, 0, 0}), 1u) << "inside the torus";
  EXPECT_EQ(nodeAt({2.0f, 0.2f, 0.1f}), 2u) << "inside the sphere";
}

// A brick object that moves; the field is to the bit what it would be without a past.
TEST_F(ExactField, UpdatesOfSdfObjectsEqualTheFieldMadeFromNothing) {
  const TestScene scene(makeInterpenetration(), "Sphere", 64);
  const FieldShape shape{2, 64, 0.05, false};
  WorldFieldStage moving(scene.scene(), scene.fields(), shape);
  for (int frame = 0; frame < 4; ++frame) {
    Pose pose = scene.pose();
    pose.instances[1].worldFromObject =
        glm::translate(glm::mat4(1), glm::vec3(0.4f * static_cast<float>(frame), 0.3f, 0));
    moving.frame(pose, glm::dvec3(0));
    WorldFieldStage fromNothing(scene.scene(), scene.fields(), shape);
    fromNothing.frame(pose, glm::dvec3(0));
    for (std::size_t cascade = 0; cascade < 2; ++cascade)
      EXPECT_EQ(moving.read(cascade), fromNothing.read(cascade)) << "frame " << frame << ", cascade " << cascade;
  }
}

// A solid leaves the window by a slope, and far from it a thin wall stands at the other border, which lies beside this
// one in memory: what the wall is is nothing to the slope, nor what it was before it went down.
TEST_F(ExactField, SignsComeFromNoOtherBorder) {
  Scene built = makeInterpenetration();
  built.meshes = {makeBoxMesh(glm::vec3(10)), makeBoxMesh({0.2f, 0.4f, 10})};
  const glm::vec3 slopeNormal = glm::normalize(glm::vec3(-1, 1, 0)), onSlope(1, -1, 0);
  const TestScene scene(std::move(built), "none");
  const auto poseAt = [&](float wallY) {
    Pose pose = scene.pose();
    pose.instances[0].worldFromObject =
        glm::rotate(glm::translate(glm::mat4(1), onSlope - 10.0f * slopeNormal), glm::radians(45.0f), {0, 0, 1});
    pose.instances[1].worldFromObject = glm::translate(glm::mat4(1), {-3, wallY, 0});
    return pose;
  };
  const FieldShape shape{1, 64, 0.1, false};
  const glm::dvec3 eye(0, 0.01, 0);
  WorldFieldStage moving(scene.scene(), scene.fields(), shape);
  for (const float wallY : {1.7f, 0.8f}) {
    moving.frame(poseAt(wallY), eye);
    const FieldSnapshot field = moving.read();
    std::size_t outside = 0, wrong = 0;
    for (std::size_t i = 0; i < field.distances.size(); ++i) {
      const glm::vec3 point(field.centerAnchored(i) + field.anchorWorld);
      const glm::vec3 fromWall = glm::abs(point - glm::vec3(-3, wallY, 0)) - glm::vec3(0.2f, 0.4f, 10);
      if (glm::dot(point - onSlope, slopeNormal) < 0.1f || std::max(fromWall.x, fromWall.y) < 0.1f) continue;
      ++outside, wrong += field.distances[i] < 0;
    }
    EXPECT_GT(outside, 100000u);
    EXPECT_EQ(wrong, 0u) << wallY;
  }
  WorldFieldStage fromNothing(scene.scene(), scene.fields(), shape);
  fromNothing.frame(poseAt(0.8f), eye);
  EXPECT_TRUE(moving.read() == fromNothing.read());
}

// A torus moves in a box so large that nothing reaches most tiles in it, past an SDF sphere that reaches into such
// tiles: their signs come from far away and change with what lies there, and the object joins again.
TEST_F(ExactField, UpdatesWithinALargeSolidEqualTheFieldMadeFromNothing) {
  Scene built = makeInterpenetration(); // nodes Torus, Sphere
  built.meshes.push_back(makeBoxMesh({3, 5, 5}));
  Node box;
  box.name = "Box";
  box.mesh = 2;
  built.scenes[0].nodes.push_back(2);
  built.nodes.push_back(box);
  const TestScene scene(std::move(built), "Sphere", 32);
  const FieldShape shape{1, 128, 0.05, false};
  const auto poseAt = [&](int frame) {
    Pose pose = scene.pose();
    const glm::mat4 third = glm::scale(glm::mat4(1), glm::vec3(0.3f));
    const glm::vec3 at(0.3f, frame == 0 ? -1.5f : 0.0f, -0.5f);
    pose.instances[0].worldFromObject = glm::translate(glm::mat4(1), at) * third;
    pose.instances[1].worldFromObject = glm::translate(glm::mat4(1), glm::vec3(0.3f, 0, 1.2f)) * third;
    return pose;
  };
  WorldFieldStage moving(scene.scene(), scene.fields(), shape);
  for (int frame = 0; frame < 2; ++frame) moving.frame(poseAt(frame), glm::dvec3(0));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  WorldFieldStage fromNothing(scene.scene(), scene.fields(), shape);
  fromNothing.frame(poseAt(1), glm::dvec3(0));
  const FieldSnapshot updated = moving.read(), made = fromNothing.read();
  std::size_t differing = 0;
  for (std::size_t i = 0; i < made.distances.size(); ++i)
    differing += made.distances[i] != updated.distances[i] || made.nodes[i] != updated.nodes[i];
  EXPECT_EQ(differing, 0u);
  EXPECT_GT(moving.field().exact().flips().readValue<std::uint32_t>(12), 0u)
      << "the scene does not show what it is for";
}

TEST_F(ExactField, AStillSceneIsNoWork) {
  const Scene scene = makeInterpenetration();
  WorldFieldStage stage(scene, {}, {2, 64, 0, false});
  stage.frameAt(-1);
  EXPECT_TRUE(stage.field().exact().hasWork());
  stage.frameAt(-1);
  EXPECT_FALSE(stage.field().exact().hasWork());
}

} // namespace
} // namespace brickfield::test
