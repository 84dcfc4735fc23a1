// On which side of closed meshes points lie, by the pseudonormal of the closest feature of the gathered triangles,
// against the winding number.
#include <random>

#include "bakers/mesh_distance.h"
#include "scene/gltf_import.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/gpu/passes/world_gathering.h"
#include "tests/support/data.h"
#include "tests/support/field_truth.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

constexpr double kHalfThickness = 0.0625;

class WorldSignsTest : public GlTest {
protected:
  struct Outcome {
    std::size_t points = 0, wrongSides = 0, inside = 0;
    double worst = 0; ///< of distances whose side is right, metres
  };

  // signedTriangleDistance of the triangle of each point.
  std::vector<float> ask(const std::vector<shared::WorldTriangle>& triangles, const std::vector<glm::dvec3>& points,
                         const std::vector<std::uint32_t>& nearest) {
    std::vector<glm::vec4> inputs;
    for (std::size_t i = 0; i < points.size(); ++i)
      inputs.emplace_back(glm::vec3(points[i]), glm::uintBitsToFloat(nearest[i] + 0x3f800000u)); // no denormal
    const auto program =
        bench_.load("#include \"lib/triangle_distance.glsl\"\n"
                    "layout(std430, binding = 0) readonly buffer RowBlock { WorldTriangle rows[]; };\n",
                    "WorldTriangle t = rows[floatBitsToUint(inputs[index].w) - 0x3f800000u];\n"
                    "outputs[index] = vec4(signedTriangleDistance(t, inputs[index].xyz, 0.0625));");
    const Buffer rows("rows", triangles);
    rows.bindStorage(0);
    std::vector<float> distances;
    for (const glm::vec4& row : ShaderBench::run(*program, inputs, points.size(), 1)) distances.push_back(row.x);
    return distances;
  }

  static TriangleSoup soupOf(const std::vector<shared::WorldTriangle>& triangles) {
    TriangleSoup soup;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const std::array<glm::dvec3, 3> corners{triangles[t].a, triangles[t].b, triangles[t].c};
      if ((triangles[t].codes.w & shared::WORLD_TRIANGLE_EMPTY) ||
          !(glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) > 0))
        continue;
      const auto first = static_cast<std::uint32_t>(soup.positions.size());
      soup.triangles.push_back({first, first + 1, first + 2});
      soup.triangleIndices.push_back(t);
      for (const glm::dvec3& corner : corners) {
        soup.positions.push_back(corner);
        soup.reach = std::max(soup.reach, glm::length(corner));
      }
    }
    return soup;
  }

  // At points within a share of the scene's size from its surface.
  Outcome compare(const Scene& scene, const Pose& pose, double share) {
    Gathering gathering(scene);
    const glm::dvec3 anchor(pose.boundsWorld.center());
    gathering.set(pose, anchor);
    const std::vector<shared::WorldTriangle> triangles = gathering.gather();
    const TriangleSoup soup = soupOf(triangles);
    std::vector<std::uint32_t> all(soup.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    const MeshHierarchy hierarchy(soup, all);
    const MeshDistance distance(hierarchy);
    const FieldOracle oracle(scene, pose);
    const double size = glm::length(pose.boundsWorld.extent());

    std::mt19937 engine(5);
    std::normal_distribution<double> normal(0, share * size);
    std::vector<glm::dvec3> points;
    std::vector<std::uint32_t> nearest;
    std::vector<FieldTruth> truths;
    for (int i = 0; i < 3000; ++i) {
      const std::array<glm::dvec3, 3> corners =
          soup.corners(static_cast<std::uint32_t>(engine() % soup.triangles.size()));
      const glm::dvec3 point(
          glm::vec3(corners[engine() % 3] + glm::dvec3(normal(engine), normal(engine), normal(engine))));
      const FieldTruth truth = oracle.at(point + anchor);
      // Nearer than this floats do not know the side; where parts reach into each other there are two answers.
      if (truth.unsignedDistance() < 1e-5 * size || truth.insideAny != truth.insideClosed) continue;
      points.push_back(point);
      nearest.push_back(soup.triangleIndices[distance.closest(point).triangle]);
      truths.push_back(truth);
    }
    const std::vector<float> actual = ask(triangles, points, nearest);
    Outcome outcome;
    outcome.points = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double expected = truths[i].onClosedComponent()
                                  ? (truths[i].insideClosed ? -1 : 1) * truths[i].closedDistance
                                  : truths[i].openDistance - kHalfThickness;
      outcome.inside += truths[i].insideClosed ? 1 : 0;
      if (truths[i].onClosedComponent() && (expected < 0) != (actual[i] < 0))
        ++outcome.wrongSides;
      else
        outcome.worst = std::max(outcome.worst, std::abs(actual[i] - expected) / size);
    }
    return outcome;
  }

  ShaderBench bench_;
};

TEST_F(WorldSignsTest, ClosestFeaturesTellInsideFromOutside) {
  struct File {
    const char* name;
    double
        wrongShare; // posed skins pass through themselves; on skin that lies buried there the nearest side is no truth
  };
  for (const File& file : {File{"torus_5k.glb", 0}, File{"scorpion_100k.glb", 0}, File{"stanford_bunny_closed.glb", 0},
                           File{"negative_scale_test.glb", 0}, File{"cesium_man.glb", 0.01}}) {
    if (!requireData(file.name)) continue;
    SCOPED_TRACE(file.name);
    const Scene scene = importGltf(dataFile(file.name));
    PoseRequest request;
    request.seconds = 0.7;
    const Pose pose = poseScene(scene, request);
    for (const double share : {0.001, 0.03}) {
      const Outcome outcome = compare(scene, pose, share);
      EXPECT_GT(outcome.points, 1000u);
      EXPECT_GT(outcome.inside, outcome.points / 10);
      EXPECT_LE(static_cast<double>(outcome.wrongSides), file.wrongShare * static_cast<double>(outcome.points));
      // Of the size: corners and points are rounded to float, and the skin by the deforming of GPU and CPU.
      EXPECT_LE(outcome.worst, std::ldexp(16.0, -24));
    }
  }
}

// One face ends in the middle of another's edge, and a triangle without area closes the seam.
TEST_F(WorldSignsTest, SliversPassOnTheNormalsOfTheirNeighbours) {
  Mesh mesh;
  Primitive& primitive = mesh.primitives.emplace_back();
  // Sharp along the edge 0-1, where vertex 4 lies: the faces there are 20 degrees apart.
  primitive.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 0.25f, 1.5f}, {0, -0.25f, 1.5f}, {0.25f, 0, 0}};
  primitive.normals.assign(5, glm::vec3(0, 0, 1));
  primitive.indices = {1, 0, 2, 0, 1, 4, 0, 4, 3, 4, 1, 3, 1, 2, 3, 0, 3, 2};
  Scene scene;
  scene.meshes.push_back(mesh);
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.scenes.push_back({"scene", {0}});
  for (int turn = 0; turn < 8; ++turn) {
    // Turned, the sliver's corners are rounded off their line, to a normal that means nothing.
    const float angle = 0.3f * static_cast<float>(turn / 2);
    scene.nodes[0].rotation = glm::angleAxis(angle, glm::normalize(glm::vec3(1, 2, 3)));
    scene.nodes[0].scale = {1, turn % 2 ? -1 : 1, 1};
    const Pose pose = poseScene(scene, {});
    Gathering gathering(scene);
    gathering.set(pose, glm::dvec3(0));
    const std::vector<shared::WorldTriangle> triangles = gathering.gather();
    const FieldOracle oracle(scene, pose);
    ASSERT_EQ(oracle.closedParts(), 1u);
    std::vector<glm::dvec3> points;
    std::vector<std::uint32_t> numbers;
    std::vector<FieldTruth> truths;
    std::mt19937 engine(2);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    for (int i = 0; i < 500; ++i) {
      const glm::vec3 nearEdge(10 * uniform(engine), uniform(engine), uniform(engine));
      const glm::dvec3 point(transformPoint(pose.worldFromNode[0], nearEdge));
      for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        points.push_back(point), numbers.push_back(t);
        truths.push_back(oracle.at(point));
      }
    }
    const std::vector<float> actual = ask(triangles, points, numbers);
    std::size_t bySliver = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (truths[i].closedDistance < 1e-5 || std::abs(actual[i]) > truths[i].closedDistance + 1e-6) continue;
      EXPECT_EQ(actual[i] < 0, truths[i].insideClosed) << "triangle " << numbers[i];
      bySliver += numbers[i] == 1 ? 1 : 0;
    }
    EXPECT_GT(bySliver, 100u);
  }
}

// A slit along z in the top of a pyramid, covered by a gable over its ridge P-T-Q, `apart` metres wide at its foot.
// With less than nothing its walls have changed places: it is inside out, as pinched skin is.
//
//   P ---- L,R ---- Q    T above L and R
Scene gableScene(float apart) {
  constexpr std::uint32_t kP = 4, kQ = 5, kLeft = 6, kRight = 7, kTop = 8, kBottom = 9;
  Mesh mesh;
  Primitive& primitive = mesh.primitives.emplace_back();
  const float half = 0.5f * apart;
  primitive.positions = {{-1, 0, -1},  {1, 0, -1},    {1, 0, 1},    {-1, 0, 1},    {0, 0, -0.3f},
                         {0, 0, 0.3f}, {-half, 0, 0}, {half, 0, 0}, {0, 0.04f, 0}, {0, -1, 0}};
  primitive.normals.assign(primitive.positions.size(), glm::vec3(0, 1, 0));
  const std::vector<std::array<std::uint32_t, 3>> top = {{0, 3, kLeft},  {0, kLeft, kP},  {3, kQ, kLeft},
                                                         {2, 1, kRight}, {1, kP, kRight}, {2, kRight, kQ},
                                                         {0, kP, 1},     {3, 2, kQ}};
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    primitive.indices.insert(primitive.indices.end(), {a, b, c});
  };
  for (const auto& t : top) {
    add(t[0], t[1], t[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      if (from < kP && to < kP) add(to, from, kBottom);
      if (from >= kP && to >= kP) add(to, from, kTop); // along the slit
    }
  }
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.scenes.push_back({"scene", {0}});
  return scene;
}

// What is nearest to a ridge lies outside, also where the fold is inside out and its normals say the contrary.
TEST_F(WorldSignsTest, FoldsAreAskedForWhatIsAroundThem) {
  for (const float apart : {0.01f, -0.01f})
    for (const float mirror : {1.0f, -1.0f}) {
      SCOPED_TRACE(testing::Message() << apart << " m wide, scaled by " << mirror);
      Scene scene = gableScene(apart);
      scene.nodes[0].scale = {1, 1, mirror};
      const Pose pose = poseScene(scene, {});
      Gathering gathering(scene);
      gathering.set(pose, glm::dvec3(0));
      const std::vector<shared::WorldTriangle> triangles = gathering.gather();
      const FieldOracle oracle(scene, pose);
      ASSERT_EQ(oracle.closedParts(), 1u);
      std::vector<glm::dvec3> points;
      std::vector<std::uint32_t> numbers;
      std::vector<double> expected;
      const glm::dvec3 foot(0, 0, -0.3 * mirror), tip(0, 0.04f, 0),
          above = glm::normalize(glm::dvec3(0, 0.3, -0.04 * mirror));
      for (int i = 1; i < 17; ++i) // right before the tip little but the gable is in sight
        for (const double height : {0.01, 0.1, 1.0}) {
          const glm::dvec3 point = glm::mix(foot, tip, (i + 0.3) / 20.0) + height * above;
          const FieldTruth truth = oracle.at(point);
          ASSERT_FALSE(truth.insideClosed);
          if (truth.closedDistance < height - 1e-6) continue;
          for (std::uint32_t t = 0; t < triangles.size(); ++t)
            points.push_back(point), numbers.push_back(t), expected.push_back(height);
        }
      const std::vector<float> actual = ask(triangles, points, numbers);
      std::size_t asked = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::abs(actual[i]) > expected[i] + 1e-6) continue; // of another triangle
        EXPECT_GT(actual[i], 0) << "triangle " << numbers[i] << ", " << expected[i] << " m above";
        ++asked;
      }
      EXPECT_GT(asked, 80u); // by both faces of the ridge
    }
}

} // namespace
} // namespace brickfield::test
