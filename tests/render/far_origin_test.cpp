// The same scene at the origin and far from it, with the camera beside it: pictures must be the same but for what the
// rounding of the places themselves leaves. Of nodes and eyes that is nothing here: all are multiples of 1/128 m, which
// floats hold up to 131 km. The corner of an SDF object's grid is rounded: the object may stand half a unit in the last
// place of its coordinates off, the same in every frame.
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

class FarOrigin : public GlTest {
protected:
  FrameLayers frameAt(glm::vec3 place, const std::string& sdf) {
    const TestScene scene(makeTransformedTorus(glm::translate(glm::mat4(1), place)), sdf, 64);
    const auto renderer = scene.makeRenderer(context().info());
    renderer->render(scene.view(place + glm::vec3(0.59375f, 1.09375f, 2.1875f), place, {640, 360}));
    return renderer->readLayers();
  }
  // depthMean in metres
  void compare(float distance, const std::string& sdf, std::size_t pixelsAllowed, double depthMean) {
    const FrameLayers near = frameAt(glm::vec3(0), sdf), far = frameAt({distance, -distance, distance}, sdf);
    std::size_t differing = 0, covered = 0;
    double sum = 0, largest = 0;
    for (std::size_t p = 0; p < near.kind.size(); ++p) {
      differing += near.kind[p] != far.kind[p];
      if (near.kind[p] == SurfaceKind::None || far.kind[p] == SurfaceKind::None) continue;
      ++covered;
      const double d = std::abs(double{near.depth[p]} - far.depth[p]);
      sum += d;
      largest = std::max(largest, d);
    }
    fmt::print("{} m, sdf {}: {} of {} pixels differ, depth mean {:.6f} max {:.6f} m\n", distance, sdf, differing,
               covered, sum / static_cast<double>(covered), largest);
    ASSERT_GT(covered, 10000u);
    EXPECT_LE(differing, pixelsAllowed) << distance;
    EXPECT_LE(sum / static_cast<double>(covered), depthMean) << distance;
  }
};

TEST_F(FarOrigin, Meshes) {
  for (const float distance : {1000.0f, 10000.0f, 100000.0f}) compare(distance, "none", 2, 1e-5);
}
TEST_F(FarOrigin, Fields) {
  for (const float distance : {1000.0f, 10000.0f, 100000.0f}) {
    const float lastPlace = std::nextafter(distance, 2 * distance) - distance;
    // The silhouette is some 1500 pixels long and a pixel 6 mm wide: a shift by s metres turns at most s / 6 mm of
    // them.
    const auto pixels = static_cast<std::size_t>(10 + 1500 * lastPlace / 0.006f);
    compare(distance, "all", pixels, lastPlace);
  }
}

} // namespace
} // namespace brickfield::test
