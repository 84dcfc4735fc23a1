// SDF objects and meshes in one world field, against the exact distance to the meshes that the objects were baked from.
#include <algorithm>
#include <cmath>
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

struct Placed {
  const char* name;
  Mesh mesh;
  glm::mat4 worldFromObject;
};

Scene sceneOf(std::vector<Placed> all) {
  Scene scene;
  scene.scenes.push_back({"scene", {}});
  for (Placed& placed : all) {
    Node node;
    node.name = placed.name;
    node.mesh = static_cast<int>(scene.meshes.size());
    node.matrix = placed.worldFromObject;
    scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()));
    scene.nodes.push_back(std::move(node));
    scene.meshes.push_back(std::move(placed.mesh));
  }
  return scene;
}

glm::mat4 place(glm::vec3 at, float scale = 1, float turn = 0, glm::vec3 axis = {1, 2, 0.5f}) {
  return glm::scale(glm::rotate(glm::translate(glm::mat4(1), at), turn, glm::normalize(axis)), glm::vec3(scale));
}

// Objects turned, scaled, overlapping; a box along the axes; two meshes.
Scene makeMixture() {
  return sceneOf({{"SdfTorus", makeTorusMesh(0.6f, 0.22f, 128, 64), place({0, 0, 0}, 1, 0.7f)},
                  {"SdfBox", makeBoxMesh({0.4f, 0.25f, 0.3f}), place({1.1f, 0.3f, 0.2f}, 1.1f, 1.1f, {0, 1, 0.3f})},
                  {"SdfSphere", makeSphereMesh(0.35f, 96, 192), place({1.4f, 0.6f, 0.3f}, 0.9f)},
                  {"SdfBoxAlong", makeBoxMesh({0.3f, 0.1f, 0.5f}), place({-0.2f, -1.1f, 0.2f})},
                  {"Sphere", makeSphereMesh(0.3f, 64, 128), place({-0.9f, 0.8f, 0.1f})},
                  {"Torus", makeTorusMesh(0.4f, 0.1f, 96, 48), place({0.9f, -0.7f, 0}, 1, 1.9f)}});
}

// SDF objects of one mesh.
Scene makeSpheres(float radius, const std::vector<glm::vec3>& centers) {
  Scene scene = sceneOf({{"Sdf0", makeSphereMesh(radius, 48, 96), place(centers[0])}});
  for (std::size_t i = 1; i < centers.size(); ++i) {
    Node node = scene.nodes[0];
    node.name = "Sdf" + std::to_string(i);
    node.matrix = place(centers[i]);
    scene.scenes[0].nodes.push_back(static_cast<int>(i));
    scene.nodes.push_back(node);
  }
  return scene;
}

// In texels, as far as the field knows.
double unionOfSpheres(glm::dvec3 point, const std::vector<glm::vec3>& centers, double radius,
                      const FieldWindow& window) {
  double least = window.rangeTexels();
  for (const glm::vec3& center : centers)
    least = std::min(least, (glm::distance(point, glm::dvec3(center)) - radius) / window.texelSize);
  return least;
}

// The least of the distances to each object and to what the meshes make.
class MixtureOracle {
public:
  explicit MixtureOracle(const TestScene& scene) {
    const std::vector<int>& fieldOfNode = scene.fields().fieldOfNode;
    oracles_.emplace_back(scene.scene(), scene.pose(), fieldOfNode);
    for (std::size_t node = 0; node < fieldOfNode.size(); ++node) {
      if (fieldOfNode[node] < 0) continue;
      std::vector<int> others(fieldOfNode.size(), 0);
      others[node] = -1;
      oracles_.emplace_back(scene.scene(), scene.pose(), others);
    }
  }
  double at(glm::dvec3 pointWorld, double sheetHalfThickness) const {
    double least = std::numeric_limits<double>::infinity();
    // Thin parts are thicker in the field.
    for (const FieldOracle& oracle : oracles_)
      least = std::min(least, oracle.at(pointWorld, 2 * sheetHalfThickness).unionDistance(sheetHalfThickness));
    return least;
  }

private:
  std::vector<FieldOracle> oracles_;
};

// All in texels.
struct MixtureError {
  double rms = 0, p999 = 0, worst = 0; // within four texels of the union's surface
  double farAbove = 0, farBelow = 0;   // beyond, outside: largest value above the truth, and below
  double wrongSigns = 0;               // share of all texels
  double farthestWrongSign = 0;
  double largestStep = 0; // between neighbours, over all texels but deep ones
  std::size_t texels = 0; // within four
};

// Deeper inside than four texels, where no ray goes, does not count.
double largestStep(const FieldSnapshot& field) {
  const auto side = static_cast<std::size_t>(field.window.texels);
  double largest = 0;
  for (const std::size_t stride : {std::size_t{1}, side, side * side})
    for (std::size_t i = 0; i < field.distances.size(); ++i)
      if (i / stride % side + 1 < side && std::min(field.distances[i], field.distances[i + stride]) >= -4)
        largest = std::max(largest, std::abs(double{field.distances[i]} - field.distances[i + stride]));
  return largest;
}

// Over every stride-th texel.
MixtureError errorOf(const FieldSnapshot& field, const MixtureOracle& oracle, std::size_t stride) {
  const double h = field.window.texelSize, range = field.window.rangeTexels();
  std::vector<double> truths(field.distances.size() / stride);
  tbb::parallel_for(std::size_t{0}, truths.size(), [&](std::size_t i) {
    truths[i] = oracle.at(field.centerAnchored(i * stride) + field.anchorWorld, 0.5 * h) / h;
  });
  MixtureError error;
  std::vector<double> near;
  std::size_t wrong = 0;
  double squares = 0;
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const double truth = std::clamp(truths[i], -range, range), value = field.distances[i * stride], off = value - truth;
    if (std::abs(truth) > 1e-3 && (value < 0) != (truth < 0)) {
      ++wrong;
      error.farthestWrongSign = std::max(error.farthestWrongSign, std::abs(truth));
    }
    if (std::abs(truth) <= 4) {
      near.push_back(std::abs(off));
      squares += off * off;
    } else if (truth > 0) { // inside, no ray goes
      error.farAbove = std::max(error.farAbove, off);
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
  error.wrongSigns = static_cast<double>(wrong) / static_cast<double>(truths.size());
  error.largestStep = largestStep(field);
  return error;
}

class SdfObjectsInField : public GlTest {
protected:
  /// texels  of the field, along its side
  static MixtureError measure(const std::string& name, Scene built, int resolution, int texels) {
    const TestScene scene(std::move(built), "Sdf*", resolution);
    WorldFieldStage stage(scene.scene(), scene.fields(), {1, texels, 0, true});
    stage.frame(scene.pose(), glm::dvec3(0));
    const FieldSnapshot field = stage.read();
    const MixtureError e = errorOf(field, MixtureOracle(scene), texels > 32 ? 5 : 1);
    const glm::vec2 voxel = scene.voxelWorld(0) / static_cast<float>(field.window.texelSize);
    std::printf(
        "%-24s voxel %.2f to %.2f texel | near: rms %.4f p99.9 %.4f worst %.3f (%zu texels) | beyond: above %.3f "
        "below %.3f | wrong signs %.4f %% farthest %.3f | largest step %.3f\n",
        name.c_str(), voxel.x, voxel.y, e.rms, e.p999, e.worst, e.texels, e.farAbove, e.farBelow, 100 * e.wrongSigns,
        e.farthestWrongSign, e.largestStep);
    EXPECT_GT(e.texels, 1000u);
    EXPECT_LE(e.farAbove, 0.05) << "a ray would step through";
    return e;
  }
};

// The numbers that the field is to keep, with objects whose voxels are a quarter of a texel. No step shows where the
// bricks end: a distance changes by at most a texel from one to the next, what halves round, and what a search misses.
TEST_F(SdfObjectsInField, AreExactAmongMeshes) {
  const MixtureError error = measure("mixture", makeMixture(), 128, 64);
  EXPECT_LE(error.rms, 0.01);
  EXPECT_LE(error.p999, 0.12);
  EXPECT_LE(error.wrongSigns, 1e-4);
  EXPECT_LE(error.farthestWrongSign, 0.05);
  EXPECT_LE(error.largestStep, 1.2);
}

// Objects a dozen texels across, whose grids of nearest points are fine enough to be believed: most texels outside
// their boxes search for nothing.
TEST_F(SdfObjectsInField, AreExactWhereTheyAreSmall) {
  const MixtureError error = measure("mixture, small", makeMixture(), 128, 32);
  EXPECT_LE(error.rms, 0.01);
  EXPECT_LE(error.p999, 0.12);
  EXPECT_LE(error.wrongSigns, 1e-4);
  EXPECT_LE(error.farthestWrongSign, 0.05);
}

// Voxels as large as texels: what is left are the bricks' own edges, rounded by up to a third of a voxel, and the bulge
// that trilinear voxels cut off, of voxel^2/(6 radius) on average: 0.015 texel of the sphere's 11.
TEST_F(SdfObjectsInField, AreAsExactAsCoarseBricks) {
  const MixtureError error = measure("mixture, coarse bricks", makeMixture(), 32, 64);
  EXPECT_LE(error.rms, 0.035);
  EXPECT_LE(error.p999, 0.25);
  EXPECT_LE(error.farthestWrongSign, 0.33);
}

// Distances in the world are other ones than in the grid, and so are the closest points.
TEST_F(SdfObjectsInField, AreExactUnderUnevenTransforms) {
  const auto measureTorus = [](const std::string& name, const glm::mat4& worldFromObject) {
    return measure(name,
                   sceneOf({{"SdfTorus", makeTorusMesh(0.6f, 0.22f, 128, 64), worldFromObject},
                            {"Sphere", makeSphereMesh(0.3f, 64, 128), place({-1.9f, 0.8f, 0.1f})}}),
                   96, 64);
  };
  const MixtureError mild =
      measureTorus("scaled by 1, 1.5, 0.8", place({}, 1, 0.7f) * glm::scale(glm::mat4(1), glm::vec3(1, 1.5f, 0.8f)));
  EXPECT_LE(mild.rms, 0.01);
  EXPECT_LE(mild.p999, 0.12);
  EXPECT_LE(mild.wrongSigns, 1e-4);
  for (const AffineCase& affine : affineCases()) {
    const MixtureError error = measureTorus(affine.name, affine.worldFromObject);
    // Under a scale of 1, 3, 0.2 what is nearest in the world may lie anywhere in the grid, and the torus is thin.
    const bool isExtreme = affine.name.starts_with("non-uniform");
    EXPECT_LE(error.wrongSigns, isExtreme ? 1e-3 : 1e-4) << affine.name;
    EXPECT_LE(error.farthestWrongSign, isExtreme ? 0.4 : 0.1) << affine.name;
    EXPECT_LE(error.rms, isExtreme ? 0.4 : 0.013) << affine.name;
    EXPECT_LE(error.p999, isExtreme ? 2.5 : 0.17) << affine.name;
  }
}

TEST_F(SdfObjectsInField, RealOnesAreExact) {
  if (!hasData()) return;
  Scene bunny = importGltf(dataFile("stanford_bunny_closed.glb"));
  for (Node& node : bunny.nodes) node.name = "Sdf" + node.name;
  const MixtureError error = measure("bunny", std::move(bunny), 128, 32);
  EXPECT_LE(error.rms, 0.01);
  EXPECT_LE(error.p999, 0.12);
  EXPECT_LE(error.farthestWrongSign, 0.25); // at edges, where it is a matter of taste what lies behind
}

// Tiles that lie wholly inside a mesh, less deep than in the object around both.
TEST_F(SdfObjectsInField, AreDeeperThanMeshesWithinThem) {
  const TestScene scene(sceneOf({{"SdfSphere", makeSphereMesh(1, 64, 128), glm::mat4(1)},
                                 {"Box", makeBoxMesh(glm::vec3(0.3f)), glm::mat4(1)}}),
                        "Sdf*", 48);
  WorldFieldStage stage(scene.scene(), scene.fields(), {1, 64, 0, true});
  stage.frame(scene.pose(), glm::dvec3(0));
  const FieldSnapshot field = stage.read();
  const double h = field.window.texelSize, range = field.window.rangeTexels();
  ASSERT_LT(8 * h, 0.3) << "no tile lies wholly inside the box";
  std::size_t within = 0;
  for (std::size_t i = 0; i < field.distances.size(); ++i) {
    const glm::dvec3 point = glm::abs(field.centerAnchored(i) + field.anchorWorld);
    if (std::max({point.x, point.y, point.z}) > 0.3) continue;
    ++within;
    const double truth = std::max(glm::length(point) - 1, -range * h) / h;
    EXPECT_NEAR(field.distances[i], truth, 0.05);
  }
  EXPECT_GT(within, 4096u);
}

// More objects around each tile than a work group has threads, or lists at a time: the least distance to spheres, in
// closed form.
TEST_F(SdfObjectsInField, AreExactWhereHundredsOverlap) {
  constexpr int kAlong = 9;
  constexpr float kRadius = 0.06f, kApart = 0.05f;
  std::vector<glm::vec3> centers;
  for (int i = 0; i < kAlong * kAlong * kAlong; ++i) {
    // Not quite in rows, so that no two are equally near.
    const glm::vec3 at(i % kAlong, i / kAlong % kAlong, i / (kAlong * kAlong));
    centers.push_back(kApart * (at + 0.3f * glm::sin(glm::vec3(1.7f, 2.9f, 4.1f) * static_cast<float>(i))));
  }
  const TestScene scene(makeSpheres(kRadius, centers), "Sdf*", 32);
  ASSERT_EQ(scene.pose().instances.size(), centers.size());
  WorldFieldStage stage(scene.scene(), scene.fields(), {1, 16, 0, true});
  stage.frame(scene.pose(), glm::dvec3(0));
  const FieldSnapshot field = stage.read();
  const double h = field.window.texelSize;
  ASSERT_LT(h, 0.05) << "all 729 lie within two tiles";
  double squares = 0, worst = 0;
  std::size_t near = 0, wrongSigns = 0;
  for (std::size_t i = 0; i < field.distances.size(); ++i) {
    const glm::dvec3 point = field.centerAnchored(i) + field.anchorWorld;
    const double truth = unionOfSpheres(point, centers, kRadius, field.window);
    if (truth > 4) continue;
    const double off = std::abs(field.distances[i] - truth);
    ++near, squares += off * off, worst = std::max(worst, off);
    wrongSigns += std::abs(truth) > 0.05 && (truth < 0) != (field.distances[i] < 0);
  }
  std::printf("hundreds: near rms %.4f worst %.3f (%zu texels of %.4f m)\n", std::sqrt(squares / double(near)), worst,
              near, h);
  EXPECT_GT(near, 1000u);
  EXPECT_LE(std::sqrt(squares / static_cast<double>(near)), 0.01);
  EXPECT_LE(worst, 0.1);
  EXPECT_EQ(wrongSigns, 0u);
}

// More searches than there is room for: what is stored then is no farther than the truth, and on its side.
TEST_F(SdfObjectsInField, HaveNoHolesWhereSearchesHaveNoRoom) {
  constexpr float kRadius = 1.0f;
  constexpr int kSpheres = 24;
  std::vector<glm::vec3> centers;
  for (int i = 0; i < kSpheres; ++i)
    centers.push_back(0.12f * glm::sin(glm::vec3(1.7f, 2.9f, 4.1f) * static_cast<float>(i)));
  const TestScene scene(makeSpheres(kRadius, centers), "Sdf*", 24);
  WorldFieldStage stage(scene.scene(), scene.fields(), {1, 64, 0, true});
  stage.frame(scene.pose(), glm::dvec3(0));
  const FieldSnapshot field = stage.read();
  std::size_t holes = 0, wrongSides = 0;
  for (std::size_t i = 0; i < field.distances.size(); ++i) {
    const glm::dvec3 point = field.centerAnchored(i) + field.anchorWorld;
    const double truth = unionOfSpheres(point, centers, kRadius, field.window);
    // A texel is half a voxel: bricks are as far off.
    holes += truth > 0 && field.distances[i] > truth + 1;
    wrongSides += std::abs(truth) > 1 && (truth < 0) != (field.distances[i] < 0);
  }
  EXPECT_EQ(holes, 0u);
  EXPECT_EQ(wrongSides, 0u);
}

// Objects that overlap are worked on in an order of their own, and look at their neighbours; still each bit is what it
// would be without a past.
TEST_F(SdfObjectsInField, MoveToTheSameBits) {
  const TestScene scene(makeMixture(), "Sdf*", 48);
  const FieldShape shape{2, 32, 0.1, false};
  WorldFieldStage moving(scene.scene(), scene.fields(), shape);
  for (int frame = 0; frame < 3; ++frame) {
    Pose pose = scene.pose();
    for (const std::size_t moved : {std::size_t{1}, std::size_t{4}})
      pose.instances[moved].worldFromObject[3] += glm::vec4(-0.15f, 0.07f, 0.05f, 0) * static_cast<float>(frame);
    moving.frame(pose, glm::dvec3(0));
    WorldFieldStage fromNothing(scene.scene(), scene.fields(), shape);
    fromNothing.frame(pose, glm::dvec3(0));
    for (std::size_t cascade = 0; cascade < 2; ++cascade)
      EXPECT_EQ(moving.read(cascade), fromNothing.read(cascade)) << "frame " << frame << ", cascade " << cascade;
  }
}

} // namespace
} // namespace brickfield::test
