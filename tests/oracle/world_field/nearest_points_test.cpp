// The grids of nearest surface points around the fields of SDF objects, against closed forms.
#include <cmath>
#include <cstdio>

#include "passes/world_field/nearest_points.h"
#include "shared/bindings.h"
#include "shared/world_field_params.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr int kSide = static_cast<int>(shared::NEAREST_POINTS);

Scene sceneOf(Mesh mesh) {
  Scene scene = makeTorusAlone();
  scene.meshes[0] = std::move(mesh);
  return scene;
}

struct StoredPoint {
  glm::dvec3 pointObject;   ///< of the grid
  glm::dvec3 surfaceObject; ///< what is nearest
  double distance;          ///< object units, negative inside
};

class NearestPointsTest : public GlTest {
protected:
  // Of a scene's one field.
  std::vector<StoredPoint> pointsOf(const TestScene& scene) {
    ResidentScene resident(scene.scene(), scene.fields());
    resident.setPose(scene.scene(), scene.pose());
    ShaderLibrary shaders(std::filesystem::path(BRICKFIELD_SOURCE_DIR) / "shaders");
    NearestPoints points(shaders);
    resident.atlas().bind();
    points.fit(resident);
    const auto program =
        shaders.load({"field_objects", {{GL_COMPUTE_SHADER, "passes/field_objects.comp.glsl"}}, {}, {}});
    program->use();
    points.bind(*program);
    glActiveTexture(GL_TEXTURE0 + shared::kNearestPointUnit);
    GLint texture = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_3D, &texture);
    std::vector<glm::vec4> texels(std::size_t{kSide} * kSide * kSide);
    const auto bytes = static_cast<GLsizei>(texels.size() * sizeof(glm::vec4));
    glGetTextureImage(static_cast<GLuint>(texture), 0, GL_RGBA, GL_FLOAT, bytes, texels.data());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));

    const ResidentField& field = resident.atlas().field(resident.atlas().fieldIds()[0]);
    const glm::vec3 boxMin = (field.boundsObject.min - field.originObject) / field.voxelSizeObject;
    const glm::vec3 boxMax = (field.boundsObject.max - field.originObject) / field.voxelSizeObject;
    const PointGrid grid = pointGridOf(boxMin, boxMax, field.number);
    const auto objectFromGrid = [&](glm::vec3 p) { return glm::dvec3(field.originObject + p * field.voxelSizeObject); };
    voxel_ = field.voxelSizeObject;
    const double diagonal = glm::length(float(kSide - 1) * grid.cellGrid) * field.voxelSizeObject;
    std::vector<StoredPoint> stored;
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const glm::vec3 at(i % kSide, i / kSide % kSide, i / (kSide * kSide));
      stored.push_back({objectFromGrid(grid.firstGrid + at * grid.cellGrid),
                        objectFromGrid(boxMin + glm::vec3(texels[i]) * (boxMax - boxMin)),
                        (2 * double(texels[i].w) - 1) * diagonal});
    }
    return stored;
  }

  double voxel_ = 0; // object units
};

// Points that are named lie on the surface, and the way to them is the shortest; where exactly they lie counts for
// little from afar.
TEST_F(NearestPointsTest, AroundASphereNameItsSurface) {
  constexpr double kRadius = 0.7;
  const TestScene scene(sceneOf(makeSphereMesh(float(kRadius), 96, 192)), "all", 48);
  double worstDistance = 0, worstWay = 0, waySquares = 0, worstOff = 0;
  std::size_t inside = 0, all = 0;
  for (const StoredPoint& stored : pointsOf(scene)) {
    const double truth = glm::length(stored.pointObject) - kRadius;
    EXPECT_EQ(stored.distance < 0, truth < 0) << truth;
    inside += truth < 0;
    worstDistance = std::max(worstDistance, std::abs(stored.distance - truth));
    const double excess = glm::distance(stored.pointObject, stored.surfaceObject) - std::abs(truth);
    worstWay = std::max(worstWay, std::abs(excess));
    waySquares += excess * excess, ++all;
    worstOff = std::max(worstOff, std::abs(glm::length(stored.surfaceObject) - kRadius));
  }
  const double way = std::sqrt(waySquares / double(all));
  std::printf("sphere: worst distance %.3f, way %.3f (rms %.3f), off the surface %.3f voxels\n", worstDistance / voxel_,
              worstWay / voxel_, way / voxel_, worstOff / voxel_);
  EXPECT_GT(inside, 500u);
  EXPECT_LE(worstDistance, 0.1 * voxel_);
  EXPECT_LE(worstWay, 0.6 * voxel_);
  EXPECT_LE(way, 0.05 * voxel_);
  EXPECT_LE(worstOff, 0.1 * voxel_);
}

TEST_F(NearestPointsTest, AroundABoxNameItsFacesEdgesAndCorners) {
  const glm::dvec3 half(0.5, 0.2, 0.35);
  const TestScene scene(sceneOf(makeBoxMesh(glm::vec3(half))), "all", 64);
  double worstDistance = 0, worstWay = 0, waySquares = 0;
  std::size_t outside = 0;
  for (const StoredPoint& stored : pointsOf(scene)) {
    const double truth = glm::distance(glm::clamp(stored.pointObject, -half, half), stored.pointObject);
    if (truth == 0) continue;
    ++outside;
    worstDistance = std::max(worstDistance, std::abs(stored.distance - truth));
    const double excess = glm::distance(stored.pointObject, stored.surfaceObject) - truth;
    worstWay = std::max(worstWay, std::abs(excess));
    waySquares += excess * excess;
  }
  const double way = std::sqrt(waySquares / double(outside));
  std::printf("box: worst distance %.3f, way %.3f (rms %.3f) voxels\n", worstDistance / voxel_, worstWay / voxel_,
              way / voxel_);
  EXPECT_GT(outside, 20000u);
  EXPECT_LE(worstDistance, 0.3 * voxel_) << "bricks round an edge by as much";
  EXPECT_LE(worstWay, 0.6 * voxel_);
  EXPECT_LE(way, 0.35 * voxel_);
}

// A renderer that is given another scene makes the grids of its fields, though their numbers are those of the last.
TEST_F(NearestPointsTest, AreMadeAnewForTheNextScene) {
  const TestScene torus(sceneOf(makeTorusMesh(0.6f, 0.2f, 96, 48)), "all", 32);
  const TestScene box(sceneOf(makeBoxMesh({0.8f, 0.4f, 0.8f})), "all", 32);
  const auto fieldAfter = [&](std::vector<const TestScene*> scenes) {
    Renderer renderer(context().info());
    RendererSettings settings;
    settings.worldField.shape = {1, 64, 0, true};
    settings.worldField.always = true;
    for (const TestScene* scene : scenes) {
      renderer.setScene(scene->scene(), scene->fields());
      renderer.setPose(scene->pose());
      renderer.setLighting(scene->lighting());
      renderer.setSettings(settings);
      renderer.render(scene->autoView({16, 16}));
    }
    return renderer.readWorldField();
  };
  const FieldVolumes fresh = fieldAfter({&box}), second = fieldAfter({&torus, &box});
  ASSERT_EQ(fresh.cascades.size(), 1u);
  EXPECT_TRUE(second == fresh);
  EXPECT_FALSE(fieldAfter({&torus}) == fresh);
}

} // namespace
} // namespace brickfield::test
