// Rays on the GPU against Embree: files, poses, moved instances, and the cases that break hierarchies.
#include "resident/scene_hierarchy.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "core/error.h"
#include "passes/world_field/hierarchy_refit_pass.h"
#include "scene/gltf_import.h"
#include "tests/gpu/passes/shader_bench.h"
#include "tests/gpu/passes/world_gathering.h"
#include "tests/support/data.h"
#include "tests/support/embree_rays.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/posed_triangles.h"

namespace brickfield::test {
namespace {

struct Ray {
  glm::vec3 origin, direction;
};

struct GpuHit {
  float distance = 0;
  std::uint32_t triangle = 0;
  bool isFront = false;
};

std::vector<Ray> randomRays(const Box& bounds, std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const glm::vec3 reach = 0.7f * bounds.extent() + 0.05f * glm::length(bounds.extent());
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const glm::vec3 direction(unit(random), unit(random), unit(random));
    const float length = glm::length(direction);
    if (length > 1 || length < 0.01f) continue;
    rays.push_back({bounds.center() + reach * glm::vec3(unit(random), unit(random), unit(random)), direction / length});
  }
  return rays;
}

class HierarchyRays : public GlTest {
protected:
  std::vector<GpuHit> trace(const TriangleHierarchy& hierarchy, const Buffer& triangles, const std::vector<Ray>& rays) {
    const auto program = bench_.load("#include \"lib/triangle_hierarchy.glsl\"\n", R"(
  RayHit hit = traceHierarchy(inputs[index * 2u].xyz, inputs[index * 2u + 1u].xyz, kInfinity);
  outputs[index] = vec4(hit.distance, uintBitsToFloat(hit.triangle), hit.isFront ? 1.0 : 0.0, 0.0);)");
    std::vector<glm::vec4> inputs;
    for (const Ray& ray : rays) inputs.emplace_back(ray.origin, 0), inputs.emplace_back(ray.direction, 0);
    hierarchy.bind(*program, triangles);
    std::vector<GpuHit> hits;
    for (const glm::vec4& row : ShaderBench::run(*program, inputs, rays.size(), 1))
      hits.push_back({row.x, glm::floatBitsToUint(row.y), row.z != 0});
    return hits;
  }

  // Embree may disagree on rays within rounding of an edge at a silhouette, which one takes and the other leaves: one
  // in ten thousand would be many. Which of two triangles at one distance is hit is the order's choice: here the lower
  // number's, with Embree any.
  void expectEmbree(const PosedTriangles& scene, const TriangleHierarchy& hierarchy, const Buffer& triangles,
                    const std::string& name, double leastHits = 0.1) {
    const EmbreeRays oracle(scene.rows);
    const std::vector<Ray> rays = randomRays(scene.bounds, 20000, 1);
    const std::vector<GpuHit> hits = trace(hierarchy, triangles, rays);
    const double size = glm::length(scene.bounds.extent());
    std::size_t met = 0, otherDistance = 0, otherSide = 0, ties = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const OracleHit expected = oracle.trace(rays[i].origin, rays[i].direction);
      if (std::isinf(expected.distance) != std::isinf(hits[i].distance)) {
        ++otherDistance;
        continue;
      }
      if (std::isinf(expected.distance)) continue;
      ++met;
      // Floats of the scene's size, some ten operations deep, along rays that may graze.
      if (std::abs(double{expected.distance} - hits[i].distance) > 1e-5 * size)
        ++otherDistance;
      else if (expected.triangle != hits[i].triangle)
        ++ties;
      else if (expected.isFront != hits[i].isFront)
        ++otherSide;
    }
    const auto count = static_cast<double>(rays.size());
    EXPECT_GT(met / count, leastHits) << name;
    EXPECT_LE(otherDistance / count, 1e-4) << name;
    EXPECT_EQ(otherSide, 0u) << name;
    EXPECT_LE(ties / count, 0.01) << name;
  }

  void refit(const TriangleHierarchy& hierarchy, const Buffer& triangles) {
    HierarchyRefitPass pass(shaders_);
    pass.record(hierarchy, triangles);
  }

  void expectEmbree(const PosedTriangles& scene, std::span<const HierarchyTree> trees, const std::string& name,
                    double leastHits = 0.1) {
    const Buffer triangles("triangles", scene.rows);
    TriangleHierarchy hierarchy(trees, scene.instances);
    hierarchy.update(scene.boxes, scene.allInstances());
    refit(hierarchy, triangles);
    expectEmbree(scene, hierarchy, triangles, name, leastHits);
  }

  ShaderBench bench_;
  ShaderLibrary shaders_{std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders"};
};

TEST_F(HierarchyRays, RealFilesAgreeWithEmbree) {
  for (const char* name : {"stanford_bunny_69k.glb", "stanford_dragon_11k.glb", "living_room_small.glb"}) {
    if (!requireData(name)) continue;
    const Scene scene = importGltf(dataFile(name));
    expectEmbree(gatherTriangles(scene, poseScene(scene, {})), buildMeshTrees(scene), name);
  }
}

// Trees are of the pose at rest; bounds are of where the triangles went.
TEST_F(HierarchyRays, PosedSkinsAgreeAfterRefitting) {
  for (const char* name : {"cesium_man.glb", "fox.glb"}) {
    if (!requireData(name)) continue;
    const Scene scene = importGltf(dataFile(name));
    const std::vector<HierarchyTree> trees = buildMeshTrees(scene);
    PosedTriangles posed = gatherTriangles(scene, poseScene(scene, {}));
    Buffer triangles("triangles", posed.rows);
    TriangleHierarchy hierarchy(trees, posed.instances);
    hierarchy.update(posed.boxes, posed.allInstances());
    refit(hierarchy, triangles);
    for (const double seconds : {0.3, 0.9}) {
      PoseRequest request;
      request.seconds = seconds;
      posed = gatherTriangles(scene, poseScene(scene, request));
      triangles.upload(0, posed.rows);
      hierarchy.update(posed.boxes, posed.allInstances());
      refit(hierarchy, triangles);
      expectEmbree(posed, hierarchy, triangles, name, 0.03);
    }
  }
}

// Forty instances of three meshes; every third moves, and only those are named.
TEST_F(HierarchyRays, MovedInstancesAgreeAfterRefittingThemAlone) {
  Scene scene = makeCrowd();
  const std::vector<HierarchyTree> trees = buildMeshTrees(scene);
  PosedTriangles posed = gatherTriangles(scene, poseScene(scene, {}));
  Buffer triangles("triangles", posed.rows);
  TriangleHierarchy hierarchy(trees, posed.instances);
  hierarchy.update(posed.boxes, posed.allInstances());
  refit(hierarchy, triangles);
  expectEmbree(posed, hierarchy, triangles, "crowd");

  Pose pose = poseScene(scene, {});
  std::vector<std::uint32_t> moved;
  for (std::uint32_t i = 0; i < pose.instances.size(); i += 3) {
    moved.push_back(i);
    glm::mat4& placed = pose.instances[i].worldFromObject;
    placed = glm::translate(glm::mat4(1), {0.7f, -0.4f, 0.2f}) * placed *
             glm::scale(glm::mat4(1), {-1, 1.5f, 1}); // a mirror: fronts become backs in corners' order
  }
  posed = gatherTriangles(scene, pose);
  triangles.upload(0, posed.rows);
  hierarchy.update(posed.boxes, moved);
  EXPECT_LT(hierarchy.schedule().nodeCount, 0.5 * posed.rows.size());
  refit(hierarchy, triangles);
  expectEmbree(posed, hierarchy, triangles, "crowd, moved");
}

// As a frame does it: gathered on the GPU, refitted where something moved, built anew where something came.
TEST_F(HierarchyRays, WorldTrianglesAgreeThroughPoses) {
  Scene scene = makeCrowd();
  Gathering gathering(scene);
  SceneHierarchy kept(scene);
  Pose pose = poseScene(scene, {});
  const PosedInstance last = pose.instances.back();
  pose.instances.pop_back();
  const auto frame = [&](const std::string& name) {
    const bool isNew = gathering.set(pose, {0.25, -0.5, 0.125});
    kept.update(gathering.world, isNew);
    PosedTriangles posed;
    posed.rows = gathering.gather();
    posed.bounds = gathering.world.boundsAnchored();
    refit(kept.hierarchy(), gathering.world.triangles());
    expectEmbree(posed, kept.hierarchy(), gathering.world.triangles(), name);
    return kept.hierarchy().schedule().nodeCount;
  };
  const std::uint64_t all = frame("first");
  EXPECT_EQ(frame("still"), 0u);
  pose.instances[5].worldFromObject[3].y += 0.7f;
  const std::uint64_t one = frame("one moved");
  EXPECT_GT(one, 0u);
  EXPECT_LT(one, all / 8);
  pose.instances.insert(pose.instances.begin() + 3, last);
  EXPECT_GT(frame("one more"), all);
}

// Boxes given for the tree over instances are a hint: wrong ones change nothing but the time.
TEST_F(HierarchyRays, WrongBoxesDoNoHarm) {
  const Scene scene = makeCrowd();
  PosedTriangles posed = gatherTriangles(scene, poseScene(scene, {}));
  const Buffer triangles("triangles", posed.rows);
  TriangleHierarchy hierarchy(buildMeshTrees(scene), posed.instances);
  std::vector<Box> boxes = posed.boxes;
  std::rotate(boxes.begin(), boxes.begin() + 11, boxes.end());
  hierarchy.update(boxes, posed.allInstances());
  refit(hierarchy, triangles);
  expectEmbree(posed, hierarchy, triangles, "crowd, wrong boxes");
}

TEST_F(HierarchyRays, InstancesWithoutBoxAndEmptyTrianglesAreNotHit) {
  const Scene scene = makeCrowd();
  PosedTriangles posed = gatherTriangles(scene, poseScene(scene, {}));
  const auto end = posed.instances[3].firstTriangle;
  for (std::uint32_t i = 0; i < end; ++i) { // what is not drawn, in three ways
    shared::WorldTriangle& row = posed.rows[i];
    row.codes.w = shared::WORLD_TRIANGLE_EMPTY;
    if (i % 3 == 1) row.b.y = std::numeric_limits<float>::quiet_NaN();
    if (i % 3 == 2) row.a = row.b = row.c = glm::vec4(0);
  }
  posed.boxes[1] = {};
  const Buffer triangles("triangles", posed.rows);
  TriangleHierarchy hierarchy(buildMeshTrees(scene), posed.instances);
  hierarchy.update(posed.boxes, posed.allInstances());
  refit(hierarchy, triangles);
  expectEmbree(posed, hierarchy, triangles, "crowd, some empty");

  std::vector<Box> none(posed.boxes.size());
  hierarchy.update(none, {});
  refit(hierarchy, triangles);
  for (const GpuHit& hit : trace(hierarchy, triangles, randomRays(posed.bounds, 100, 2)))
    EXPECT_TRUE(std::isinf(hit.distance));
}

TEST_F(HierarchyRays, OneTriangleAndNoneAtAll) {
  const std::vector<TriangleCorners> one{{{-1, -1, 0}, {1, -1, 0.5f}, {0, 1, 0.2f}}};
  expectEmbree(gatherTriangles(one), std::vector{buildHierarchyTree(one)}, "one triangle", 0.02);

  TriangleHierarchy hierarchy({}, {});
  hierarchy.update({}, {});
  const Buffer triangles("triangles", 0);
  refit(hierarchy, triangles);
  EXPECT_TRUE(std::isinf(trace(hierarchy, triangles, {{{0, 0, -3}, {0, 0, 1}}})[0].distance));
}

// Rays from inside of a closed surface at its edges and corners, and along the axes: none slips through.
TEST_F(HierarchyRays, NoRaySlipsBetweenNeighbours) {
  const Mesh mesh = makeTorusMesh(0.6f, 0.3f, 40, 24);
  Scene scene;
  scene.meshes = {mesh};
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  scene.scenes.push_back({"scene", {0}});
  const PosedTriangles posed = gatherTriangles(scene, poseScene(scene, {}));
  const Buffer triangles("triangles", posed.rows);
  TriangleHierarchy hierarchy(buildMeshTrees(scene), posed.instances);
  hierarchy.update(posed.boxes, posed.allInstances());
  refit(hierarchy, triangles);
  std::vector<Ray> rays;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const glm::vec3 origin : {glm::vec3(0.6f, 0, 0), glm::vec3(-0.5f, 0.3f, 0.1f)})
    for (const shared::WorldTriangle& row : posed.rows) {
      const glm::vec3 a(row.a), b(row.b);
      for (const float t : {0.0f, 0.5f, unit(random)}) {
        const glm::vec3 target = glm::mix(a, b, t);
        rays.push_back({origin, glm::normalize(target - origin)});
      }
    }
  for (int axis = 0; axis < 3; ++axis) {
    Ray ray{{0.6f, 0, 0}, glm::vec3(0)};
    ray.direction[axis] = 1;
    rays.push_back(ray);
    ray.direction[axis] = -1;
    rays.push_back(ray);
  }
  std::size_t missed = 0;
  for (const GpuHit& hit : trace(hierarchy, triangles, rays)) {
    if (std::isinf(hit.distance))
      ++missed;
    else
      EXPECT_FALSE(hit.isFront);
  }
  EXPECT_EQ(missed, 0u) << "of " << rays.size();
}

TEST_F(HierarchyRays, InstanceThatIsNoneIsOurFault) {
  const std::vector<TriangleCorners> one{{{-1, -1, 0}, {1, -1, 0.5f}, {0, 1, 0.2f}}};
  TriangleHierarchy hierarchy(std::vector{buildHierarchyTree(one)}, std::vector<HierarchyInstance>{{0, 0}});
  EXPECT_THROW(hierarchy.update({}, {}), Failure);
  const std::vector<std::uint32_t> moved{1};
  EXPECT_THROW(hierarchy.update(std::vector<Box>(1), moved), Failure);
}

} // namespace
} // namespace brickfield::test
