// The gathered triangles of the world against the same triangles placed on the CPU in double, their pseudonormals
// against sums in double, and what is gathered anew against what is gathered from nothing.
#include <cstring>
#include <map>
#include <span>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "core/error.h"
#include "scene/gltf_import.h"
#include "scene/surface_topology.h"
#include "tests/gpu/passes/world_gathering.h"
#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/tube_mesh.h"

namespace brickfield::test {
namespace {

using Corners = std::array<glm::dvec3, 3>;

Pose poseAt(const Scene& scene, double seconds) {
  PoseRequest request;
  request.seconds = seconds;
  return poseScene(scene, request);
}

// Where a mesh's triangles stand, without their topology.
struct PlacedInstance {
  std::vector<Corners> triangles; ///< anchored
  double rounding = 0;            ///< most that the floats of the gathering may be off, metres
  bool isMirrored = false;
};

PlacedInstance placeInstance(const Scene& scene, const PosedInstance& instance, glm::dvec3 anchor) {
  PlacedInstance placed;
  const bool isSkinned = !instance.worldFromBind.empty();
  placed.isMirrored = mirrorSign(instance.worldFromObject) < 0;
  double largest = 0;
  for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
    const std::vector<glm::vec3> positions = deformPrimitive(primitive, instance).positions;
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
      Corners corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec4 object(glm::dvec3(positions[primitive.indices[i + k]]), 1.0);
        const glm::dvec3 world(glm::dmat4(instance.worldFromObject) * object);
        corners[k] = world - anchor;
        largest = std::max({largest, glm::length(corners[k]), isSkinned ? glm::length(world) : 0.0});
        for (int axis = 0; axis < 3; ++axis)
          largest = std::max(largest, glm::length(glm::dvec3(instance.worldFromObject[axis])) * std::abs(object[axis]));
      }
      if (placed.isMirrored) std::swap(corners[1], corners[2]);
      placed.triangles.push_back(corners);
    }
  }
  // A row of the product has four terms and as many roundings; the deforming of the GPU and of the CPU differ by those
  // of eight influences, twice.
  placed.rounding = largest * std::ldexp(isSkinned ? 32.0 : 8.0, -24);
  return placed;
}

class WorldTrianglesTest : public GlTest {
protected:
  static void expectPlaced(const Scene& scene, const Pose& pose, const std::vector<shared::WorldTriangle>& triangles,
                           const WorldTriangles& world) {
    ASSERT_EQ(world.instances().size(), pose.instances.size());
    for (std::size_t i = 0; i < pose.instances.size(); ++i) {
      const InstanceRange& range = world.instances()[i];
      const PlacedInstance expected = placeInstance(scene, pose.instances[i], world.anchorWorld());
      ASSERT_EQ(range.count, expected.triangles.size());
      ASSERT_LE(range.firstTriangle + range.count, triangles.size());
      EXPECT_EQ(range.node, pose.instances[i].node);
      double worst = 0;
      std::size_t outside = 0;
      for (std::size_t t = 0; t < range.count; ++t) {
        const shared::WorldTriangle& triangle = triangles[range.firstTriangle + t];
        ASSERT_EQ(triangle.codes.w >> shared::WORLD_TRIANGLE_NODE_SHIFT, static_cast<std::uint32_t>(range.node));
        if (triangle.codes.w & shared::WORLD_TRIANGLE_EMPTY) continue;
        const std::array<glm::vec3, 3> actual{triangle.a, triangle.b, triangle.c};
        for (std::size_t k = 0; k < 3; ++k) {
          worst = std::max(worst, glm::distance(glm::dvec3(actual[k]), expected.triangles[t][k]));
          outside += range.boundsAnchored.contains(actual[k]) ? 0 : 1;
        }
      }
      EXPECT_LE(worst, expected.rounding) << "instance " << i;
      EXPECT_EQ(outside, 0u) << "instance " << i << ": corners outside its box";
    }
  }
};

TEST_F(WorldTrianglesTest, StandWhereThePosePutsThem) {
  struct File {
    const char* name;
    std::vector<double> seconds;
  };
  for (const File& file : {File{"cesium_man.glb", {0, 0.7, 1.3}}, File{"fox.glb", {0, 0.4, 1.1}},
                           File{"negative_scale_test.glb", {0}}, File{"simple_instancing.glb", {0}},
                           File{"recursive_skeletons.glb", {0.7}}, File{"morph_primitives_test.glb", {0.7}}}) {
    if (!requireData(file.name)) continue;
    SCOPED_TRACE(file.name);
    const Scene scene = importGltf(dataFile(file.name));
    Gathering gathering(scene);
    for (const double seconds : file.seconds) {
      const Pose pose = poseAt(scene, seconds);
      gathering.set(pose, glm::dvec3(pose.boundsWorld.center()) + glm::dvec3(0.25, -0.5, 0.125));
      expectPlaced(scene, pose, gathering.gather(), gathering.world);
    }
  }
}

// What is gathered anew for those that moved is, with all the rest, what a gathering from nothing makes.
TEST_F(WorldTrianglesTest, MovedOnesAloneGiveTheSameBits) {
  for (const char* name : {"cesium_man.glb", "fox.glb", "simple_instancing.glb", "interpolation_test.glb",
                           "morph_primitives_test.glb", "animated_cube.glb"}) {
    if (!requireData(name)) continue;
    SCOPED_TRACE(name);
    const Scene scene = importGltf(dataFile(name));
    Gathering kept(scene);
    const glm::dvec3 anchor(0.5, -0.25, 2);
    bool isFirst = true;
    for (const double seconds : {0.0, 0.3, 0.3, 0.9}) {
      Pose pose = poseAt(scene, seconds);
      // One node of many moves, whatever the animation does.
      pose.instances.back().worldFromObject[3].x += seconds == 0.9 ? 0.125f : 0.0f;
      EXPECT_EQ(kept.set(pose, anchor), isFirst);
      isFirst = false;
      const std::vector<shared::WorldTriangle> updated = kept.gather();
      Gathering anew(scene);
      anew.set(pose, anchor);
      const std::vector<shared::WorldTriangle> expected = anew.gather();
      ASSERT_EQ(updated.size(), expected.size());
      ASSERT_GT(updated.size(), 0u);
      EXPECT_EQ(std::memcmp(updated.data(), expected.data(), updated.size() * sizeof(shared::WorldTriangle)), 0)
          << seconds;
    }
  }
}

// Boxes far apart; node i is mesh i % meshes.
Scene boxScene(const std::vector<glm::mat4>& places) {
  Scene scene;
  scene.meshes = {makeBoxMesh({1, 0.5f, 0.25f}), makeTorusMesh(1, 0.25f, 12, 8)};
  scene.scenes.push_back({"scene", {}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = static_cast<int>(i % scene.meshes.size());
    scene.nodes.back().matrix = places[i];
    scene.scenes[0].nodes.push_back(static_cast<int>(i));
  }
  return scene;
}

glm::mat4 at(glm::vec3 place) { return glm::translate(glm::mat4(1), place); }

TEST_F(WorldTrianglesTest, SaysWhatMovedFromWhereToWhere) {
  const Scene scene = boxScene({at({0, 0, 0}), at({10, 0, 0}), at({20, 0, 0})});
  Gathering gathering(scene);
  Pose pose = poseScene(scene, {});
  EXPECT_TRUE(gathering.set(pose, glm::dvec3(1)));
  ASSERT_EQ(gathering.world.moved().size(), 3u);
  EXPECT_TRUE(gathering.world.moved()[0].boundsBefore.isEmpty());
  gathering.gather();
  EXPECT_TRUE(gathering.world.moved().empty());

  pose.instances[1].worldFromObject = at({10, 5, 0});
  EXPECT_FALSE(gathering.set(pose, glm::dvec3(1)));
  ASSERT_EQ(gathering.world.moved().size(), 1u);
  const MovedInstance moved = gathering.world.moved()[0];
  EXPECT_EQ(moved.instance, 1u);
  EXPECT_NEAR(moved.boundsBefore.center().x, 9, 1e-4);
  EXPECT_NEAR(moved.boundsBefore.center().y, -1, 1e-4);
  EXPECT_NEAR(moved.boundsNow.center().y, 4, 1e-4);
  EXPECT_LE(moved.boundsNow.max.y, gathering.world.boundsAnchored().max.y);

  // A pose back before the frame is recorded: what was listed stays listed.
  pose.instances[1].worldFromObject = at({10, 0, 0});
  EXPECT_FALSE(gathering.set(pose, glm::dvec3(1)));
  EXPECT_EQ(gathering.world.moved().size(), 1u);
  gathering.gather();
  EXPECT_FALSE(gathering.set(pose, glm::dvec3(1)));
  EXPECT_TRUE(gathering.world.moved().empty());

  EXPECT_TRUE(gathering.set(pose, glm::dvec3(2))); // another anchor
  EXPECT_EQ(gathering.world.moved().size(), 3u);
  gathering.gather();
  pose.instances.pop_back(); // another layout
  EXPECT_TRUE(gathering.set(pose, glm::dvec3(2)));
  EXPECT_EQ(gathering.world.triangleCount(), gathering.gather().size());
  EXPECT_EQ(gathering.world.instances().size(), 2u);
}

TEST_F(WorldTrianglesTest, LeavesSdfNodesOut) {
  const Scene scene = boxScene({at({0, 0, 0}), at({10, 0, 0}), at({20, 0, 0})});
  ResidentScene resident(scene, {});
  SceneFields fields;
  fields.fieldOfNode = {-1, 0, -1};
  WorldTriangles world(scene, fields, resident);
  const Pose pose = poseScene(scene, {});
  resident.setPose(scene, pose);
  world.setPose(scene, pose, glm::dvec3(0));
  ASSERT_EQ(world.instances().size(), 2u);
  EXPECT_EQ(world.instances()[1].node, 2);
  EXPECT_EQ(world.triangleCount(), 24u);
}

TEST_F(WorldTrianglesTest, FarFromTheOriginFloatsTellTenthsOfMillimetres) {
  const Scene scene = boxScene({at({16384, 0, -16384})});
  Gathering gathering(scene);
  const Pose pose = poseScene(scene, {});
  gathering.set(pose, {16384, 0.5, -16384.25});
  expectPlaced(scene, pose, gathering.gather(), gathering.world);
}

// The ends of thin tubes are closed by triangles that go where their primitive goes: what is gathered encloses the
// tubes' volume, the morphed one's too, whose vertices lie elsewhere.
TEST_F(WorldTrianglesTest, CapsGoWithTheirPrimitives) {
  constexpr std::uint32_t kSides = 12;
  Scene scene = boxScene({at({3, 1, 2})});
  Mesh& mesh = scene.meshes[0];
  mesh = makeTubeMesh(0.02f, 2, kSides);
  mesh.primitives.push_back(makeTubeMesh(0.03f, 2, kSides).primitives[0]);
  for (glm::vec3& position : mesh.primitives[1].positions) position.x += 1;
  for (Primitive& primitive : mesh.primitives) {
    primitive.morphTargets.emplace_back();
    for (const glm::vec3& position : primitive.positions)
      primitive.morphTargets[0].positions.push_back({0, 0, 0.5f * position.z});
  }
  mesh.morphWeights = {1};
  Gathering gathering(scene);
  gathering.set(poseScene(scene, {}), glm::dvec3(3, 1, 2));
  const auto triangles = gathering.gather();
  EXPECT_EQ(triangles.size(), 2u * (2 * kSides + 2 * (kSides - 2)));
  double volume = 0;
  for (const shared::WorldTriangle& triangle : triangles) {
    EXPECT_TRUE(triangle.codes.w & shared::WORLD_TRIANGLE_CLOSED);
    const glm::dvec3 a(triangle.a), b(triangle.b), c(triangle.c);
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  EXPECT_NEAR(volume, tubeVolume(0.02, 3, kSides) + tubeVolume(0.03, 3, kSides), 1e-5);
}

TEST_F(WorldTrianglesTest, WhatIsNotFiniteIsNoTriangle) {
  const Scene scene = boxScene({at({0, 0, 0}), at({10, 0, 0})});
  Gathering gathering(scene);
  Pose pose = poseScene(scene, {});
  pose.instances[0].worldFromObject[3].y = std::numeric_limits<float>::quiet_NaN();
  pose.instances[1].worldFromObject[0].x = std::numeric_limits<float>::infinity();
  gathering.set(pose, glm::dvec3(0));
  for (const shared::WorldTriangle& triangle : gathering.gather()) {
    EXPECT_TRUE(triangle.codes.w & shared::WORLD_TRIANGLE_EMPTY);
    for (const glm::vec4& corner : {triangle.a, triangle.b, triangle.c}) EXPECT_EQ(glm::vec3(corner), glm::vec3(0));
  }
  EXPECT_TRUE(gathering.world.boundsAnchored().isEmpty());
}

TEST_F(WorldTrianglesTest, FlattenedSolidsAreSheets) {
  const Scene scene = boxScene({glm::scale(glm::mat4(1), {1, 0, 1}), glm::scale(glm::mat4(1), {1, 0.01f, 1})});
  Gathering gathering(scene);
  gathering.set(poseScene(scene, {}), glm::dvec3(0));
  const auto triangles = gathering.gather();
  for (std::size_t t = 0; t < triangles.size(); ++t)
    EXPECT_EQ((triangles[t].codes.w & shared::WORLD_TRIANGLE_CLOSED) != 0, t >= 12) << t;
}

TEST_F(WorldTrianglesTest, NothingToDrawIsFine) {
  Scene scene;
  Gathering gathering(scene);
  EXPECT_TRUE(gathering.set(Pose{}, glm::dvec3(0)));
  EXPECT_TRUE(gathering.set(Pose{}, glm::dvec3(0))); // nobody has recorded the first one
  EXPECT_TRUE(gathering.gather().empty());
  EXPECT_FALSE(gathering.set(Pose{}, glm::dvec3(0)));
}

glm::dvec3 decoded(std::uint32_t code) { return directionFromOctahedral(glm::unpackSnorm2x16(code)); }
glm::dvec3 areaNormal(const shared::WorldTriangle& t) {
  return glm::cross(glm::dvec3(t.b) - glm::dvec3(t.a), glm::dvec3(t.c) - glm::dvec3(t.a));
}

// A sum in double, and how far the floats of the pass may be off: cross products of edges u and v by 8 roundings of
// |u||v|, which against the area is an angle.
struct Sum {
  glm::dvec3 value{0};
  double error = 0;
  void add(glm::dvec3 normal, double weight, double angle) {
    value += weight * normal;
    error += weight * (std::min(angle, 2.0) + 1e-6); // 1e-6: of the weight and of adding up
  }
  // As a direction. Half a step of the code, 1 / 65534, on both axes is up to sqrt(6) of it on the octahedron, whose
  // sides are 1 / sqrt(3) from its centre: 6.5e-5.
  double bound() const { return 6.5e-5 + 2 * error / glm::length(value); }
};

// Sums over the gathered corners; what lies together is found anew by the bits of their positions.
struct ExpectedPseudonormals {
  std::map<std::array<float, 3>, Sum> vertices;
  std::map<std::array<float, 6>, Sum> edges; ///< by both ends, the lesser first

  static std::array<float, 3> key(glm::vec3 p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }
  static std::array<float, 6> key(glm::vec3 p, glm::vec3 q) {
    auto low = key(p), high = key(q);
    if (high < low) std::swap(low, high);
    return {low[0], low[1], low[2], high[0], high[1], high[2]};
  }
  explicit ExpectedPseudonormals(std::span<const shared::WorldTriangle> triangles) {
    for (const shared::WorldTriangle& t : triangles) {
      const std::array<glm::dvec3, 3> p{t.a, t.b, t.c};
      const glm::dvec3 area = areaNormal(t);
      const glm::dvec3 normal = glm::length(area) > 0 ? glm::normalize(area) : glm::dvec3(0);
      std::array<double, 3> lengths{};
      for (std::size_t k = 0; k < 3; ++k) lengths[k] = glm::distance(p[k], p[(k + 1) % 3]);
      std::sort(lengths.begin(), lengths.end());
      const double angle = std::ldexp(8.0, -24) * lengths[0] * lengths[1] / glm::length(area);
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
        vertices[key(p[k])].add(normal, std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)), angle);
        edges[key(p[k], p[(k + 1) % 3])].add(normal, 1, angle);
      }
    }
  }
};

TEST_F(WorldTrianglesTest, PseudonormalsAreTheSumsOfDoubles) {
  for (const char* name : {"torus_5k.glb", "scorpion_100k.glb", "negative_scale_test.glb"}) {
    if (!requireData(name)) continue;
    SCOPED_TRACE(name);
    const Scene scene = importGltf(dataFile(name));
    Gathering gathering(scene);
    const Pose pose = poseAt(scene, 0);
    gathering.set(pose, pose.boundsWorld.center());
    const auto triangles = gathering.gather();
    std::size_t compared = 0, vague = 0;
    for (const InstanceRange& range : gathering.world.instances()) {
      const auto rows = std::span(triangles).subspan(range.firstTriangle, range.count);
      const ExpectedPseudonormals expected(rows);
      for (const shared::WorldTriangle& t : rows) {
        if (!(t.codes.w & shared::WORLD_TRIANGLE_CLOSED)) continue;
        const std::array<glm::vec4, 3> p{t.a, t.b, t.c};
        for (std::size_t k = 0; k < 3; ++k) {
          const Sum& vertex = expected.vertices.at(ExpectedPseudonormals::key(p[k]));
          const Sum& edge = expected.edges.at(ExpectedPseudonormals::key(glm::vec3(p[k]), glm::vec3(p[(k + 1) % 3])));
          for (const auto& [sum, code] :
               {std::pair(vertex, glm::floatBitsToUint(p[k].w)), std::pair(edge, t.codes[static_cast<int>(k)])}) {
            ++compared;
            if ((code & 0xffffu) ==
                shared::WORLD_TRIANGLE_FOLDED) // two normals of which one is nearly the other's back
              EXPECT_LT(glm::length(sum.value), 1.0);
            else if (sum.bound() > 0.01)
              ++vague;
            else
              EXPECT_LE(glm::distance(glm::normalize(sum.value), decoded(code)), sum.bound());
          }
        }
      }
    }
    EXPECT_GT(compared, 1000u);
    EXPECT_LE(vague, compared / 1000) << compared; // slivers, and edges that fold back
  }
}

// Nobody asks on which side of a sheet a point lies; beside it a solid has them.
TEST_F(WorldTrianglesTest, SheetsHaveNoPseudonormals) {
  Scene scene = boxScene({at({0, 0, 0})});
  Primitive sheet = scene.meshes[0].primitives[0];
  sheet.positions = {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}, {3, 0, 1}};
  sheet.normals.assign(4, glm::vec3(0, 0, 1));
  sheet.uvs = {};
  sheet.indices = {0, 1, 2, 1, 0, 3};
  scene.meshes[0].primitives.push_back(sheet);
  for (const float mirror : {1.0f, -1.0f}) {
    scene.nodes[0].matrix = glm::scale(glm::mat4(1), {1, mirror, 1});
    Gathering gathering(scene);
    gathering.set(poseScene(scene, {}), glm::dvec3(0));
    const auto triangles = gathering.gather();
    ASSERT_EQ(triangles.size(), 14u);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const shared::WorldTriangle& t = triangles[i];
      const bool isClosed = i < 12;
      EXPECT_EQ((t.codes.w & shared::WORLD_TRIANGLE_CLOSED) != 0u, isClosed) << i;
      const std::array<std::uint32_t, 6> codes{t.codes.x,
                                               t.codes.y,
                                               t.codes.z,
                                               glm::floatBitsToUint(t.a.w),
                                               glm::floatBitsToUint(t.b.w),
                                               glm::floatBitsToUint(t.c.w)};
      // The code of +Z is zero: that of one edge, the diagonal of a side.
      EXPECT_GE(std::count(codes.begin(), codes.end(), 0u), isClosed ? 0 : 6) << i;
      EXPECT_LE(std::count(codes.begin(), codes.end(), 0u), isClosed ? 1 : 6) << i;
    }
  }
}

TEST_F(WorldTrianglesTest, TooManyTrianglesAreOneClearLine) {
  Scene scene = boxScene({glm::mat4(1)});
  scene.meshes[0] = makeTorusMesh(1, 0.25f, 64, 64); // 2^13 triangles
  scene.nodes[0].nodeFromInstance.assign((std::size_t{WorldTriangles::kMostTriangles} >> 13) + 1, glm::mat4(1));
  Gathering gathering(scene);
  try {
    gathering.set(poseScene(scene, {}), glm::dvec3(0));
    ADD_FAILURE() << "accepted";
  } catch (const Failure& failure) {
    EXPECT_STREQ(failure.what(), "world field: the pose draws more than 2^26 triangles of meshes");
  }
}

} // namespace
} // namespace brickfield::test
