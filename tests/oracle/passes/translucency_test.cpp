// How thick SDF objects are, and what light passes through them, against closed forms.
//
// A sphere of radius R that is seen or lit along d at a point with the normal n is crossed over 2 R |n.d|.
#include <numbers>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "field/analytic.h"
#include "renderer/renderer.h"
#include "scene/brdf.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"

namespace brickfield::test {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr glm::uvec2 kSize{160, 120};
constexpr float kRadius = 0.5f;
const glm::vec3 kHalf{0.5f, 0.3f, 0.4f};

// One SDF object in black surroundings.
struct ObjectScene {
  Scene scene;
  SceneFields fields;
  Lighting lighting{{}, {{16, 8}, std::vector<glm::vec3>(128, glm::vec3(0))}};
  float voxelWorld = 0;

  ObjectScene(const DistanceFunction& distance, Box box, int bits, const glm::mat4& worldFromObject = glm::mat4(1)) {
    Material material;
    material.metallic = 0;
    scene = makeBoxAlone(std::move(material), worldFromObject);
    fields.fields.push_back(makeAnalyticField(distance, box, 64, bits, 2));
    fields.fieldOfNode = {0};
    voxelWorld = fields.fields[0].levels[0].voxelSizeObject * scaleRange(worldFromObject).y;
  }
  void shine(glm::vec3 travels, float lux) {
    PosedLight sun;
    sun.light.kind = LightKind::Sun;
    sun.light.intensity = lux;
    sun.directionWorld = glm::normalize(travels);
    lighting.lights.push_back(sun);
  }
};

ObjectScene sphere(int bits, const glm::mat4& worldFromObject = glm::mat4(1)) {
  return {[](glm::vec3 p) { return sphereDistance(p, glm::vec3(0), kRadius); },
          {glm::vec3(-kRadius), glm::vec3(kRadius)},
          bits,
          worldFromObject};
}
ObjectScene box(int bits, const glm::mat4& worldFromObject = glm::mat4(1)) {
  return {[](glm::vec3 p) { return boxDistance(p, glm::vec3(0), kHalf); }, {-kHalf, kHalf}, bits, worldFromObject};
}

TranslucencySettings given(float share, glm::vec3 absorption, float wrap = 0) {
  return {TranslucencySource::Given, share, absorption, wrap};
}

const View kView = makePerspectiveView({0.9f, 0.7f, 1.2f}, glm::vec3(0), 0.7f, 0.01f, kSize);

class Translucency : public GlTest {
protected:
  FrameLayers draw(const ObjectScene& object, const View& view, const TranslucencySettings& translucency) {
    Renderer renderer(context().info());
    renderer.setScene(object.scene, object.fields);
    renderer.setPose(poseScene(object.scene, {}));
    renderer.setLighting(object.lighting);
    RendererSettings settings;
    settings.translucency = translucency;
    settings.forcedLevel = 0;
    renderer.setSettings(settings);
    renderer.render(view);
    return renderer.readLayers();
  }
};

PrimaryRay rayOf(const View& view, std::size_t i) {
  return primaryRay(view, glm::vec2(i % view.sizePixels.x, i / view.sizePixels.x) + 0.5f);
}

// Where a ray of object space, its direction not unit, enters and leaves the box.
glm::vec2 crossBox(glm::vec3 origin, glm::vec3 direction) {
  const glm::vec3 a = (-kHalf - origin) / direction, b = (kHalf - origin) / direction;
  const glm::vec3 low = glm::min(a, b), high = glm::max(a, b);
  return {std::max({low.x, low.y, low.z}), std::min({high.x, high.y, high.z})};
}

// Metres to the nearest edge of the box from a point on it.
float toEdge(glm::vec3 point) {
  glm::vec3 inside = kHalf - glm::abs(point);
  if (inside.x > inside.y) std::swap(inside.x, inside.y);
  if (inside.y > inside.z) std::swap(inside.y, inside.z);
  return std::max(inside.x, inside.y);
}

// The surface that 8 bits store lies within 0.03 voxel of the true one; a ray that leans by a cosine of 0.2 makes up to
// five times that of it, at each end.
TEST_F(Translucency, SpheresAndBoxesAreAsThickAsTheyAre) {
  for (const int bits : {8, 16})
    for (const AffineCase& affine : affineCases()) {
      const glm::mat4 objectFromWorld = glm::inverse(affine.worldFromObject);
      const glm::vec3 middle(affine.worldFromObject[3]);
      const View view = makePerspectiveView(middle + scaleRange(affine.worldFromObject).y * glm::vec3(0.9f, 0.7f, 1.2f),
                                            middle, 0.7f, 0.01f, kSize);
      for (const bool isSphere : {true, false}) {
        const ObjectScene object = isSphere ? sphere(bits, affine.worldFromObject) : box(bits, affine.worldFromObject);
        const FrameLayers layers = draw(object, view, given(0, glm::vec3(0)));
        ASSERT_EQ(layers.thickness.size(), layers.id.size());
        const float voxel = object.fields.fields[0].levels[0].voxelSizeObject;
        std::size_t count = 0;
        float worst = 0;
        for (std::size_t i = 0; i < layers.id.size(); ++i) {
          if (layers.id[i] < 0) {
            ASSERT_EQ(layers.thickness[i], 0.0f);
            continue;
          }
          const PrimaryRay ray = rayOf(view, i);
          const glm::vec3 origin = transformPoint(objectFromWorld, ray.originWorld);
          const glm::vec3 direction = glm::mat3(objectFromWorld) * ray.directionWorld;
          const float length = glm::length(direction);
          float expected = 0;
          if (isSphere) {
            const float along = glm::dot(origin, direction / length), c = glm::dot(origin, origin) - kRadius * kRadius;
            const float root2 = along * along - c;
            if (root2 < 0.04f * kRadius * kRadius) continue;
            expected = 2 * std::sqrt(root2) / length;
          } else {
            const glm::vec2 t = crossBox(origin, direction);
            if (t.x >= t.y || std::min(toEdge(origin + t.x * direction), toEdge(origin + t.y * direction)) < voxel)
              continue;
            expected = t.y - t.x;
          }
          ++count;
          const float voxels = std::abs(layers.thickness[i] - expected) * length / voxel;
          worst = std::max(worst, voxels);
          ASSERT_LE(voxels, 0.5f) << affine.name << (isSphere ? " sphere" : " box") << " pixel " << i << ": "
                                  << layers.thickness[i] << " for " << expected;
        }
        EXPECT_GT(count, 1000u) << affine.name;
        if (affine.name == affineCases().front().name)
          fmt::print("{} of {} bits: within {:.3f} voxels\n", isSphere ? "sphere" : "box", bits, worst);
      }
    }
}

// Through both tubes of a ring, and not the hole.
TEST_F(Translucency, HolesCountForNothing) {
  constexpr float kRing = 0.4f, kTube = 0.1f;
  const ObjectScene ring([](glm::vec3 p) { return torusDistance(p, glm::vec3(0), kRing, kTube); },
                         {glm::vec3(-0.5f, -0.1f, -0.5f), glm::vec3(0.5f, 0.1f, 0.5f)}, 16);
  const View view = makePerspectiveView({0, 0, 2}, glm::vec3(0), 0.4f, 0.01f, {9, 9});
  EXPECT_NEAR(draw(ring, view, given(0, glm::vec3(0))).thickness[40], 4 * kTube, 0.5f * ring.voxelWorld);
}

// Of a sphere before a sun: what comes in behind is dimmed by its way, which Lambert's cosine decides too; wrapped, it
// reaches to where the sun shines on the front, over no way at all.
TEST_F(Translucency, LightOfTheBackIsDimmedByItsWay) {
  constexpr float kLux = 5, kShare = 0.75f;
  const glm::vec3 absorption(3, 1, 0);
  ObjectScene object = sphere(16);
  object.shine({0.3f, 0.2f, 1}, kLux);
  object.scene.materials[0].baseColor = {0.5f, 0.5f, 0.5f, 1};
  const glm::vec3 toSun = -object.lighting.lights[0].directionWorld;
  for (const float wrap : {0.0f, 0.5f}) {
    const FrameLayers layers = draw(object, kView, given(kShare, absorption, wrap));
    std::size_t count = 0;
    for (std::size_t i = 0; i < layers.id.size(); ++i) {
      const float cosine = layers.id[i] < 0 ? 0 : -glm::dot(layers.normalSurface[i], toSun);
      if (cosine < 0.05f) continue;
      ++count;
      const float weight = (cosine + wrap) / ((1 + wrap) * (1 + wrap));
      for (int c = 0; c < 3; ++c) {
        const float expected = kShare / kPi * kLux * weight * std::exp(-absorption[c] * 2 * kRadius * cosine);
        // Half a voxel of way, the normal's 1 %, and half floats.
        const float slack =
            expected * (0.5f * object.voxelWorld * absorption[c] + 0.002f) + 0.012f * kShare / kPi * kLux;
        ASSERT_NEAR(layers.color[i][c], expected, slack) << "wrap " << wrap << " pixel " << i << " cosine " << cosine;
      }
    }
    EXPECT_GT(count, 2000u);
  }
}

// What passes is not sent back; and the wrapped cosine's integral is that of a diffuse surface.
TEST_F(Translucency, SharesAddUp) {
  constexpr float kShare = 0.25f;
  ObjectScene object = sphere(16);
  object.shine({0, 0, -1}, kPi);
  const View view = makePerspectiveView({0, 0, 2}, glm::vec3(0), 0.3f, 0.01f, {9, 9});
  SurfaceBrdf brdf = makeBrdf(glm::vec3(1), 0, 1);
  brdf.diffuse *= 1 - kShare;
  const glm::vec3 up(0, 0, 1);
  EXPECT_NEAR(draw(object, view, given(kShare, glm::vec3(0))).color[40].x, kPi * evaluateBrdf(brdf, up, up, up).x,
              2e-3f);
  for (const double wrap : {0.0, 0.3, 1.0}) {
    double sum = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = 2 * (i + 0.5) / kSteps - 1;
      sum += 2 * std::numbers::pi * std::max(cosine + wrap, 0.0) / ((1 + wrap) * (1 + wrap)) * 2 / kSteps;
    }
    EXPECT_NEAR(sum, std::numbers::pi, 1e-3);
  }
}

// Of even surroundings of radiance 1, as much comes through as the way along the normal leaves.
TEST_F(Translucency, SurroundingsShineThrough) {
  ObjectScene object = sphere(16);
  object.lighting.environment.radiance.assign(128, glm::vec3(1));
  const View view = makePerspectiveView({0, 0, 2}, glm::vec3(0), 0.3f, 0.01f, {9, 9});
  const float clear = draw(object, view, given(0.5f, glm::vec3(0))).color[40].x;
  for (const float absorption : {0.5f, 2.0f}) {
    const float dimmed = draw(object, view, given(0.5f, glm::vec3(absorption))).color[40].x;
    EXPECT_NEAR(clear - dimmed, 0.5f * (1 - std::exp(-absorption * 2 * kRadius)), 4e-3f);
  }
}

TEST_F(Translucency, MaterialsSayWhatPasses) {
  ObjectScene object = sphere(16);
  object.shine({0, 0, 1}, kPi);
  Material& material = object.scene.materials[0];
  material.diffuseTransmission = 0.5f;
  material.diffuseTransmissionColor = {1, 0.5f, 0.25f};
  material.absorption = {0, 1, 0};
  const View view = makePerspectiveView({0, 0, 2}, glm::vec3(0), 0.3f, 0.01f, {9, 9});
  const glm::vec3 expected(0.5f, 0.25f * std::exp(-1.0f), 0.125f);
  const glm::vec3 found = draw(object, view, {TranslucencySource::Materials}).color[40];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 4e-3f);
  EXPECT_LT(draw(object, view, {}).color[40].x, 1e-3f) << "off";
  addAttributes(object.fields.fields[0], [](glm::vec3) {
    SurfaceAttributes attributes;
    attributes.metallic = 1;
    return attributes;
  });
  EXPECT_LT(draw(object, view, {TranslucencySource::Materials}).color[40].x, 1e-3f) << "metals are opaque";
}

} // namespace
} // namespace brickfield::test
