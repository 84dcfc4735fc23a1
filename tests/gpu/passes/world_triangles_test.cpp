// The gathered triangles of the world against the same triangles placed on the CPU in double, their pseudonormals
// against sums in double, and what is gathered anew against what is gathered from nothing.
#include <cstring>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "passes/geometry/deform_pass.h"
#include "passes/world_field/world_triangles_pass.h"
#include "scene/gltf_import.h"
#include "scene/surface_topology.h"
#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"

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
  // One scene with what gathers its triangles.
  struct Gathering {
    Gathering(const Scene& source, const SceneFields& fields = {})
        : scene(source),
          resident(source, fields),
          world(source, fields, resident),
          shaders(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders"),
          deform(shaders),
          pass(shaders) {}

    bool set(const Pose& pose, glm::dvec3 anchor) {
      resident.setPose(scene, pose);
      return world.setPose(scene, pose, anchor);
    }
    std::vector<shared::WorldTriangle> gather() {
      FrameContext context{resident, targets, visible, counters, none, none, DrawOrder::MeshesFirst, false, &world};
      deform.record(context);
      glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
      pass.record(context);
      world.settle();
      glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
      return world.triangles().read<shared::WorldTriangle>(0, world.triangleCount());
    }

    const Scene& scene;
    ResidentScene resident;
    WorldTriangles world;
    ShaderLibrary shaders;
    DeformPass deform;
    WorldTrianglesPass pass;
    FrameTargets targets{{4, 4}};
    VisibleBoxes visible;
    Buffer counters{"counters", 64};
    Texture none;
  };

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

} // namespace
} // namespace brickfield::test
