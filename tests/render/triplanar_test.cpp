// Textures of SDF objects without attributes, projected along the axes of object space: colours of single texels in
// closed form, normals of a flat normal map, and whole pictures against the reference, which has a twin of the look-up.
#include <numbers>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "bakers/reference.h"
#include "field/analytic.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{160, 120};
constexpr int kTexels = 4;
constexpr float kMetres = 0.8f; // a texture spans; a texel is 20 cm

// Of 4 x 4 texels, no two alike and none symmetrical: red by the column, green by the row.
std::uint8_t redOf(int column) { return static_cast<std::uint8_t>(40 + 60 * column); }
std::uint8_t greenOf(int row) { return static_cast<std::uint8_t>(30 + 70 * row); }

Image columnsAndRows() {
  Image image{"columns", {kTexels, kTexels}, {}};
  for (int row = 0; row < kTexels; ++row)
    for (int column = 0; column < kTexels; ++column)
      image.rgba.insert(image.rgba.end(), {redOf(column), greenOf(row), 128, 255});
  return image;
}

// One normal everywhere, of which a code is 2 / 255.
Image oneNormal(glm::vec3 unit) {
  Image image{"normal", {1, 1}, {}};
  for (int c = 0; c < 3; ++c) image.rgba.push_back(static_cast<std::uint8_t>(std::lround((unit[c] + 1) * 127.5f)));
  image.rgba.push_back(255);
  return image;
}

// One object under `worldFromObject`, without lights, of a field that has no attributes.
struct TexturedScene {
  Scene scene;
  SceneFields fields;
  Lighting lighting{{}, {{16, 8}, std::vector<glm::vec3>(128, glm::vec3(1))}};

  TexturedScene(const DistanceFunction& distance, Box box, const glm::mat4& worldFromObject = glm::mat4(1)) {
    Material material;
    material.metallic = 0;
    material.baseColorTexture.texture = 0;
    scene = makeBoxAlone(std::move(material), worldFromObject);
    scene.images = {columnsAndRows(), oneNormal(glm::normalize(glm::vec3(0.5f, 0.3f, 0.8f)))};
    for (const int image : {0, 1}) {
      SceneTexture texture;
      texture.image = image;
      texture.magnify = texture.minify = Filter::Nearest;
      texture.mipmap.reset();
      scene.textures.push_back(texture);
    }
    fields.fields.push_back(makeAnalyticField(distance, box, 96, 16, 1));
    fields.fieldOfNode = {0};
    fields.triplanarOfNode = {kMetres};
  }
};

TexturedScene texturedBox(const glm::mat4& worldFromObject = glm::mat4(1)) {
  constexpr float kHalf = 0.7f;
  return {[](glm::vec3 p) { return boxDistance(p, glm::vec3(0), glm::vec3(kHalf)); },
          {glm::vec3(-kHalf), glm::vec3(kHalf)},
          worldFromObject};
}

// What a texel of a side says at a point of it, in stored codes; nothing beside the border of two texels.
std::optional<glm::vec2> codesAt(glm::vec2 uvMetres) {
  const glm::vec2 texels = uvMetres / kMetres * static_cast<float>(kTexels), part = glm::fract(texels);
  if (glm::any(glm::lessThan(part, glm::vec2(0.1f))) || glm::any(glm::greaterThan(part, glm::vec2(0.9f)))) return {};
  const auto wrapped = [](float at) { return ((static_cast<int>(std::floor(at)) % kTexels) + kTexels) % kTexels; };
  return glm::vec2(redOf(wrapped(texels.x)), greenOf(wrapped(texels.y)));
}

// The six sides as their texture is meant to lie on them: u to the right of who looks, v downwards.
glm::vec2 uvOnSide(glm::vec3 n, glm::vec3 p) {
  if (n.x > 0.9f) return {-p.z, -p.y};
  if (n.x < -0.9f) return {p.z, -p.y};
  if (n.y > 0.9f) return {p.x, p.z};
  if (n.y < -0.9f) return {p.x, -p.z};
  return n.z > 0 ? glm::vec2(p.x, -p.y) : glm::vec2(-p.x, -p.y);
}

class Triplanar : public GlTest {
protected:
  FrameLayers draw(const TexturedScene& textured, const View& view) {
    Renderer renderer(context().info());
    renderer.setScene(textured.scene, textured.fields);
    renderer.setPose(poseScene(textured.scene, {}));
    renderer.setLighting(textured.lighting);
    renderer.render(view);
    return renderer.readLayers();
  }
};

glm::vec3 pointOf(const FrameLayers& layers, const View& view, std::size_t i) {
  const PrimaryRay ray = primaryRay(view, glm::vec2(i % layers.size.x, i / layers.size.x) + 0.5f);
  return ray.originWorld + layers.depth[i] * ray.directionWorld;
}

glm::vec2 storedCodes(glm::vec3 linear) { return 255.0f * glm::vec2(srgbFromLinear(linear)); }

// All six sides, also where the object is turned, mirrored and squeezed: textures are fixed to it.
TEST_F(Triplanar, SidesOfABoxHaveTheirTexels) {
  for (const AffineCase& affine : affineCases()) {
    const TexturedScene box = texturedBox(affine.worldFromObject);
    const glm::mat4 objectFromWorld = glm::inverse(affine.worldFromObject);
    const glm::vec3 middle(affine.worldFromObject[3]);
    std::array<std::size_t, 6> seen{};
    for (int side = 0; side < 6; ++side) {
      glm::vec3 outward(0.2f, 0.3f, 0.25f); // of the object, so that squeezed ones show each side too
      outward[side / 2] = side % 2 == 0 ? 2.5f : -2.5f;
      const View view =
          makePerspectiveView(middle + glm::mat3(affine.worldFromObject) * outward, middle, 0.8f, 0.001f, kSize);
      const FrameLayers layers = draw(box, view);
      for (std::size_t i = 0; i < layers.id.size(); ++i) {
        if (layers.id[i] < 0) continue;
        const glm::vec3 p = transformPoint(objectFromWorld, pointOf(layers, view, i));
        const glm::vec3 inside = 0.7f - glm::abs(p);
        const int axis = inside.x < inside.y ? (inside.x < inside.z ? 0 : 2) : (inside.y < inside.z ? 1 : 2);
        float rim = 1; // metres to the nearest edge: there the field's normal turns
        for (int other = 0; other < 3; ++other)
          if (other != axis) rim = std::min(rim, inside[other]);
        if (rim < 0.05f) continue;
        glm::vec3 n(0);
        n[axis] = p[axis] < 0 ? -1.0f : 1.0f;
        const std::optional<glm::vec2> codes = codesAt(uvOnSide(n, p));
        if (!codes) continue;
        ++seen[static_cast<std::size_t>(2 * axis + (p[axis] < 0 ? 1 : 0))];
        const glm::vec2 found = storedCodes(layers.albedo[i]);
        ASSERT_NEAR(found.x, codes->x, 1) << affine.name << " axis " << axis << " pixel " << i;
        ASSERT_NEAR(found.y, codes->y, 1) << affine.name << " axis " << axis << " pixel " << i;
      }
    }
    for (const std::size_t count : seen) EXPECT_GT(count, 50u) << affine.name;
  }
}

// Between two sides both count for a half, in linear light.
TEST_F(Triplanar, SlopesBlendTheirSides) {
  const float half = std::numbers::sqrt2_v<float> / 2;
  const glm::vec3 slope(half, 0, half);
  const TexturedScene plane([&](glm::vec3 p) { return planeDistance(p, slope, 0); },
                            {glm::vec3(-0.7f), glm::vec3(0.7f)});
  const View view = makePerspectiveView(2.0f * slope, glm::vec3(0), 0.6f, 0.01f, kSize);
  const FrameLayers layers = draw(plane, view);
  std::size_t count = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    if (layers.id[i] < 0 || glm::dot(layers.normalSurface[i], slope) < 0.9999f) continue;
    const glm::vec3 p = pointOf(layers, view, i);
    const auto x = codesAt({-p.z, -p.y}), z = codesAt({p.x, -p.y});
    if (!x || !z) continue;
    ++count;
    const auto linear = [](glm::vec2 codes) { return glm::vec2(linearFromSrgb(glm::vec3(codes, 0) / 255.0f)); };
    const glm::vec2 expected = storedCodes(glm::vec3(0.5f * (linear(*x) + linear(*z)), 0));
    const glm::vec2 found = storedCodes(layers.albedo[i]);
    // A normal that is off by 1 % moves the weights by 4 %, the colours by a few codes of the 180 that they differ by.
    ASSERT_NEAR(found.x, expected.x, 6) << i;
    ASSERT_NEAR(found.y, expected.y, 6) << i;
  }
  EXPECT_GT(count, 2000u);
}

// The map's x to the right, its y up, its z outwards, on each side.
TEST_F(Triplanar, NormalMapsLieOnTheirSides) {
  TexturedScene box = texturedBox();
  box.scene.materials[0].normalTexture.texture = 1;
  const auto& codes = box.scene.images[1].rgba;
  const glm::vec3 mapped = glm::normalize(glm::vec3(codes[0], codes[1], codes[2]) / 127.5f - 1.0f);
  struct Side {
    glm::vec3 outward, right, up;
  };
  for (const Side& side : {Side{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, Side{{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                           Side{{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, Side{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                           Side{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, Side{{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}) {
    const View view = makePerspectiveView(3.0f * side.outward + 0.1f * side.up, glm::vec3(0), 0.3f, 0.01f, {9, 9});
    const FrameLayers layers = draw(box, view);
    const glm::vec3 expected = mapped.x * side.right + mapped.y * side.up + mapped.z * side.outward;
    EXPECT_LT(glm::distance(layers.normal[40], expected), 2e-3f);
    EXPECT_LT(glm::distance(layers.normalSurface[40], side.outward), 2e-3f) << "what it was before";
  }
}

// Filtered textures on a round thing: what the two make of footprints differs by little.
TEST_F(Triplanar, IsTheReferences) {
  TexturedScene sphere([](glm::vec3 p) { return sphereDistance(p, glm::vec3(0), 0.7f); },
                       {glm::vec3(-0.7f), glm::vec3(0.7f)}, glm::scale(glm::mat4(1), {1, 0.6f, 1.3f}));
  for (SceneTexture& texture : sphere.scene.textures) {
    texture.magnify = texture.minify = Filter::Linear;
    texture.mipmap = Filter::Linear;
  }
  sphere.scene.materials[0].normalTexture.texture = 1;
  const Pose pose = poseScene(sphere.scene, {});
  for (const float metres : {kMetres, 0.05f}) { // texels of 20 cm and of 1 cm, which are a pixel wide and less
    sphere.fields.triplanarOfNode = {metres};
    const View view = makePerspectiveView({1.1f, 0.9f, 1.3f}, glm::vec3(0), 0.9f, 0.01f, kSize);
    const FrameLayers layers = draw(sphere, view);
    ReferenceRequest request;
    request.scene = &sphere.scene, request.pose = &pose, request.view = &view, request.lighting = &sphere.lighting;
    request.fields = {&sphere.fields.fields, &sphere.fields.fieldOfNode, &sphere.fields.triplanarOfNode};
    const FrameLayers truth = traceReference(request);
    double colors = 0, angles = 0, light = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < layers.id.size(); ++i) {
      if (layers.id[i] < 0 || truth.id[i] < 0) continue;
      ++count;
      colors += glm::distance(srgbFromLinear(layers.albedo[i]), srgbFromLinear(truth.albedo[i]));
      angles += glm::degrees(std::acos(std::min(glm::dot(layers.normal[i], truth.normal[i]), 1.0f)));
      light += std::abs(layers.color[i].y - truth.color[i].y);
    }
    const auto pixels = static_cast<double>(count);
    fmt::print("{} m: colours {:.4f}, normals {:.2f} degrees, light {:.4f}\n", metres, colors / pixels, angles / pixels,
               light / pixels);
    EXPECT_GT(count, 5000u);
    EXPECT_LE(colors / pixels, 0.01);
    EXPECT_LE(angles / pixels, 0.5);
    EXPECT_LE(light / pixels, 0.01);
  }
}

} // namespace
} // namespace brickfield::test
