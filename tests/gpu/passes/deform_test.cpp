// The deform pass against its CPU twin, on real files and on cases made by hand.
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "passes/geometry/deform_pass.h"
#include "scene/gltf_import.h"
#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"

namespace brickfield::test {
namespace {

glm::vec3 unpackDirection(std::uint32_t packed) { return directionFromOctahedral(glm::unpackSnorm2x16(packed)); }

struct Deviation {
  double position = 0; ///< largest, over the longest side of the deformed primitive
  double normal = 0;   ///< largest distance of unit vectors
  double tangent = 0;
  std::size_t vertices = 0;
};

class Deform : public GlTest {
protected:
  // Runs the pass and holds every deformed vertex against deformPrimitive.
  Deviation deviationOf(const Scene& scene, const Pose& pose) {
    ResidentScene resident(scene, {});
    resident.setPose(scene, pose);
    FrameTargets targets({4, 4});
    const VisibleBoxes visible;
    const Buffer counters("counters", 64);
    const Texture none;
    ShaderLibrary shaders(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders");
    DeformPass pass(shaders);
    pass.record({resident, targets, visible, counters, none, none, DrawOrder::MeshesFirst, false});
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const auto vertices = resident.meshes().vertices().read<shared::MeshVertex>();

    Deviation worst;
    std::size_t job = 0;
    for (const PosedInstance& instance : pose.instances) {
      const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
      for (const Primitive& primitive : mesh.primitives) {
        if (!isDeformed(primitive, instance)) continue;
        if (job == resident.deformJobs().size()) {
          ADD_FAILURE() << "a primitive was left undeformed";
          return worst;
        }
        const shared::DeformParams& params = resident.deformJobs()[job++].params;
        compare(primitive, deformPrimitive(primitive, instance), &vertices[params.vertices.z], worst);
      }
    }
    EXPECT_EQ(job, resident.deformJobs().size());
    return worst;
  }

  static void compare(const Primitive& primitive, const DeformedPrimitive& expected, const shared::MeshVertex* actual,
                      Deviation& worst) {
    Box bounds;
    for (const glm::vec3& position : expected.positions) bounds.extend(position);
    const double size = std::max({bounds.extent().x, bounds.extent().y, bounds.extent().z});
    for (std::size_t v = 0; v < expected.positions.size(); ++v) {
      ++worst.vertices;
      const double off = glm::distance(glm::vec3(actual[v].position), expected.positions[v]) / size;
      worst.position = std::max(worst.position, std::isnan(off) ? 1e9 : off);
      if (!primitive.flatNormals) // those are the drawn triangle's own
        worst.normal =
            std::max<double>(worst.normal, glm::distance(unpackDirection(glm::floatBitsToUint(actual[v].position.w)),
                                                         expected.normals[v]));
      if (!expected.tangents.empty())
        worst.tangent = std::max<double>(
            worst.tangent, glm::distance(unpackDirection(actual[v].codes.x), glm::vec3(expected.tangents[v])));
    }
  }

  void expectTwin(const Scene& scene, const Pose& pose, const std::string& name) {
    const Deviation deviation = deviationOf(scene, pose);
    EXPECT_GT(deviation.vertices, 0u) << name;
    EXPECT_LE(deviation.position, 1e-5) << name;
    // Octahedral codes of 16 bits are half a step of 1/32767 off on each axis, where the fold stretches by up to
    // sqrt(3): 4e-5; once before the transform, which may stretch the error by its condition (about 10 here), once
    // after.
    EXPECT_LE(deviation.normal, 5e-4) << name;
    EXPECT_LE(deviation.tangent, 5e-4) << name;
  }
};

TEST_F(Deform, RealFilesMatchTheTwin) {
  struct File {
    const char* name;
    double seconds;
  };
  for (const File& file : {File{"cesium_man.glb", 0.7}, File{"fox.glb", 0.5}, File{"morph_primitives_test.glb", 0.7},
                           File{"recursive_skeletons.glb", 0.7}}) {
    if (!requireData(file.name)) continue;
    const Scene scene = importGltf(dataFile(file.name));
    PoseRequest request;
    request.seconds = file.seconds;
    expectTwin(scene, poseScene(scene, request), file.name);
  }
}

// A cloud of vertices with eight influences each, two morph targets and tangents; joints of any affine kind.
Scene cloudScene(int influences, bool flat) {
  std::mt19937 engine(3);
  const auto unit = [&] { return static_cast<float>(engine() >> 8) / static_cast<float>(1u << 24); };
  const auto vector = [&] { return glm::vec3(unit(), unit(), unit()) * 2.0f - 1.0f; };
  Primitive primitive;
  constexpr std::uint32_t kVertices = 300;
  primitive.morphTargets.resize(2);
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    primitive.indices.push_back(v);
    primitive.positions.push_back(vector());
    primitive.normals.push_back(glm::normalize(vector()));
    primitive.tangents.emplace_back(glm::normalize(vector()), v % 2 ? 1.0f : -1.0f);
    float sum = 0;
    for (int i = 0; i < influences; ++i) {
      primitive.joints.push_back(static_cast<std::uint16_t>(engine() % 9));
      primitive.jointWeights.push_back(unit());
      sum += primitive.jointWeights.back();
    }
    for (int i = 0; i < influences; ++i)
      primitive.jointWeights[primitive.jointWeights.size() - 1 - static_cast<std::size_t>(i)] /= sum;
    primitive.morphTargets[0].positions.push_back(0.3f * vector());
    primitive.morphTargets[1].positions.push_back(0.3f * vector());
    primitive.morphTargets[1].normals.push_back(0.3f * vector());
    primitive.morphTargets[1].tangents.push_back(0.3f * vector());
  }
  primitive.influencesPerVertex = influences;
  primitive.flatNormals = flat;
  Scene scene;
  scene.scenes.push_back({"scene", {0}});
  // A rigid primitive before and after: places in the pools are no zeros.
  Primitive rigid = primitive;
  rigid.morphTargets.clear();
  rigid.influencesPerVertex = 0;
  rigid.joints.clear();
  rigid.jointWeights.clear();
  scene.meshes.resize(2);
  scene.meshes[0].primitives = {primitive};
  scene.meshes[1].primitives = {rigid};
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  return scene;
}

glm::mat4 turned(float angle, glm::vec3 axis, glm::vec3 scale, glm::vec3 offset) {
  return glm::translate(glm::mat4(1), offset) * glm::rotate(glm::mat4(1), angle, glm::normalize(axis)) *
         glm::scale(glm::mat4(1), scale);
}

Pose cloudPose(const glm::vec3& scale, int instances) {
  Pose pose;
  pose.worldFromNode = {glm::mat4(1)};
  for (int i = 0; i < instances; ++i) {
    PosedInstance instance;
    instance.node = instance.mesh = instance.skin = 0;
    instance.instance = i;
    instance.morphWeights = {0.5f, -0.25f + static_cast<float>(i)};
    for (int joint = 0; joint < 9; ++joint)
      instance.worldFromBind.push_back(turned(0.05f * static_cast<float>(joint + i), {1, 2, static_cast<float>(joint)},
                                              scale,
                                              glm::vec3(0.1f * static_cast<float>(joint), 0, static_cast<float>(i))));
    pose.instances.push_back(instance);
  }
  return pose;
}

TEST_F(Deform, FourAndEightInfluencesWithMorphsMatchTheTwin) {
  for (const int influences : {4, 8}) expectTwin(cloudScene(influences, false), cloudPose({1, 1.3f, 0.8f}, 3), "cloud");
}

TEST_F(Deform, MorphsAloneMatchTheTwin) {
  Scene scene = cloudScene(4, false);
  Primitive& primitive = scene.meshes[0].primitives[0];
  primitive.influencesPerVertex = 0;
  primitive.joints.clear();
  primitive.jointWeights.clear();
  Pose pose = cloudPose(glm::vec3(1), 2);
  for (PosedInstance& instance : pose.instances) instance.skin = -1, instance.worldFromBind.clear();
  expectTwin(scene, pose, "morphs");
}

// A mirroring skeleton turns the winding and the normals alike: they stay on the side that the triangles show.
TEST_F(Deform, MirroringJointsMatchTheTwin) { expectTwin(cloudScene(4, false), cloudPose({-1, 1, 1}, 1), "mirror"); }

TEST_F(Deform, FlatJointsKeepTheSourcesNormals) {
  const Scene scene = cloudScene(4, false);
  Pose pose = cloudPose(glm::vec3(1), 1);
  pose.instances[0].morphWeights = {0, 0};
  for (glm::mat4& joint : pose.instances[0].worldFromBind) joint = glm::scale(glm::mat4(1), {1, 0, 0});
  expectTwin(scene, pose, "flat");
}

TEST_F(Deform, RestingMorphsMakeNoJob) {
  Scene scene = cloudScene(4, false);
  scene.meshes[0].primitives[0].influencesPerVertex = 0;
  Pose pose = cloudPose(glm::vec3(1), 1);
  pose.instances[0].skin = -1;
  pose.instances[0].worldFromBind.clear();
  pose.instances[0].morphWeights = {0, 0};
  ResidentScene resident(scene, {});
  resident.setPose(scene, pose);
  EXPECT_TRUE(resident.deformJobs().empty());
}

} // namespace
} // namespace brickfield::test
