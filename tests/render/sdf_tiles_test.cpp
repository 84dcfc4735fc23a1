// SDF objects traced by tiles in compute are those of boxes: the same surfaces to the last bit, from anywhere, and the
// same for every pass after them.
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

class SdfTiles : public GlTest {
protected:
  static RendererSettings tracedBy(SdfTracing tracing, RendererSettings settings = {}) {
    settings.sdfTracing = tracing;
    return settings;
  }

  void expectSame(const TestScene& scene, const View& view, const RendererSettings& settings = {},
                  std::size_t leastPixels = 500) {
    const auto boxes = scene.makeRenderer(context().info(), tracedBy(SdfTracing::Boxes, settings));
    const auto tiles = scene.makeRenderer(context().info(), tracedBy(SdfTracing::Tiles, settings));
    boxes->render(view);
    tiles->render(view);
    const FrameLayers a = boxes->readLayers(), b = tiles->readLayers();
    std::size_t sdfs = 0;
    for (std::size_t p = 0; p < a.kind.size(); ++p) {
      sdfs += a.kind[p] == SurfaceKind::Sdf;
      ASSERT_EQ(a.id[p], b.id[p]) << "pixel " << p;
      ASSERT_EQ(a.kind[p], b.kind[p]) << "pixel " << p;
      ASSERT_EQ(a.depth[p], b.depth[p]) << "pixel " << p;
      ASSERT_EQ(a.normal[p], b.normal[p]) << "pixel " << p;
      if (a.kind[p] == SurfaceKind::Sdf) {
        ASSERT_EQ(a.steps[p], b.steps[p]) << "pixel " << p;
      }
      for (int channel = 0; channel < 3; ++channel) {
        ASSERT_NEAR(a.albedo[p][channel], b.albedo[p][channel], kQuantum) << "pixel " << p;
        ASSERT_NEAR(a.color[p][channel], b.color[p][channel], 0.02f + 0.02f * a.color[p][channel]) << "pixel " << p;
      }
    }
    EXPECT_GE(sdfs, leastPixels);
  }

  // Of albedo where it is brightest: sRGB is encoded by the shader here, by the framebuffer there.
  static constexpr float kQuantum = 2.3f / 255;
};

TEST_F(SdfTiles, AreWhatBoxesDrawFromAnywhere) {
  const TestScene scene(makeCrowd(), "Sdf*", 32);
  for (const glm::vec3 eye : {glm::vec3(0.6f, 1.1f, 2.2f), glm::vec3(0.05f, 0.02f, 0.3f), glm::vec3(0, 8, 0.1f)})
    expectSame(scene, scene.view(eye, {0, 0, 0}, {317, 181}));
  expectSame(scene, makeParallelView({0.6, 1.1, 2.2}, {-0.6, -1.1, -2.2}, 1.5, 0.1, 10, {181, 181}));
}

TEST_F(SdfTiles, AreCutAndCoveredAsBoxesAre) {
  const TestScene crossed(makeInterpenetration(), "Torus", 64), sheets(makeSheets(), "all", 48);
  expectSame(crossed, crossed.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {320, 180}));
  for (const float side : {1.0f, -1.0f}) expectSame(sheets, sheets.view({0.5f, 0.3f, side * 4}, {0, 0, 0}, {320, 180}));
}

TEST_F(SdfTiles, FollowEveryTransform) {
  for (const AffineCase& affine : affineCases()) {
    SCOPED_TRACE(affine.name);
    const TestScene scene(makeTransformedTorus(affine.worldFromObject), "Torus", 48);
    expectSame(scene, scene.autoView({160, 90}), {}, 100);
  }
}

// Two thousand boxes reach into one tile: it asks in rounds. The last are the nearest, and some stand in one place,
// where the first of them counts.
TEST_F(SdfTiles, HoldMoreObjectsThanARound) {
  Scene crowd = makeTorusAlone();
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 towardsEye(0, 0, 0.002f * static_cast<float>(i - i % 4));
    crowd.nodes.at(0).nodeFromInstance.push_back(glm::translate(glm::mat4(1), towardsEye));
  }
  const TestScene scene(std::move(crowd), "all", 32);
  expectSame(scene, scene.view({0, 40, 60}, {0, 0, 0}, {96, 54}, 10), {}, 20);
}

TEST_F(SdfTiles, GiveLaterPassesWhatTheyRead) {
  const TestScene scene(makeCrowd(), "Sdf*", 32);
  RendererSettings settings;
  settings.worldField.shape.texels = 32;
  settings.shadows.method = ShadowMethod::Field;
  settings.occlusion.form = OcclusionForm::Cones;
  settings.occlusion.radiusMetres = 0.5f;
  settings.reflections.method = ReflectionMethod::Field;
  expectSame(scene, scene.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {160, 90}), settings);
}

TEST_F(SdfTiles, MoveAsBoxesDo) {
  const TestScene scene(makeCrowd(), "Sdf*", 32);
  RendererSettings settings;
  settings.taa.on = true;
  std::vector<std::vector<glm::vec2>> motions;
  for (const SdfTracing tracing : {SdfTracing::Boxes, SdfTracing::Tiles}) {
    const auto renderer = scene.makeRenderer(context().info(), tracedBy(tracing, settings));
    renderer->render(scene.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {160, 90}));
    renderer->render(scene.view({0.7f, 1.1f, 2.2f}, {0, 0, 0}, {160, 90}));
    motions.push_back(renderer->readMotion());
  }
  std::size_t moved = 0;
  for (std::size_t p = 0; p < motions[0].size(); ++p) {
    ASSERT_EQ(motions[0][p], motions[1][p]) << "pixel " << p;
    moved += glm::length(motions[0][p]) > 0.5f;
  }
  EXPECT_GT(moved, 1000u);
}

TEST_F(SdfTiles, CountWhatTheyTrace) {
  const TestScene scene(makeCrowd(), "Sdf*", 32);
  RendererSettings counting;
  counting.countersOn = true;
  const View view = scene.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {320, 180});
  FrameCounters counted[2];
  for (const SdfTracing tracing : {SdfTracing::Boxes, SdfTracing::Tiles}) {
    const auto renderer = scene.makeRenderer(context().info(), tracedBy(tracing, counting));
    renderer->render(view);
    counted[static_cast<int>(tracing)] = renderer->stats().counters;
  }
  EXPECT_GT(counted[1].hits, 1000u);
  EXPECT_EQ(counted[1].outOfSteps, 0u);
  EXPECT_LE(counted[1].fragments, counted[0].fragments) << "what lies behind a hit is not traced";
  EXPECT_LE(counted[1].steps, counted[0].steps);
}

// Without meshes nothing is cleared: tiles write all pixels.
TEST_F(SdfTiles, LeaveNothingOfTheFrameBefore) {
  Scene built = makeInterpenetration();
  built.nodes.at(1).matrix.reset(); // the sphere, which the first view alone shows
  built.nodes.at(1).translation = glm::vec3(20, 0, 0);
  const TestScene scene(std::move(built), "Torus", 48);
  const View near = scene.view({20, 0, 1}, {20, 0, 0}, {160, 90}),
             far = scene.view({0, 6, 9}, {0, 0, 0}, {160, 90}, 30);
  std::vector<FrameLayers> frames;
  for (const SdfTracing tracing : {SdfTracing::Boxes, SdfTracing::Tiles}) {
    const auto renderer = scene.makeRenderer(context().info(), tracedBy(tracing));
    for (const View& view : {near, far}) renderer->render(view);
    frames.push_back(renderer->readLayers());
  }
  EXPECT_EQ(frames[0].depth, frames[1].depth);
  EXPECT_EQ(frames[0].id, frames[1].id);
}

TEST_F(SdfTiles, AreNoneWithoutObjects) {
  const TestScene scene(makeInterpenetration(), "none");
  expectSame(scene, scene.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {160, 90}), {}, 0);
}

} // namespace
} // namespace brickfield::test
