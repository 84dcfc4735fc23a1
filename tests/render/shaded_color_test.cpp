// The light of a whole frame of meshes against `reference --shadows none`, as display values, in codes of 8 bits.
//
// Where neighbouring pixels are of one node the two differ by what the G-buffer rounds: base colour by half a code,
// metallic and roughness by half of 1/255, the normal by 2^-15, the sum by half a float's half bit (a tenth of a code).
// Where radiance is at most twice the base colour, as here but for highlights, a code of base colour is at most 2.1
// codes of display (the filmic curve is steepest in the shadows), so half a code is one. Smooth metal turns half a step
// of roughness into more, at the rim of highlights.
#include <algorithm>

#include <fmt/format.h>

#include "app/tone_curve.h"
#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

struct CodeDifferences {
  std::size_t pixels = 0;
  double mean = 0, p99 = 0;
};

// No textures, lights alone: what is derived above.
constexpr CodeDifferences kLightsAlone{0, 0.5, 1.5};
// The rims of Blinn-Phong's lobes are steeper: half a step of roughness changes an exponent by 2 %.
constexpr CodeDifferences kBlinnPhong{0, 0.5, 3};
// Both filter the surroundings by the same lobes, but the renderer with 64 samples into mips of 8 x 4 texels at last:
// another code or two on rough metal, all over it.
constexpr CodeDifferences kWithSky{0, 1, 4};
// Footprints choose other mip levels, which changes base colour and normals by a code on average (frame_truths_test).
constexpr CodeDifferences kTextured{0, 1, 5}, kTexturedWithSky{0, 1.5, 8};

// Pixels all of whose neighbours show the same node in both.
bool isInside(const FrameLayers& a, const FrameLayers& b, int x, int y) {
  const int width = static_cast<int>(a.size.x), height = static_cast<int>(a.size.y);
  if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
  const std::int32_t id = a.id[static_cast<std::size_t>(y * width + x)];
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const auto p = static_cast<std::size_t>((y + dy) * width + x + dx);
      if (a.id[p] != id || b.id[p] != id) return false;
    }
  return id >= 0;
}

CodeDifferences differenceInCodes(const FrameLayers& frame, const FrameLayers& reference) {
  std::vector<double> codes;
  const int width = static_cast<int>(frame.size.x);
  for (int y = 0; y < static_cast<int>(frame.size.y); ++y)
    for (int x = 0; x < width; ++x) {
      if (!isInside(frame, reference, x, y)) continue;
      const auto p = static_cast<std::size_t>(y * width + x);
      const glm::vec3 difference =
          glm::abs(displayFromRadiance(frame.color[p], 0) - displayFromRadiance(reference.color[p], 0));
      codes.push_back(255.0 * std::max({difference.x, difference.y, difference.z}));
    }
  CodeDifferences result;
  result.pixels = codes.size();
  if (codes.empty()) return result;
  std::sort(codes.begin(), codes.end());
  for (const double code : codes) result.mean += code / static_cast<double>(codes.size());
  result.p99 = codes[codes.size() * 99 / 100];
  return result;
}

// The crowd in metal, plastic and something between that glows, under the three kinds of glTF lights.
Scene litCrowd() {
  Scene scene = makeCrowd();
  scene.materials.resize(3);
  scene.materials[0].baseColor = {0.95f, 0.64f, 0.54f, 1};
  scene.materials[0].metallic = 1;
  scene.materials[0].roughness = 0.35f;
  scene.materials[1].baseColor = {0.1f, 0.3f, 0.8f, 1};
  scene.materials[1].metallic = 0;
  scene.materials[1].roughness = 0.6f;
  scene.materials[2].baseColor = {0.8f, 0.8f, 0.2f, 1};
  scene.materials[2].metallic = 0.5f;
  scene.materials[2].roughness = 0.8f;
  scene.materials[2].emission = {0, 0.05f, 0.02f};
  for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
    scene.meshes[mesh].primitives[0].material = static_cast<int>(mesh);
  scene.lights.resize(3);
  scene.lights[0].kind = LightKind::Sun;
  scene.lights[0].intensity = 2;
  scene.lights[1].kind = LightKind::Point;
  scene.lights[1].intensity = 3;
  scene.lights[1].color = {1, 0.6f, 0.3f};
  scene.lights[2].kind = LightKind::Spot;
  scene.lights[2].intensity = 5;
  scene.lights[2].range = 6;
  for (int light = 0; light < 3; ++light) {
    Node node;
    node.light = light;
    node.translation = light == 1 ? glm::vec3(-1.5f, 1, 1.5f) : glm::vec3(0.3f, 0.2f, 3);
    scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()));
    scene.nodes.push_back(node);
  }
  return scene;
}

class ShadedColor : public GlTest {
protected:
  void expectAgreement(const std::string& name, const TestScene& scene, const View& view, const CodeDifferences& bound,
                       BrdfModel brdf = BrdfModel::CookTorrance) {
    RendererSettings settings;
    settings.brdf = brdf;
    const auto renderer = scene.makeRenderer(context().info(), settings);
    renderer->render(view);
    const FrameLayers frame = renderer->readLayers();
    const CodeDifferences codes = differenceInCodes(frame, scene.reference(view, false, brdf));
    fmt::print("{}: mean {:.3f}, 99 % {:.2f} codes of 255, {} pixels\n", name, codes.mean, codes.p99, codes.pixels);
    ASSERT_GT(codes.pixels, 5000u) << name;
    EXPECT_LE(codes.mean, bound.mean) << name;
    EXPECT_LE(codes.p99, bound.p99) << name;
    // The bounds would not hold against shadows: what is compared here is light without them.
    EXPECT_GT(differenceInCodes(frame, scene.reference(view, true)).p99, 6) << name;
  }
};

TEST_F(ShadedColor, OfAllMaterialsAndLightsIsTheReferences) {
  TestScene scene(litCrowd(), "none");
  const View view = scene.view({0.6f, 1.1f, 2.6f}, {0, 0, 0}, {640, 360});
  expectAgreement("crowd", scene, view, kWithSky);
  scene.darkenEnvironment();
  expectAgreement("crowd, black surroundings", scene, view, kLightsAlone);
  expectAgreement("crowd by Blinn-Phong, black surroundings", scene, view, kBlinnPhong, BrdfModel::BlinnPhong);
}

TEST_F(ShadedColor, OfRealScenesIsTheReferences) {
  for (const char* name : {"metal_rough_spheres_no_textures.glb", "chess_board.glb", "flight_helmet.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    TestScene scene(dataFile(name), "none");
    const View view = scene.autoView({640, 360});
    const bool isTextured = !scene.scene().images.empty();
    expectAgreement(name, scene, view, isTextured ? kTexturedWithSky : kWithSky);
    scene.darkenEnvironment();
    expectAgreement(std::string(name) + ", black surroundings", scene, view, isTextured ? kTextured : kLightsAlone);
  }
}

// Frames hold radiance as half floats: what is brighter ends at their largest, 65504, and is never infinite.
TEST_F(ShadedColor, EndsWithTheHalfFloatsAndTheReferencesDoesNot) {
  Scene built = litCrowd();
  built.lights[0].intensity = 1e9f;
  const TestScene scene(std::move(built), "none");
  const View view = scene.view({0.6f, 1.1f, 2.6f}, {0, 0, 0}, {64, 36});
  const auto renderer = scene.makeRenderer(context().info());
  renderer->render(view);
  float brightest = 0, brightestTraced = 0;
  for (const glm::vec3& color : renderer->readLayers().color)
    brightest = std::max({brightest, color.x, color.y, color.z});
  for (const glm::vec3& color : scene.reference(view, false).color)
    brightestTraced = std::max({brightestTraced, color.x, color.y, color.z});
  EXPECT_EQ(brightest, 65504.0f);
  EXPECT_GT(brightestTraced, 1e7f);
}

} // namespace
} // namespace brickfield::test
