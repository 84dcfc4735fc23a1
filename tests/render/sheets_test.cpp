// Sheets as SDF objects against the reference: backs of single-sided materials are invisible, mirrored nodes too, and
// masks are cut, because hits whose coverage is below a half let the ray pass.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

// A border may be off by half a voxel (1/128 m) and half a pixel (7.4 mm at the sheets' distance).
constexpr double kBorderSlack = 0.5 / 128 + 0.5 * 0.0074; // metres
// Square metres and metres of border: a whole sheet; one less the disk of radius 0.3 and the corner of 0.2.
constexpr double kWholeIou = 1 - 4 * kBorderSlack / 1;
constexpr double kMaskedIou = 1 - (4 + 1.885) * kBorderSlack / (1 - 0.283 - 0.04);
// A hidden slab, a voxel thick, may show a sliver of its rim: fewer pixels than one side of the sheet is long.
constexpr std::ptrdiff_t kRimPixels = 100;

// How much of the pixels that either picture shows of a node both show.
double iouOfNode(const FrameLayers& a, const FrameLayers& b, int node) {
  std::size_t either = 0, both = 0;
  for (std::size_t p = 0; p < a.id.size(); ++p) {
    either += a.id[p] == node || b.id[p] == node;
    both += a.id[p] == node && b.id[p] == node;
  }
  return either ? static_cast<double>(both) / static_cast<double>(either) : 1;
}

class Sheets : public GlTest {
protected:
  void compare(const char* side, glm::vec3 eye, const std::set<std::string>& visible) {
    const TestScene scene(makeSheets(), "all", 128);
    const View view = scene.view(eye, {0, 0, 0}, {640, 360});
    const auto renderer = scene.makeRenderer(context().info());
    renderer->render(view);
    const FrameLayers frame = renderer->readLayers(), reference = scene.reference(view);
    for (int node = 0; node < 6; ++node) {
      const std::string& name = scene.scene().nodes[static_cast<std::size_t>(node)].name;
      const auto shown = std::count(reference.id.begin(), reference.id.end(), node);
      const auto drawn = std::count(frame.id.begin(), frame.id.end(), node);
      EXPECT_EQ(shown > 0, visible.contains(name)) << name << ": the reference shows " << shown << " pixels";
      if (!visible.contains(name)) {
        EXPECT_LE(drawn, kRimPixels) << name << " from " << side;
        continue;
      }
      const double iou = iouOfNode(frame, reference, node);
      fmt::print("{} from {}: IoU {:.4f}, {} and {} pixels\n", name, side, iou, drawn, shown);
      EXPECT_GE(iou, name.starts_with("Masked") ? kMaskedIou : kWholeIou) << name << " from " << side;
    }
  }
};

TEST_F(Sheets, ShowTheirFronts) {
  compare("the front", {0.5f, 0.6f, 3.2f}, {"Front", "Mirrored", "Masked", "MaskedFront"});
}

TEST_F(Sheets, HideTheirBacks) { compare("behind", {0.5f, 0.6f, -3.2f}, {"Back", "TurnedOver", "Masked"}); }

} // namespace
} // namespace brickfield::test
