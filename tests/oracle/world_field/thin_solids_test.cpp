// Closed solids thinner than a texel: no texel may lie in one, and yet no ray may slip through.
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "field/field_volume.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"
#include "tests/support/world_field_stage.h"

namespace brickfield::test {
namespace {

constexpr int kTexels = 64;

// A plate of 1 x 1 metres, turned about a slanting axis.
glm::mat4 turnedBy(float angle) {
  return glm::rotate(glm::translate(glm::mat4(1), {0.013f, -0.007f, 0.021f}), angle,
                     glm::normalize(glm::vec3(1, 0.6f, -0.3f)));
}

Scene plateScene(float thickness, const glm::mat4& worldFromPlate) {
  Scene scene;
  scene.meshes.push_back(makeBoxMesh({0.5f, 0.5f, 0.5f * thickness}));
  Node node;
  node.name = "Plate";
  node.mesh = 0;
  node.matrix = worldFromPlate;
  scene.nodes.push_back(std::move(node));
  scene.scenes.push_back({"scene", {0}});
  return scene;
}

class ThinSolids : public GlTest {
protected:
  // Of rays straight through the plate, away from its border, the share along which no value is negative.
  // sdfNodes  glob of nodes that are SDF objects
  static double slippedThrough(float thicknessTexels, float angle, const char* sdfNodes) {
    const float texel = 1.6f / kTexels;
    const glm::mat4 worldFromPlate = turnedBy(angle);
    const TestScene scene(plateScene(thicknessTexels * texel, worldFromPlate), sdfNodes, 128);
    WorldFieldStage stage(scene.scene(), scene.fields(), {1, kTexels, texel, false});
    stage.frame(scene.pose(), glm::dvec3(0));
    const FieldSnapshot field = stage.read();
    const FieldVolume volume{field.window.firstTexel,
                             glm::ivec3(kTexels),
                             field.window.texelSize,
                             static_cast<float>(field.window.rangeTexels()),
                             false,
                             field.distances,
                             {}};
    std::mt19937 random(7);
    std::uniform_real_distribution<float> across(-0.4f, 0.4f);
    int slipped = 0;
    constexpr int kRays = 2000;
    for (int ray = 0; ray < kRays; ++ray) {
      const float x = across(random), y = across(random);
      float least = INFINITY;
      for (int step = -40; step <= 40; ++step) {
        const glm::vec3 point(worldFromPlate * glm::vec4(x, y, 0.05f * texel * static_cast<float>(step), 1));
        const glm::dvec3 anchored = glm::dvec3(point) - field.anchorWorld;
        least = std::min(least, static_cast<float>(sampleField({&volume, 1}, anchored).distanceWorld));
      }
      slipped += least > 0;
    }
    return static_cast<double>(slipped) / kRays;
  }
};

TEST_F(ThinSolids, NoRaySlipsThroughPlates) {
  for (const float thickness : {0.02f, 0.3f, 0.7f, 1.5f})
    for (const float angle : {0.0f, 0.4f, 1.1f})
      EXPECT_EQ(slippedThrough(thickness, angle, "none"), 0) << thickness << " texels thick, turned by " << angle;
}

// Voxels are a third of a texel. The thinnest plate is drawn a voxel thick: hardly any brick knows where its sides are.
TEST_F(ThinSolids, NoRaySlipsThroughPlatesOfBricks) {
  for (const float thickness : {0.02f, 0.4f, 0.7f, 1.5f})
    for (const float angle : {0.0f, 0.4f, 1.1f})
      EXPECT_LE(slippedThrough(thickness, angle, "all"), thickness < 0.1f ? 0.01 : 0.0)
          << thickness << " texels thick, turned by " << angle;
}

} // namespace
} // namespace brickfield::test
