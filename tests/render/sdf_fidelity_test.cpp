// SDF objects against the traced triangles of their meshes. Bounds: what a CPU prototype of 8-bit trilinear bricks with
// exact distances reached, rounded up (the design's figures); each stands beside its file.
#include <fmt/format.h>

#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{640, 360};

class SdfFidelity : public GlTest {
protected:
  Fidelity measure(const TestScene& scene, const View& view) {
    const auto renderer = scene.makeRenderer(context().info());
    renderer->render(view);
    const Fidelity fidelity = measureFidelity(scene, renderer->readLayers(), scene.reference(view));
    fmt::print("{}: {}\n", scene.scene().name, describe(fidelity));
    return fidelity;
  }
};

struct Bounds {
  double iou, depthMedian, depthP99, normalDegrees;
};

void expectWithin(const Fidelity& measured, const Bounds& bounds) {
  EXPECT_GE(measured.silhouetteIou, bounds.iou);
  EXPECT_LE(measured.depthMedian, bounds.depthMedian);
  EXPECT_LE(measured.depthP99, bounds.depthP99);
  EXPECT_LE(measured.normalMedianDegrees, bounds.normalDegrees);
  EXPECT_GT(measured.bothHit, 1000u);
}

constexpr Bounds kSmooth{0.995, 0.03, 0.3, 3};

TEST_F(SdfFidelity, BunnyAt128) {
  BRICKFIELD_NEEDS_DATA("stanford_bunny_closed.glb");
  const TestScene scene(dataFile("stanford_bunny_closed.glb"), "all", 128);
  expectWithin(measure(scene, scene.autoView(kSize)), kSmooth);
}

TEST_F(SdfFidelity, BlubAt128) {
  BRICKFIELD_NEEDS_DATA("blub_fish.glb");
  const TestScene scene(dataFile("blub_fish.glb"), "all", 128);
  expectWithin(measure(scene, scene.autoView(kSize)), kSmooth);
}

TEST_F(SdfFidelity, TorusAt128) {
  BRICKFIELD_NEEDS_DATA("torus_5k.glb");
  const TestScene scene(dataFile("torus_5k.glb"), "all", 128);
  expectWithin(measure(scene, scene.autoView(kSize)), kSmooth);
}

TEST_F(SdfFidelity, DragonAt128) {
  BRICKFIELD_NEEDS_DATA("stanford_dragon_100k.glb");
  const TestScene scene(dataFile("stanford_dragon_100k.glb"), "all", 128);
  expectWithin(measure(scene, scene.autoView(kSize)), {0.988, 0.05, 0.5, 5.5});
}

TEST_F(SdfFidelity, ChessBoardAt128) {
  BRICKFIELD_NEEDS_DATA("chess_board.glb");
  const TestScene scene(dataFile("chess_board.glb"), "all", 128);
  EXPECT_GE(measure(scene, scene.autoView(kSize)).silhouetteIou, 0.975);
}

TEST_F(SdfFidelity, ScorpionAt256) {
  BRICKFIELD_NEEDS_DATA("scorpion_100k.glb");
  const TestScene scene(dataFile("scorpion_100k.glb"), "all", 256);
  expectWithin(measure(scene, scene.autoView(kSize)), {0.994, 0.03, 0.3, 3});
}

TEST_F(SdfFidelity, FullDragonAt256) {
  BRICKFIELD_NEEDS_DATA("stanford_dragon_871k.glb");
  const TestScene scene(dataFile("stanford_dragon_871k.glb"), "all", 256);
  expectWithin(measure(scene, scene.autoView(kSize)), {0.997, 0.03, 0.3, 3});
}

} // namespace
} // namespace brickfield::test
