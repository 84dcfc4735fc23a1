// What must hold of a whole frame: meshes match the reference, meshes and SDF objects meet where the reference says,
// drawing order is invisible, conservative depth keeps its promise, the camera may go anywhere.
#include <algorithm>

#include <fmt/format.h>

#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

class FrameTruths : public GlTest {
protected:
  FrameLayers render(const TestScene& scene, const View& view, const RendererSettings& settings = {}) {
    const auto renderer = scene.makeRenderer(context().info(), settings);
    renderer->render(view);
    return renderer->readLayers();
  }
};

// Pixels with another kind within `reach` pixels along each axis.
std::vector<bool> nearKindBorder(const FrameLayers& layers, int reach) {
  const int width = static_cast<int>(layers.size.x), height = static_cast<int>(layers.size.y);
  std::vector<bool> near(layers.kind.size(), false);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const int nx = std::clamp(x + dx, 0, width - 1), ny = std::clamp(y + dy, 0, height - 1);
          if (layers.kind[static_cast<std::size_t>(ny * width + nx)] !=
              layers.kind[static_cast<std::size_t>(y * width + x)])
            near[static_cast<std::size_t>(y * width + x)] = true;
        }
  return near;
}

TEST_F(FrameTruths, MeshesMatchTheReference) {
  for (const char* name : {"stanford_dragon_11k.glb", "chess_board.glb", "negative_scale_test.glb", "fox.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const TestScene scene(dataFile(name), "none", 0,
                          std::string_view(name) == "fox.glb" ? std::optional(0.5) : std::nullopt);
    const View view = scene.autoView({960, 540});
    const Fidelity fidelity = measureFidelity(scene, render(scene, view), scene.reference(view));
    fmt::print("{}: IoU {:.5f}\n", name, fidelity.silhouetteIou);
    EXPECT_GE(fidelity.silhouetteIou, 0.9995) << name;
  }
}

// Wrap modes, both UV sets, texture transforms, vertex colours, mirrored UVs, against the reference's own sampling.
// The two choose mip levels by different footprints: a mean of 0.004 is one code of 8 bits.
TEST_F(FrameTruths, TexturesMatchTheReference) {
  for (const char* name : {"texture_settings_test.glb", "multi_uv_test.glb", "texture_transform_test.glb",
                           "vertex_color_test.glb", "texture_coordinate_test.glb", "box_textured.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const TestScene scene(dataFile(name), "none");
    const View view = scene.autoView({640, 360});
    const FrameLayers frame = render(scene, view), reference = scene.reference(view);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t p = 0; p < frame.kind.size(); ++p) {
      if (frame.kind[p] == SurfaceKind::None || frame.id[p] != reference.id[p]) continue;
      const glm::vec3 difference = glm::abs(frame.albedo[p] - reference.albedo[p]);
      sum += (difference.x + difference.y + difference.z) / 3;
      ++count;
    }
    const double mean = sum / static_cast<double>(count);
    fmt::print("{}: mean albedo difference {:.4f}\n", name, mean);
    ASSERT_GT(count, 1000u) << name;
    EXPECT_LE(mean, 0.004) << name;
  }
}

TEST_F(FrameTruths, MeshAndSdfMeetWhereTheReferenceSays) {
  const TestScene scene(makeInterpenetration(), "Torus", 128);
  const View view = scene.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {640, 360});
  const FrameLayers frame = render(scene, view), reference = scene.reference(view);
  const std::vector<bool> border = nearKindBorder(reference, 2);
  std::size_t differing = 0, away = 0, meshes = 0, sdfs = 0;
  for (std::size_t p = 0; p < frame.kind.size(); ++p) {
    meshes += reference.kind[p] == SurfaceKind::Mesh;
    sdfs += reference.kind[p] == SurfaceKind::Sdf;
    if (frame.kind[p] == reference.kind[p]) continue;
    ++differing;
    away += !border[p];
  }
  ASSERT_GT(meshes, 3000u);
  ASSERT_GT(sdfs, 3000u);
  EXPECT_LE(static_cast<double>(differing), 0.005 * static_cast<double>(frame.kind.size()));
  EXPECT_EQ(away, 0u) << "kinds differ farther than two pixels from where they meet";
}

TEST_F(FrameTruths, DrawingOrderChangesNotOnePixel) {
  RendererSettings reversed;
  reversed.drawOrder = DrawOrder::BoxesFirstAllReversed;
  for (const auto& scene : {TestScene(makeInterpenetration(), "Torus", 64), TestScene(makeCrowd(), "Sdf*", 32)}) {
    const View view = scene.view({0.6f, 1.1f, 2.2f}, {0, 0, 0}, {640, 360});
    const FrameLayers a = render(scene, view), b = render(scene, view, reversed);
    for (std::size_t p = 0; p < a.kind.size(); ++p) {
      ASSERT_EQ(a.id[p], b.id[p]) << "pixel " << p;
      ASSERT_EQ(a.depth[p], b.depth[p]) << "pixel " << p;
      ASSERT_EQ(a.normal[p], b.normal[p]) << "pixel " << p;
      ASSERT_EQ(a.color[p], b.color[p]) << "pixel " << p;
    }
  }
}

TEST_F(FrameTruths, ConservativeDepthKeepsItsPromise) {
  RendererSettings counting;
  counting.countersOn = true;
  const TestScene scene(makeCrowd(), "Sdf*", 32);
  for (const glm::vec3 eye : {glm::vec3(0.6f, 1.1f, 2.2f), glm::vec3(0.05f, 0.02f, 0.3f), glm::vec3(0, 8, 0.1f)}) {
    const auto renderer = scene.makeRenderer(context().info(), counting);
    renderer->render(scene.view(eye, {0, 0, 0}, {640, 360}));
    const FrameStats stats = renderer->stats();
    EXPECT_GT(stats.counters.hits, 1000u);
    EXPECT_EQ(stats.counters.promiseBroken, 0u);
    EXPECT_EQ(stats.counters.outOfSteps, 0u);
  }
}

class Flight : public FrameTruths {
protected:
  Flight() : scene_(makeTorusAlone(), "Torus", 96) {
    scene_.darkenEnvironment(); // colour is not looked at, and the reference would filter a sky at each step
    renderer_ = scene_.makeRenderer(context().info());
  }

  // What is asked of still pictures holds at each step, and what differs lies within a pixel of the silhouette.
  void expectAgreement(const std::string& step, glm::vec3 eye, glm::vec3 target) {
    const View view = scene_.view(eye, target, {320, 180}, 70);
    renderer_->render(view);
    const FrameLayers frame = renderer_->readLayers(), reference = scene_.reference(view);
    const Fidelity fidelity = measureFidelity(scene_, frame, reference);
    const std::string said = step + ": " + describe(fidelity);
    const std::vector<bool> border = nearKindBorder(reference, 1);
    std::size_t away = 0;
    for (std::size_t p = 0; p < border.size(); ++p) away += frame.kind[p] != reference.kind[p] && !border[p];
    EXPECT_EQ(away, 0u) << "pixels differ beside the silhouette, " << said;
    EXPECT_GE(fidelity.silhouetteIou, 0.995) << said;
    EXPECT_LE(fidelity.depthMedian, 0.03) << said;
    EXPECT_LE(fidelity.depthP99, 0.3) << said;
    EXPECT_LE(fidelity.normalMedianDegrees, 3) << said;
    if (fidelity.silhouetteIou < worstIou_) worstIou_ = fidelity.silhouetteIou, worstSilhouette_ = said;
    if (fidelity.depthP99 > worstDepth_) worstDepth_ = fidelity.depthP99, worstDepthStep_ = said;
  }
  void printWorst() const {
    fmt::print("worst silhouette at {}\nworst depth at {}\n", worstSilhouette_, worstDepthStep_);
  }

  TestScene scene_;
  std::unique_ptr<Renderer> renderer_;
  double worstIou_ = 2, worstDepth_ = -1;
  std::string worstSilhouette_, worstDepthStep_;
};

// From outside the box through the hole, close past the tube, out on the far side, always looking at the torus.
TEST_F(Flight, ThroughTheHole) {
  constexpr int kSteps = 64;
  for (int step = 0; step < kSteps; ++step) {
    const float along = static_cast<float>(step) / (kSteps - 1);
    expectAgreement(fmt::format("step {}", step),
                    {0.25f * std::sin(6.0f * along), 0.1f - 0.2f * along, 1.6f - 3.2f * along},
                    {0.5f * std::cos(9.0f * along), 0.3f * std::sin(7.0f * along), 0.0f});
  }
  printWorst();
}

// Along the torus' side into the tube itself: from within, single-sided surfaces are invisible to both.
TEST_F(Flight, ThroughTheTube) {
  constexpr int kSteps = 64;
  for (int step = 0; step < kSteps; ++step) {
    const float along = static_cast<float>(step) / (kSteps - 1);
    expectAgreement(fmt::format("step {}", step), {0.58f, 0.03f, 0.9f - 1.3f * along},
                    {0.5f * std::cos(5.0f * along), 0.6f * std::sin(5.0f * along), -0.5f * along});
  }
  printWorst();
}

// Scale (1, 3, 0.2), a shear and a mirror on the node; depth in the smallest voxel.
TEST_F(FrameTruths, AffineTransformsAreExact) {
  for (const AffineCase& affine : affineCases()) {
    const TestScene scene(makeTransformedTorus(affine.worldFromObject), "Torus", 128);
    const View view = scene.autoView({640, 360});
    const Fidelity fidelity = measureFidelity(scene, render(scene, view), scene.reference(view));
    fmt::print("{}: {}\n", affine.name, describe(fidelity));
    EXPECT_GE(fidelity.silhouetteIou, 0.995) << affine.name;
    EXPECT_LE(fidelity.depthMedian, 0.03) << affine.name;
    EXPECT_LE(fidelity.depthP99, 0.3) << affine.name;
    EXPECT_LE(fidelity.normalMedianDegrees, 3) << affine.name;
  }
}

} // namespace
} // namespace brickfield::test
