// The exact world field against the exact distance: errors near surfaces, bounds far from them, signs, updates.
#include <algorithm>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>
#include <tbb/parallel_for.h>

#include "scene/gltf_import.h"
#include "tests/support/data.h"
#include "tests/support/field_truth.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"
#include "tests/support/world_field_stage.h"

namespace brickfield::test {
namespace {

// All in texels.
struct FieldError {
  double rms = 0;             // within four texels of a surface
  double p999 = 0, worst = 0; // of the magnitudes there
  double farAbove = 0;        // beyond and outside: largest value above the truth
  double farBelow = 0, farMean = 0;
  double wrongSigns = 0; // share of the texels that have a sign
  double farthestWrongSign = 0;
  std::size_t overlaps = 0; // texels where closed surfaces reach into each other, and signs differ
  std::size_t texels = 0;
};

// Whether a surface near a point has the inside of closed parts on both of its sides: parts, or folds of one, reach
// into each other, and no nearest surface can tell which side is out. Looks just behind what is nearest, along 26
// directions.
bool isInsideOnBothSides(const FieldOracle& oracle, glm::dvec3 pointWorld, double step) {
  const FieldTruth here = oracle.at(pointWorld);
  if (!here.insideAny) return false;
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;
    const glm::dvec3 direction = glm::normalize(glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
    const FieldTruth behind = oracle.at(pointWorld + direction * (1.1 * here.closedDistance + 0.05 * step));
    if (behind.insideAny && behind.closedDistance < 0.5 * here.closedDistance + 0.05 * step) return true;
  }
  return false;
}

// Over every stride-th texel, of those in a box of the world.
FieldError errorOf(const FieldSnapshot& field, const FieldOracle& oracle, std::size_t stride,
                   const Box& box = {glm::vec3(-INFINITY), glm::vec3(INFINITY)}) {
  const std::size_t count = field.distances.size() / stride;
  const double h = field.window.texelSize, range = field.window.rangeTexels();
  std::vector<FieldTruth> truths(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    truths[i] = oracle.at(field.centerAnchored(i * stride) + field.anchorWorld);
  });
  FieldError error;
  std::vector<double> near;
  double squares = 0, sumFar = 0;
  std::size_t far = 0, signedTexels = 0, wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const FieldTruth& truth = truths[i];
    if (!box.contains(glm::vec3(field.centerAnchored(i * stride) + field.anchorWorld))) continue;
    const double expected = std::clamp(truth.unionDistance(0.5 * h) / h, -range, range);
    const double off = field.distances[i * stride] - expected;
    const double toSurface = truth.unsignedDistance() / h;
    if (truth.onClosedComponent() && toSurface > 1e-3) {
      ++signedTexels;
      if ((field.distances[i * stride] < 0) != truth.insideClosed) {
        if (getenv("V")) {
          auto l = field.latticeOf(i * stride);
          printf("sign %d %d %d truth %.3f got %.3f\n", l.x, l.y, l.z, expected, field.distances[i * stride]);
        }
        if (isInsideOnBothSides(oracle, field.centerAnchored(i * stride) + field.anchorWorld, h)) {
          ++error.overlaps;
          continue;
        }
        ++wrong;
        error.farthestWrongSign = std::max(error.farthestWrongSign, toSurface);
        continue;
      }
    }
    if (toSurface <= 4) {
      near.push_back(std::abs(off));
      squares += off * off;
    } else {
      ++far;
      if (getenv("V") && off > 0.05) {
        auto l = field.latticeOf(i * stride);
        printf("far %d %d %d truth %.3f got %.3f\n", l.x, l.y, l.z, expected, field.distances[i * stride]);
      }
      sumFar += std::abs(off);
      if (expected > 0) error.farAbove = std::max(error.farAbove, off); // inside, no ray goes
      error.farBelow = std::max(error.farBelow, -off);
    }
  }
  std::sort(near.begin(), near.end());
  error.texels = near.size();
  if (!near.empty()) {
    error.rms = std::sqrt(squares / static_cast<double>(near.size()));
    error.p999 = near[static_cast<std::size_t>(0.999 * static_cast<double>(near.size() - 1))];
    error.worst = near.back();
  }
  error.farMean = far ? sumFar / static_cast<double>(far) : 0;
  error.wrongSigns = signedTexels ? static_cast<double>(wrong) / static_cast<double>(signedTexels) : 0;
  return error;
}

void print(const std::string& name, const FieldError& e) {
  std::printf("%-28s near: rms %.4f p99.9 %.4f worst %.3f (%zu texels) | beyond: above %.3f below %.3f mean %.4f | "
              "wrong signs %.4f %% farthest %.2f, in overlaps %zu\n",
              name.c_str(), e.rms, e.p999, e.worst, e.texels, e.farAbove, e.farBelow, e.farMean, 100 * e.wrongSigns,
              e.farthestWrongSign, e.overlaps);
}

class ExactField : public GlTest {
protected:
  static FieldError measure(const std::string& name, const Scene& scene, int texels, double seconds,
                            std::size_t stride) {
    PoseRequest request;
    if (seconds >= 0) request.seconds = seconds;
    const Pose pose = poseScene(scene, request);
    WorldFieldStage stage(scene, {}, {1, texels, 0, true});
    stage.frame(pose, glm::dvec3(0));
    const FieldError error = errorOf(stage.read(), FieldOracle(scene, pose), stride);
    print(name, error);
    return error;
  }
};

// What a texel of the band may err by: the numbers that the field is to keep.
void expectExact(const FieldError& error, double farthestWrongSign = 0.5) {
  EXPECT_GT(error.texels, 1000u);
  EXPECT_LE(error.rms, 0.01);
  EXPECT_LE(error.p999, 0.12);
  EXPECT_LE(error.farAbove, 0.05) << "a ray would step through";
  EXPECT_LE(error.wrongSigns, 1e-4);
  EXPECT_LE(error.farthestWrongSign, farthestWrongSign);
}

TEST_F(ExactField, SphereIsExact) {
  Scene scene = makeTorusAlone();
  scene.meshes[0] = makeSphereMesh(1.0f, 64, 128);
  expectExact(measure("sphere", scene, 64, -1, 1));
}

TEST_F(ExactField, BoxesAndToriThatOverlapAreExact) { expectExact(measure("crowd", makeCrowd(), 128, -1, 7)); }

TEST_F(ExactField, RealMeshesAreExact) {
  if (!hasData()) return;
  for (const char* file : {"torus_5k.glb", "stanford_dragon_11k.glb"})
    expectExact(measure(file, importGltf(dataFile(file)), 128, -1, 7));
  // Its legs are thinner than a texel: a texel in a hundred thousand takes the side of the leg's other face.
  expectExact(measure("scorpion_100k.glb", importGltf(dataFile("scorpion_100k.glb")), 128, -1, 7), 4.0);
}

TEST_F(ExactField, SkinsAreExactAtThreeTimes) {
  if (!hasData()) return;
  for (const char* file : {"fox.glb", "cesium_man.glb"})
    for (const double seconds :
         {0.0, 0.3, 0.9}) // beside folds that reach into each other a texel may ask the wrong one
      expectExact(measure(file, importGltf(dataFile(file)), 64, seconds, 1), 1.0);
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

// A torus of bricks and a sphere of triangles, apart. In the object's box its bricks' values count: 8-bit codes of
// trilinear cells, of coarser levels a few voxels from the surface. Outside of the box all is a lower bound.
TEST_F(ExactField, SdfObjectsJoinMeshes) {
  Scene built = makeInterpenetration();
  built.nodes[1].matrix = glm::translate(glm::mat4(1), glm::vec3(1.6f, 0.2f, 0.1f));
  const TestScene scene(std::move(built), "Torus", 128);
  WorldFieldStage stage(scene.scene(), scene.fields(), {1, 64, 0, true});
  stage.frame(scene.pose(), glm::dvec3(0));
  const FieldSnapshot field = stage.read();
  const FieldOracle oracle(scene.scene(), scene.pose());
  const FieldError inBox =
      errorOf(field, oracle, 1, {glm::vec3(-0.82f, -0.82f, -0.22f), glm::vec3(0.82f, 0.82f, 0.22f)});
  print("in the box of the bricks", inBox);
  EXPECT_LE(inBox.rms, 0.05);
  EXPECT_LE(inBox.p999, 0.3);
  const FieldError error = errorOf(field, oracle, 1);
  print("torus of bricks, sphere", error);
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
