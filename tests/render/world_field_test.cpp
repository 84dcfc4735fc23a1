// The world field in whole frames: its views against closed forms, frames against the last one alone, and scenes of all
// sizes and places.
#include <array>
#include <map>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/gltf_import.h"
#include "shared/world_field_params.h"
#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

RendererSettings fieldSettings(const std::string& view, const FieldShape& shape,
                               FieldMethod method = FieldMethod::Exact) {
  RendererSettings settings;
  settings.view = view;
  settings.worldField.method = method;
  settings.worldField.always = true;
  settings.worldField.shape = shape;
  settings.worldField.rtsdf.coarseSize = 16;
  settings.worldField.rtsdf.fineSize = 32;
  return settings;
}

// Of the torus of hand_scenes, around the z axis; its triangles are chords, up to 0.0004 inside.
double torusDistance(glm::dvec3 p) { return std::hypot(std::hypot(p.x, p.y) - 0.6, p.z) - 0.22; }

struct TorusError {
  double worst = 0, rms = 0; // texels, of those within four texels of the surface
  std::size_t texels = 0;
};

TorusError torusError(const FieldVolumes& volumes, glm::dvec3 centerWorld, double scale) {
  const FieldVolume& volume = volumes.cascades[0];
  TorusError error;
  double squares = 0;
  std::size_t i = 0;
  for (int z = 0; z < volume.extent.z; ++z)
    for (int y = 0; y < volume.extent.y; ++y)
      for (int x = 0; x < volume.extent.x; ++x, ++i) {
        const glm::dvec3 point = (glm::dvec3(volume.firstTexel + glm::ivec3(x, y, z)) + 0.5) * volume.texelSize;
        const double truth =
            torusDistance((point + volumes.anchorWorld - centerWorld) / scale) * scale / volume.texelSize;
        const glm::ivec3 at(x, y, z), side = glm::min(at, volume.extent - 1 - at);
        if (std::abs(truth) > 4 || std::min({side.x, side.y, side.z}) < 5) continue; // borders end what lies behind
        const double off = std::abs(volume.distances[i] - truth);
        error.worst = std::max(error.worst, off);
        squares += off * off;
        ++error.texels;
      }
  error.rms = std::sqrt(squares / static_cast<double>(error.texels));
  return error;
}

class WorldFieldFrames : public GlTest {
protected:
  static constexpr glm::uvec2 kSize{96, 96};

  std::unique_ptr<Renderer> rendered(const TestScene& scene, const RendererSettings& settings) {
    auto renderer = scene.makeRenderer(context().info(), settings);
    renderer->render(scene.autoView(kSize));
    return renderer;
  }
  FieldVolumes fieldOf(const TestScene& scene, const RendererSettings& settings) {
    return rendered(scene, settings)->readWorldField();
  }
};

// In texels of each window: two cascades hold the torus in the coarser one and a part of it in the finer, which is
// read.
TEST_F(WorldFieldFrames, TorusIsTheSameAnywhereAndOfAnySize) {
  const FieldShape shape{1, 64, 0, true};
  const TorusError near = torusError(fieldOf(TestScene(makeTorusAlone(), "none"), fieldSettings("", shape)), {}, 1);
  ASSERT_GT(near.texels, 10000u);
  EXPECT_LT(near.rms, 0.025) << "chords take off up to 0.0004 m, of texels of 0.027 m";
  EXPECT_LT(near.worst, 0.15);
  for (const FieldShape& other : {shape, FieldShape{2, 64, 0, false}, FieldShape{1, 64, 0, false}})
    for (const float scale : {0.01f / 1.64f, 1.0f, 1e4f / 1.64f})
      for (const glm::vec3 place : {glm::vec3(0), glm::vec3(10000, -10000, 10000)}) {
        // A centimetre ten kilometres away is beyond what floats of the scene itself can place.
        if (scale < 1 && place != glm::vec3(0)) continue;
        const Scene scene = makeTransformedTorus(glm::scale(glm::translate(glm::mat4(1), place), glm::vec3(scale)));
        const FieldVolumes field = fieldOf(TestScene(scene, "none"), fieldSettings("", other));
        const TorusError error = torusError(field, place, scale);
        EXPECT_GT(error.texels, 2000u) << scale << " at " << place.x;
        EXPECT_LT(error.rms, near.rms + 0.01) << scale << " at " << place.x;
        EXPECT_LT(error.worst, near.worst + 0.05) << scale << " at " << place.x;
      }
}

// The plane through the middle cuts the torus in two disks; the picture is as wide as 1.1 times what the scene needs.
TEST_F(WorldFieldFrames, ViewCutsTheTorusWhereItIs) {
  const TestScene scene(makeTorusAlone(), "none");
  for (const bool isWhole : {true, false}) {
    const auto renderer = rendered(scene, fieldSettings("field", {isWhole ? 1 : 2, 64, 0, isWhole}));
    const std::vector<std::uint8_t> picture = renderer->readPicture();
    const glm::vec3 extent = scene.pose().boundsWorld.extent();
    const double pixel = 1.1 * std::max(extent.x, extent.z) / kSize.x; // metres
    const double texel = renderer->readWorldField().cascades.back().texelSize;
    std::size_t black = 0, inside = 0, outside = 0;
    for (std::size_t y = 0; y < kSize.y; ++y)
      for (std::size_t x = 0; x < kSize.x; ++x) {
        const double right = (static_cast<double>(x) + 0.5 - 0.5 * kSize.x) * pixel;
        const double down = (static_cast<double>(y) + 0.5 - 0.5 * kSize.y) * pixel; // y axis: up is -z
        const double truth = torusDistance({right, 0, down});
        const std::uint8_t* rgb = &picture[3 * (y * kSize.x + x)];
        const bool isBlack = rgb[0] + rgb[1] + rgb[2] == 0;
        black += isBlack;
        // Interpolation over a texel of a circle of 0.22 m.
        const double slack = texel * texel / (2 * 0.22);
        if (isBlack) {
          EXPECT_LT(std::abs(truth), 0.9 * pixel + slack) << x << "," << y;
        }
        if (std::abs(truth) < 0.9 * pixel - slack) {
          EXPECT_TRUE(isBlack) << x << "," << y;
        }
        if (truth < -pixel - slack) {
          ++inside;
          EXPECT_GT(rgb[0], rgb[2] + 50) << x << "," << y;
        }
        const bool isShown = std::abs(right) < 0.8 && std::abs(down) < 0.2;
        if (truth > pixel + slack && isShown) {
          ++outside;
          EXPECT_GE(rgb[2], rgb[0]) << x << "," << y;
        }
      }
    EXPECT_GT(black, 40u);
    EXPECT_GT(inside, 100u);
    EXPECT_GT(outside, 500u);
  }
}

TEST_F(WorldFieldFrames, ViewOfNodesTellsTwoObjectsApart) {
  const TestScene scene(makeInterpenetration(), "none");
  RendererSettings settings = fieldSettings("field-id", {1, 64, 0, true});
  settings.fieldSlice.axis = 2;
  const std::vector<std::uint8_t> picture = rendered(scene, settings)->readPicture();
  std::map<std::array<std::uint8_t, 3>, std::size_t> colors;
  for (std::size_t i = 0; i < picture.size(); i += 3) ++colors[{picture[i], picture[i + 1], picture[i + 2]}];
  const auto isNode = [](const std::uint8_t* rgb) { return rgb[0] != rgb[1] || rgb[1] != rgb[2]; };
  std::size_t large = 0;
  for (const auto& [color, count] : colors) large += count > 200 && isNode(color.data());
  EXPECT_EQ(large, 2u) << "a colour each";
  EXPECT_GT((colors[{128, 128, 128}]), 5u);
  std::size_t touching = 0;
  for (std::size_t i = 0; i + 3 < picture.size(); i += 3) {
    const std::uint8_t *here = &picture[i], *right = here + 3;
    touching += i / 3 % kSize.x + 1 < kSize.x && isNode(here) && isNode(right) && !std::equal(here, right, right);
  }
  EXPECT_EQ(touching, 0u) << "grey or a surface stands between them";
}

// From the camera: what the field's surface covers is what the mesh covers, but for a rim.
TEST_F(WorldFieldFrames, SurfaceCoversWhatTheMeshCovers) {
  const TestScene scene(makeTorusAlone(), "none");
  const auto renderer = rendered(scene, fieldSettings("field-surface", {1, 64, 0, true}));
  const std::vector<std::uint8_t> picture = renderer->readPicture();
  const FrameLayers layers = renderer->readLayers();
  std::size_t both = 0, differing = 0;
  for (std::size_t p = 0; p < layers.kind.size(); ++p) {
    const bool isHit = picture[3 * p] > 28; // what is missed is darker
    both += isHit && layers.kind[p] == SurfaceKind::Mesh;
    differing += isHit != (layers.kind[p] == SurfaceKind::Mesh);
  }
  EXPECT_GT(both, 500u);
  EXPECT_LT(differing, both / 20);
}

void expectSameBits(const FieldVolumes& made, const FieldVolumes& updated, const std::string& what) {
  ASSERT_EQ(made.cascades.size(), updated.cascades.size());
  EXPECT_EQ(made.anchorWorld, updated.anchorWorld) << what;
  for (std::size_t c = 0; c < made.cascades.size(); ++c)
    EXPECT_TRUE(made.cascades[c] == updated.cascades[c]) << what << ", cascade " << c;
}

// A sphere through a torus, both as meshes and as SDF objects; every other frame reads no field, so that changes add
// up.
TEST_F(WorldFieldFrames, FramesLeaveWhatTheLastAloneMakes) {
  const FieldShape shape{2, 64, 0.04, false};
  for (const char* sdf : {"none", "Sphere"}) {
    const TestScene scene(makeInterpenetration(), sdf, 16);
    const View view = scene.view({0.6f, 0.8f, 1.2f}, {0, 0, 0}, {32, 32});
    const auto poseAt = [&](int frame) {
      Pose pose = scene.pose();
      pose.instances[1].worldFromObject[3] = {0.8f * std::cos(0.4f * static_cast<float>(frame)), 0.1f, -0.3f, 1};
      return pose;
    };
    const RendererSettings on = fieldSettings("", shape);
    const auto moving = scene.makeRenderer(context().info(), on);
    for (int frame = 0; frame < 4; ++frame) {
      moving->setPose(poseAt(frame));
      moving->render(view);
    }
    EXPECT_GT(moving->fieldStats().valueTiles, 0u);
    EXPECT_LT(moving->fieldStats().valueTiles, moving->fieldStats().tiles);
    const auto alone = scene.makeRenderer(context().info(), on);
    alone->setPose(poseAt(3));
    alone->render(view);
    expectSameBits(alone->readWorldField(), moving->readWorldField(), sdf);
  }
}

// Poses of frames without a reader are not seen by the field; the next that reads it is whole all the same.
TEST_F(WorldFieldFrames, FieldIsWholeAfterFramesThatDidNotReadIt) {
  const TestScene scene(makeInterpenetration(), "none");
  RendererSettings settings = fieldSettings("field", {1, 64, 0.04, false}), picture = settings;
  settings.worldField.always = picture.worldField.always = false;
  picture.view = "";
  const View view = scene.view({0.6f, 0.8f, 1.2f}, {0, 0, 0}, {32, 32});
  const auto renderer = scene.makeRenderer(context().info(), settings);
  renderer->render(view);
  Pose pose = scene.pose();
  renderer->setSettings(picture);
  for (int frame = 0; frame < 3; ++frame) {
    pose.instances[1].worldFromObject[3].x -= 0.3f;
    renderer->setPose(pose);
    renderer->render(view);
  }
  renderer->setSettings(settings);
  renderer->render(view);
  EXPECT_EQ(renderer->fieldStats().movedInstances, 1u);
  const auto alone = scene.makeRenderer(context().info(), settings);
  alone->setPose(pose);
  alone->render(view);
  expectSameBits(alone->readWorldField(), renderer->readWorldField(), "after pictures");
}

TEST_F(WorldFieldFrames, SkinsLeaveWhatTheLastFrameAloneMakes) {
  if (!hasData()) return;
  const TestScene scene(dataFile("cesium_man.glb"), "none", 0, 0.6);
  const RendererSettings settings = fieldSettings("", {1, 64, 0.03, false});
  const View view = scene.autoView({32, 32});
  const auto moving = scene.makeRenderer(context().info(), settings);
  for (const double seconds : {0.4, 0.5, 0.6}) {
    PoseRequest request;
    request.seconds = seconds;
    moving->setPose(poseScene(scene.scene(), request));
    moving->render(view);
  }
  const auto alone = scene.makeRenderer(context().info(), settings);
  alone->render(view);
  expectSameBits(alone->readWorldField(), moving->readWorldField(), "cesium_man");
}

Scene triangles(const std::vector<glm::vec3>& corners) {
  Scene scene = makeTorusAlone();
  Primitive& primitive = scene.meshes[0].primitives[0];
  primitive.positions = corners;
  primitive.normals.assign(corners.size(), glm::vec3(0, 0, 1));
  primitive.tangents.clear();
  primitive.indices.clear();
  for (std::uint32_t i = 0; i < corners.size(); ++i) primitive.indices.push_back(i);
  return scene;
}

void expectFinite(const FieldVolumes& field, const std::string& what) {
  for (const FieldVolume& volume : field.cascades)
    EXPECT_TRUE(std::all_of(volume.distances.begin(), volume.distances.end(), [&](float texels) {
      return std::abs(texels) <= volume.rangeTexels;
    })) << what;
}

double leastOf(const FieldVolumes& field) {
  const std::vector<float>& distances = field.cascades[0].distances;
  return *std::min_element(distances.begin(), distances.end());
}

TEST_F(WorldFieldFrames, OneTriangleIsASheetOfOneTexel) {
  const FieldVolumes field =
      fieldOf(TestScene(triangles({{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "none"), fieldSettings("", {1, 64, 0, true}));
  expectFinite(field, "one triangle");
  const double texel = field.cascades[0].texelSize;
  for (const double z : {-2.5, -1.0, 0.0, 1.0, 2.5})
    for (const double x : {-0.2, 0.0, 0.3}) {
      const double sample =
          sampleField(field.cascades, glm::dvec3(x, 0.4, z * texel) - field.anchorWorld).distanceWorld;
      // Interpolated across the edge at zero it is half a texel short at most, elsewhere it is linear.
      EXPECT_NEAR(sample / texel, std::abs(z) - 0.5, z == 0 ? 0.51 : 0.02) << x << " " << z;
    }
}

// Scenes with little or nothing in them, and instances that no number places: either method leaves a field that holds
// numbers, and nothing where there is nothing.
TEST_F(WorldFieldFrames, NearlyEmptyScenesAreFields) {
  Scene empty = makeTorusAlone();
  empty.nodes[0].mesh = -1;
  const glm::vec3 same(0.5f, 0.25f, -0.75f);
  const std::vector<std::pair<std::string, Scene>> scenes{
      {"empty", empty},
      {"point", triangles({same, same, same})},
      {"line", triangles({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}})},
      {"triangle", triangles({{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}})},
  };
  for (const auto& [name, built] : scenes)
    for (const FieldMethod method : {FieldMethod::Exact, FieldMethod::Rtsdf})
      for (const char* view : {"field", "field-surface"}) {
        const TestScene scene(built, "none");
        const FieldVolumes field = fieldOf(scene, fieldSettings(view, {2, 64, 0, false}, method));
        expectFinite(field, name + " " + view);
        if (name == "empty") {
          EXPECT_GT(leastOf(field), 0) << fieldMethodName(method);
        }
        if (name == "triangle") {
          EXPECT_LE(leastOf(field), 0.1) << fieldMethodName(method);
        }
      }
}

TEST_F(WorldFieldFrames, InstancesThatNoNumberPlacesAreLeftOut) {
  const TestScene scene(makeInterpenetration(), "none");
  for (const FieldMethod method : {FieldMethod::Exact, FieldMethod::Rtsdf}) {
    RendererSettings settings = fieldSettings("field", {1, 64, 0.04, false}, method);
    const View view = scene.view({0.6f, 0.8f, 1.2f}, {0, 0, 0}, {32, 32});
    const auto renderer = scene.makeRenderer(context().info(), settings);
    renderer->render(view);
    Pose pose = scene.pose();
    pose.instances[1].worldFromObject[3].y = std::numeric_limits<float>::quiet_NaN();
    renderer->setPose(pose);
    renderer->render(view);
    const FieldVolumes field = renderer->readWorldField();
    expectFinite(field, fieldMethodName(method));
    const auto sampleAt = [&](glm::dvec3 point) {
      return sampleField(field.cascades, point - field.anchorWorld).distanceWorld;
    };
    if (method == FieldMethod::Rtsdf) continue; // its past fades
    EXPECT_LT(sampleAt({-0.6, 0, 0}), -0.1) << "the torus is there";
    EXPECT_GT(sampleAt({0.1, 0.1, 0}), 0.1) << "the sphere is not";
  }
}

} // namespace
} // namespace brickfield::test
