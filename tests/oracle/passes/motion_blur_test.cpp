// Motion blur of a bright square that moves by some pixels a frame before black: while the shutter is open its edge
// passes over as many pixels, half of them on each side, so that brightness rises over them in a straight line.
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{160, 64};
constexpr float kHalf = 0.8f, kBack = -0.5f;

// A square at z = 0 that shines, and a wall behind it that stays where it is and shines by a tenth.
struct Square {
  Scene scene;
  Square() {
    scene.scenes.push_back({"scene", {0, 1}});
    scene.meshes = {makeBoxMesh({kHalf, kHalf, 0.001f}), makeBoxMesh({20, 20, 0.001f})};
    for (int i = 0; i < 2; ++i) {
      Material material;
      material.unlit = true;
      material.baseColor = glm::vec4(glm::vec3(i == 0 ? 1.0f : 0.1f), 1);
      scene.materials.push_back(material);
      scene.meshes[static_cast<std::size_t>(i)].primitives[0].material = i;
      Node node;
      node.mesh = i;
      node.matrix = glm::translate(glm::mat4(1), {0, 0, i == 0 ? 0.0f : kBack});
      scene.nodes.push_back(node);
    }
  }
};

class MotionBlur : public GlTest {
protected:
  // Two frames, between which the square moves to the right; the camera with it, where it is to stay in the picture.
  FrameLayers draw(float shutter, float metres, bool withCamera = false) {
    const Square square;
    Renderer renderer(context().info());
    renderer.setScene(square.scene, {{}, {-1, -1}});
    renderer.setLighting({{}, {{16, 8}, std::vector<glm::vec3>(128, glm::vec3(0))}});
    RendererSettings settings;
    settings.taa.on = true;
    settings.taa.shutter = shutter;
    renderer.setSettings(settings);
    const Pose rest = poseScene(square.scene, {});
    for (const float way : {0.0f, metres}) {
      Pose pose = rest;
      pose.instances[0].worldFromObject = glm::translate(glm::mat4(1), {way, 0, 0}) * pose.instances[0].worldFromObject;
      renderer.setPose(pose);
      const float eye = withCamera ? way : 0;
      renderer.render(makePerspectiveView({eye, 0, 2}, {eye, 0, 0}, 1.0f, 0.01f, kSize));
    }
    return renderer.readLayers();
  }
};

const float kPixelsAMetre = static_cast<float>(kSize.y) / (2 * 2 * std::tan(0.5f)); // at z = 0

TEST_F(MotionBlur, EdgesRiseOverTheWayOfTheShutter) {
  for (const float pixels : {8.0f, 16.0f})
    for (const float shutter : {0.5f, 1.0f}) {
      const float metres = pixels / kPixelsAMetre;
      const FrameLayers layers = draw(shutter, metres);
      const std::size_t row = (kSize.y / 2) * kSize.x;
      for (const float side : {-1.0f, 1.0f}) {
        const float edge = 0.5f * static_cast<float>(kSize.x) + (metres + side * kHalf) * kPixelsAMetre;
        double sum = 0;
        int count = 0;
        for (int x = 0; x < static_cast<int>(kSize.x); ++x) {
          const float inside = side * (edge - (static_cast<float>(x) + 0.5f)), way = shutter * pixels;
          if (std::abs(inside) > 0.5f * way + 4) continue;
          const float expected = std::clamp(0.5f + inside / way, 0.0f, 1.0f);
          const float found = (layers.color[row + static_cast<std::size_t>(x)].x - 0.1f) / 0.9f;
          sum += std::abs(found - expected), ++count;
          EXPECT_NEAR(found, expected, 0.2f)
              << pixels << " pixels, shutter " << shutter << ", x " << x << " side " << side;
        }
        fmt::print("{} pixels, shutter {}, side {}: {:.3f} on average\n", pixels, shutter, side, sum / count);
        EXPECT_LE(sum / count, 0.05);
      }
    }
}

// With the camera beside it the square stays and the wall moves: its own edge stays sharp before it.
TEST_F(MotionBlur, WhatStaysInThePictureStaysSharp) {
  const float metres = 12 / kPixelsAMetre;
  const FrameLayers still = draw(0, metres, true), blurred = draw(1, metres, true);
  const std::size_t row = (kSize.y / 2) * kSize.x, middle = kSize.x / 2;
  for (std::size_t x = middle - 20; x < middle + 20; ++x)
    EXPECT_NEAR(blurred.color[row + x].x, still.color[row + x].x, 0.02f) << x;
}

TEST_F(MotionBlur, StillPicturesAreTheSameToTheBit) { EXPECT_EQ(draw(1, 0).color, draw(0, 0).color); }

} // namespace
} // namespace brickfield::test
