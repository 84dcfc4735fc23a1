// The paper's figure 5 (Tan and others 2022): a teapot on a circular path, whose surface ghosts in RTSDF where it was.
// The exact field keeps no ghost: after each frame it is to the bit what it would be without a past.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/gtc/constants.hpp>

#include "scene/gltf_import.h"
#include "tests/support/data.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/world_field_stage.h"

namespace brickfield::test {
namespace {

constexpr int kFrames = 60;
constexpr double kTurnSeconds = 1;

int addNode(Scene& scene, const std::string& name, int parent, int mesh = -1) {
  const int number = static_cast<int>(scene.nodes.size());
  Node node;
  node.name = name;
  node.parent = parent;
  node.mesh = mesh;
  scene.nodes.push_back(node);
  (parent < 0 ? scene.scenes[0].nodes : scene.nodes[static_cast<std::size_t>(parent)].children).push_back(number);
  return number;
}

/// A square of the given half side, facing +Y.
Mesh makePlaneMesh(float halfSide) {
  Primitive primitive;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1)}) {
    primitive.positions.emplace_back(corner.x * halfSide, 0, corner.y * halfSide);
    primitive.normals.emplace_back(0, 1, 0);
  }
  primitive.indices = {0, 1, 2, 0, 2, 3};
  Mesh mesh;
  mesh.name = "Plane";
  mesh.primitives.push_back(std::move(primitive));
  return mesh;
}

/// The teapot, a metre long, two centimetres over a plane of three; a pivot carries it around once in kTurnSeconds.
Scene makeTeapotPath() {
  Scene scene;
  scene.name = "teapot path";
  scene.scenes.push_back({"scene", {}});
  scene.meshes = {makePlaneMesh(1.5f), importGltf(dataFile("utah_teapot_2464.glb")).meshes[0]};
  for (Primitive& primitive : scene.meshes[1].primitives) primitive.material = -1; // those were the file's
  addNode(scene, "Plane", -1, 0);
  const int pivot = addNode(scene, "Pivot", -1);
  const int teapot = addNode(scene, "Teapot", pivot, 1);
  scene.nodes[static_cast<std::size_t>(teapot)].translation = {0.8f, 0.02f, 0};

  AnimationChannel channel;
  channel.node = pivot;
  channel.property = AnimatedProperty::Rotation;
  channel.components = 4;
  for (int quarter = 0; quarter <= 4; ++quarter) {
    const float halfAngle = glm::pi<float>() / 4 * static_cast<float>(quarter);
    channel.seconds.push_back(static_cast<float>(kTurnSeconds) / 4 * static_cast<float>(quarter));
    for (const float part : {0.0f, std::sin(halfAngle), 0.0f, std::cos(halfAngle)}) channel.values.push_back(part);
  }
  scene.animations.push_back({"around", {channel}});
  return scene;
}

/// Four times around, at first by less than a texel, at last by more than half its own length a frame.
double secondsOf(int frame) {
  const double part = static_cast<double>(frame) / kFrames;
  return std::fmod(4 * part * part, 1.0) * kTurnSeconds;
}

std::size_t differingTexels(const FieldSnapshot& a, const FieldSnapshot& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.distances.size(); ++i)
    count += std::bit_cast<std::uint32_t>(a.distances[i]) != std::bit_cast<std::uint32_t>(b.distances[i]) ||
             a.nodes[i] != b.nodes[i];
  return count;
}

class TeapotPath : public GlTest {};

TEST_F(TeapotPath, EveryFrameEqualsTheFieldMadeFromNothing) {
  BRICKFIELD_NEEDS_DATA("utah_teapot_2464.glb");
  const Scene scene = makeTeapotPath();
  const FieldShape shape{1, 64, 0, true};
  WorldFieldStage moving(scene, {}, shape);
  FieldSnapshot before;
  std::size_t mostTiles = 0, mostChanged = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double seconds = secondsOf(frame);
    moving.frameAt(seconds);
    WorldFieldStage fromNothing(scene, {}, shape);
    fromNothing.frameAt(seconds);
    const FieldSnapshot updated = moving.read(), made = fromNothing.read();
    ASSERT_EQ(updated.window, made.window) << "frame " << frame;
    ASSERT_EQ(updated.distances.size(), 64u * 64u * 64u);
    EXPECT_EQ(differingTexels(updated, made), 0u) << "frame " << frame;

    // Only a part was made anew, and the teapot did move.
    if (frame > 0) {
      mostTiles = std::max<std::size_t>(mostTiles, moving.field().exact().lengthOf(ExactField::List::Keys));
      const std::size_t changed = differingTexels(updated, before);
      EXPECT_GT(changed, 100u) << "frame " << frame;
      mostChanged = std::max(mostChanged, changed);
    }
    before = updated;
  }
  std::printf("teapot path: at most %zu of 512 tiles have new keys, %zu of %zu texels change\n", mostTiles, mostChanged,
              before.distances.size());
  EXPECT_LT(mostTiles, 128u) << "too much was made anew";
}

} // namespace
} // namespace brickfield::test
