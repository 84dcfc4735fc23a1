// Temporal antialiasing: motion vectors against the projections of both frames in double precision, what it converges
// to against supersampling, and what is uncovered against a still scene.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/gtc/matrix_transform.hpp>

#include "passes/post/temporal.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/hand_scenes.h"
#include "tests/support/scene_frames.h"

namespace brickfield::test {
namespace {

constexpr glm::uvec2 kSize{160, 90};

RendererSettings withTaa() {
  RendererSettings settings;
  settings.taa.on = true;
  return settings;
}

glm::mat4 at(float x, float y, float z) { return glm::translate(glm::mat4(1), {x, y, z}); }

int addNode(Scene& scene, const std::string& name, Mesh mesh, const glm::mat4& place) {
  Node node;
  node.name = name;
  node.mesh = static_cast<int>(scene.meshes.size());
  node.matrix = place;
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(node);
  if (scene.scenes.empty()) scene.scenes.push_back({"scene", {}});
  scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()) - 1);
  return static_cast<int>(scene.nodes.size()) - 1;
}

// Pixels to the right and downwards from the picture's corner.
glm::dvec2 pixelOf(const View& view, glm::dvec3 pointWorld) {
  View still = view;
  still.jitterNdc = glm::vec2(0);
  const glm::dvec4 clip = clipFromEye(still) * glm::dvec4(pointWorld - glm::dvec3(view.eyeWorld), 1.0);
  return glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) * glm::dvec2(view.sizePixels);
}

class Taa : public GlTest {};

// A moving camera, a rigid mesh, an SDF object and a skinned and a morphed mesh that all move: each surface's vector is
// the difference of two projections. Half floats round it to one part in 2048, and depths of single precision move
// points by less than a hundredth of a pixel here.
TEST_F(Taa, MotionVectorsAreThoseOfTheProjections) {
  Scene built;
  addNode(built, "Wall", makeBoxMesh({3, 2, 0.1f}), at(0, 0, -1));
  addNode(built, "Rigid", makeSphereMesh(0.4f, 16, 32), at(-1, 0.4f, 0));
  addNode(built, "Sdf", makeTorusMesh(0.4f, 0.15f, 32, 16), at(1, 0.4f, 0));
  Mesh bent = makeBoxMesh({0.4f, 0.3f, 0.1f});
  Primitive& primitive = bent.primitives[0];
  primitive.influencesPerVertex = 4;
  for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
    primitive.joints.insert(primitive.joints.end(), {0, 0, 0, 0});
    primitive.jointWeights.insert(primitive.jointWeights.end(), {1, 0, 0, 0});
  }
  const int skinned = addNode(built, "Skinned", std::move(bent), glm::mat4(1));
  Mesh grown = makeBoxMesh({0.3f, 0.2f, 0.1f});
  MorphTarget target;
  target.positions.assign(grown.primitives[0].positions.size(), glm::vec3(0.5f, 0.25f, 0));
  grown.primitives[0].morphTargets.push_back(target);
  grown.morphWeights = {0};
  const int morphed = addNode(built, "Morphed", std::move(grown), at(0.6f, -0.7f, 0.2f));
  Node joint;
  joint.name = "Joint";
  joint.matrix = at(-0.6f, -0.7f, 0.2f);
  built.nodes.push_back(joint);
  const int jointNode = static_cast<int>(built.nodes.size()) - 1;
  built.scenes[0].nodes.push_back(jointNode);
  built.skins.push_back({"skin", {jointNode}, {glm::mat4(1)}});
  built.nodes[static_cast<std::size_t>(skinned)].skin = 0;
  const TestScene scene(std::move(built), "Sdf", 48);

  const auto renderer = scene.makeRenderer(context().info(), withTaa());
  const View first = scene.view({0, 0.2f, 4}, {0, 0, 0}, kSize, 50);
  View second = scene.view({0.15f, 0.25f, 3.9f}, {0.05f, 0, 0}, kSize, 50);
  Pose before = scene.pose(), after = before;
  const glm::mat4 turn = glm::rotate(glm::mat4(1), 0.1f, {0.2f, 1, 0.1f});
  for (PosedInstance& instance : after.instances) {
    const std::string& name = scene.scene().nodes[static_cast<std::size_t>(instance.node)].name;
    if (name == "Rigid" || name == "Sdf")
      instance.worldFromObject = instance.worldFromObject * at(0.1f, -0.05f, 0.1f) * turn;
    if (name == "Skinned") instance.worldFromBind[0] = instance.worldFromBind[0] * turn * at(0.05f, 0.1f, 0);
    if (name == "Morphed") instance.morphWeights[0] = 0.2f;
  }
  renderer->setPose(before);
  renderer->render(first);
  renderer->setPose(after);
  renderer->render(second);
  second.jitterNdc = 2.0f * taaJitter(1) / glm::vec2(kSize);
  const FrameLayers frame = renderer->readLayers();
  const std::vector<glm::vec2> motion = renderer->readMotion();
  std::vector<double> worst(scene.scene().nodes.size(), 0), largest(worst), count(worst);
  for (std::uint32_t y = 0; y < kSize.y; ++y)
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      const std::size_t i = std::size_t{y} * kSize.x + x;
      if (frame.id[i] < 0) continue;
      const PrimaryRay ray = primaryRay(second, {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
      const glm::dvec3 now = glm::dvec3(ray.originWorld) + double{frame.depth[i]} * glm::dvec3(ray.directionWorld);
      glm::dvec3 then = now;
      for (std::size_t n = 0; n < after.instances.size(); ++n) {
        const PosedInstance &a = before.instances[n], &b = after.instances[n];
        if (b.node != frame.id[i]) continue;
        const glm::dmat4 thenFromNow =
            b.node == skinned ? glm::dmat4(a.worldFromBind[0]) * glm::inverse(glm::dmat4(b.worldFromBind[0]))
                              : glm::dmat4(a.worldFromObject) * glm::inverse(glm::dmat4(b.worldFromObject));
        then = glm::dvec3(thenFromNow * glm::dvec4(now, 1.0));
        if (b.node == morphed) then -= 0.2 * glm::dvec3(0.5, 0.25, 0);
      }
      const glm::dvec2 expected = pixelOf(second, now) - pixelOf(first, then);
      const std::size_t node = static_cast<std::size_t>(frame.id[i]);
      const double off = glm::length(glm::dvec2(motion[i]) - expected);
      worst[node] = std::max(worst[node], off - glm::length(expected) / 2048);
      largest[node] = std::max(largest[node], glm::length(expected));
      ++count[node];
    }
  for (std::size_t node = 0; node < worst.size(); ++node) {
    if (static_cast<int>(node) == jointNode) continue;
    std::printf("%-8s %5.0f pixels, moved by up to %5.2f, off by %.5f pixels\n", scene.scene().nodes[node].name.c_str(),
                count[node], largest[node], worst[node]);
    EXPECT_GT(count[node], 100);
    EXPECT_GT(largest[node], 1);
    EXPECT_LE(worst[node], 0.01);
  }
}

// What no transform of its node tells is drawn: two instances of a node that move apart, and what was flat before; what
// is mirrored now has a transform that does. One mesh for all.
TEST_F(Taa, MotionVectorsOfInstancesAndOfWhatWasFlat) {
  Scene built;
  built.scenes.push_back({"scene", {}});
  built.meshes.push_back(makeSphereMesh(0.3f, 16, 32));
  for (int i = 0; i < 3; ++i) {
    Node node;
    node.name = "Node" + std::to_string(i);
    node.mesh = 0;
    built.nodes.push_back(node);
    built.scenes[0].nodes.push_back(i);
  }
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), withTaa());
  const auto posed = [&](const std::vector<glm::mat4>& places) { // of node 0 twice, of the others once
    Pose pose = scene.pose();
    PosedInstance second = pose.instances[0];
    second.instance = 1;
    pose.instances.insert(pose.instances.begin() + 1, second);
    for (std::size_t i = 0; i < places.size(); ++i) pose.instances[i].worldFromObject = places[i];
    return pose;
  };
  const auto scaled = [](const glm::mat4& place, glm::vec3 scale) { return glm::scale(place, scale); };
  const std::vector<glm::mat4> before{at(-1.2f, 0.5f, 0), at(-0.4f, 0.5f, 0), scaled(at(0.4f, 0.5f, 0), {1, 1, 0}),
                                      at(-0.6f, -0.5f, 0)};
  const std::vector<glm::mat4> after{at(-1.1f, 0.5f, 0), at(-0.4f, 0.6f, 0), at(0.5f, 0.5f, 0),
                                     scaled(at(-0.6f, -0.4f, 0), {1, -1, 1})};
  const View first = scene.view({0, 0.2f, 4}, {0, 0, 0}, kSize, 50);
  View second = scene.view({0.05f, 0.2f, 4}, {0, 0, 0}, kSize, 50);
  renderer->setPose(posed(before));
  renderer->render(first);
  renderer->setPose(posed(after));
  renderer->render(second);
  second.jitterNdc = 2.0f * taaJitter(1) / glm::vec2(kSize);
  const FrameLayers frame = renderer->readLayers();
  const std::vector<glm::vec2> motion = renderer->readMotion();
  std::vector<double> worst(after.size(), 0), count(worst);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (frame.id[i] < 0) continue;
    const PrimaryRay ray = primaryRay(second, glm::vec2(i % kSize.x, i / kSize.x) + 0.5f);
    const glm::dvec3 now = glm::dvec3(ray.originWorld) + double{frame.depth[i]} * glm::dvec3(ray.directionWorld);
    const std::size_t number = frame.id[i] > 0 ? static_cast<std::size_t>(frame.id[i]) + 1 : now.x < -0.75 ? 0 : 1;
    const glm::dmat4 thenFromNow = glm::dmat4(before[number]) * glm::inverse(glm::dmat4(after[number]));
    const glm::dvec2 expected = pixelOf(second, now) - pixelOf(first, glm::dvec3(thenFromNow * glm::dvec4(now, 1.0)));
    worst[number] =
        std::max(worst[number], glm::length(glm::dvec2(motion[i]) - expected) - glm::length(expected) / 2048);
    ++count[number];
  }
  for (std::size_t number = 0; number < worst.size(); ++number) {
    std::printf("instance %zu: %.0f pixels, off by %.5f\n", number, count[number], worst[number]);
    EXPECT_GT(count[number], 100);
    EXPECT_LE(worst[number], 0.01);
  }
}

double rmseOf(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::vec3 d = glm::min(a[i], glm::vec3(1)) - glm::min(b[i], glm::vec3(1));
    sum += glm::dot(d, d) / 3;
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// 64 frames of a still scene are the mean of 64 places of each pixel, but for what clipping holds back.
TEST_F(Taa, AStillSceneConvergesToItsSupersampledPicture) {
  constexpr std::uint32_t kTimes = 8;
  const TestScene scene(makeInterpenetration(), "Torus", 64);
  RendererSettings settings;
  settings.forcedLevel = 0; // the same at both sizes
  const View view = scene.autoView(kSize), large = scene.autoView(kSize * kTimes);
  const auto plain = scene.makeRenderer(context().info(), settings);
  plain->render(large);
  const FrameLayers fine = plain->readLayers();
  std::vector<glm::vec3> truth(std::size_t{kSize.x} * kSize.y, glm::vec3(0));
  for (std::uint32_t y = 0; y < fine.size.y; ++y)
    for (std::uint32_t x = 0; x < fine.size.x; ++x)
      truth[std::size_t{y / kTimes} * kSize.x + x / kTimes] +=
          fine.color[std::size_t{y} * fine.size.x + x] / static_cast<float>(kTimes * kTimes);
  plain->render(view);
  const double one = rmseOf(plain->readLayers().color, truth);
  settings.taa.on = true;
  const auto smooth = scene.makeRenderer(context().info(), settings);
  double after8 = 0;
  for (int frame = 0; frame < 64; ++frame) {
    smooth->render(view);
    if (frame == 7) after8 = rmseOf(smooth->readLayers().color, truth);
  }
  const double after64 = rmseOf(smooth->readLayers().color, truth);
  std::printf("rmse to 64 samples a pixel: one frame %.4f, 8 with TAA %.4f, 64 %.4f\n", one, after8, after64);
  EXPECT_LE(after8, one / 2);
  EXPECT_LE(after64, one / 4);
}

// A bright box flies past a dark wall; where it was a frame ago, and where it was before, the wall looks as if it never
// had been there. A single frame's shading at another place within its pixel differs by the wall's slow shading alone.
TEST_F(Taa, UncoveredSurfacesShowNoGhost) {
  Scene built;
  Material dark, bright;
  dark.baseColor = {0.05f, 0.05f, 0.06f, 1};
  bright.baseColor = {0.9f, 0.2f, 0.1f, 1};
  dark.metallic = bright.metallic = 0;
  built.materials = {dark, bright};
  Mesh wall = makeBoxMesh({3, 2, 0.1f}), box = makeBoxMesh({0.3f, 0.3f, 0.3f});
  wall.primitives[0].material = 0;
  box.primitives[0].material = 1;
  addNode(built, "Wall", std::move(wall), at(0, 0, -1));
  const int mover = addNode(built, "Box", std::move(box), at(-1, 0, 0));
  const TestScene scene(std::move(built), "none");
  const auto renderer = scene.makeRenderer(context().info(), withTaa());
  const View view = scene.view({0, 0.2f, 4}, {0, 0, 0}, kSize, 50);
  const auto poseAt = [&](int frame) {
    Pose pose = scene.pose();
    for (PosedInstance& instance : pose.instances)
      if (instance.node == mover) instance.worldFromObject = at(-1 + 0.17f * static_cast<float>(frame), 0, 0);
    return pose;
  };
  constexpr int kFrames = 9;
  std::vector<std::int32_t> before;
  std::vector<bool> everCovered(std::size_t{kSize.x} * kSize.y, false);
  FrameLayers frame;
  for (int i = 0; i < kFrames; ++i) {
    before = frame.id;
    renderer->setPose(poseAt(i));
    renderer->render(view);
    frame = renderer->readLayers();
    for (std::size_t p = 0; p < frame.id.size() && i + 1 < kFrames; ++p)
      everCovered[p] = everCovered[p] || frame.id[p] == mover;
  }
  // The wall alone, without antialiasing.
  const auto still = scene.makeRenderer(context().info());
  still->setPose(poseAt(100));
  still->render(view);
  const FrameLayers truth = still->readLayers();
  std::size_t fresh = 0, older = 0;
  float worstFresh = 0, worstOlder = 0, boxBrightness = 0;
  for (std::uint32_t y = 1; y + 1 < kSize.y; ++y)
    for (std::uint32_t x = 1; x + 1 < kSize.x; ++x) {
      const std::size_t p = std::size_t{y} * kSize.x + x;
      if (frame.id[p] == mover) boxBrightness = std::max(boxBrightness, frame.color[p].x);
      if (!everCovered[p]) continue;
      bool isWall = true; // not at the box's outline of now
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          isWall = isWall && frame.id[p + static_cast<std::size_t>(dy * static_cast<int>(kSize.x) + dx)] == 0;
      if (!isWall) continue;
      const float off = std::abs(frame.color[p].x - truth.color[p].x);
      (before[p] == mover ? fresh : older)++;
      float& worst = before[p] == mover ? worstFresh : worstOlder;
      worst = std::max(worst, off);
    }
  std::printf("%zu pixels uncovered last, %zu before: off by %.4f and %.4f; the box is at %.2f\n", fresh, older,
              worstFresh, worstOlder, boxBrightness);
  EXPECT_GT(fresh, 30u);
  EXPECT_GT(older, 300u);
  EXPECT_LE(worstFresh, 2.0f / 255);
  EXPECT_LE(worstOlder, 2.0f / 255);
  EXPECT_GT(boxBrightness, 0.2f);
}

// Switched off again, or never switched on: the same bytes.
TEST_F(Taa, OffLeavesNoTrace) {
  const TestScene scene(makeInterpenetration(), "Torus", 32);
  const View view = scene.autoView(kSize);
  const auto renderer = scene.makeRenderer(context().info());
  renderer->render(view);
  const std::vector<std::uint8_t> plain = renderer->readPicture();
  renderer->setSettings(withTaa());
  renderer->render(view);
  EXPECT_NE(renderer->readPicture(), plain) << "it samples other places";
  EXPECT_GT(renderer->stats().bytes.temporal, std::size_t{kSize.x} * kSize.y * 32);
  renderer->setSettings({});
  renderer->render(view);
  EXPECT_EQ(renderer->readPicture(), plain);
  EXPECT_EQ(renderer->stats().bytes.temporal, 0u);
}

TEST(TaaJitter, FillsThePixelEvenly) {
  glm::vec2 sum(0);
  std::vector<int> hits(64, 0);
  for (std::uint32_t frame = 0; frame < 64; ++frame) {
    const glm::vec2 place = taaJitter(frame);
    ASSERT_LT(std::max(std::abs(place.x), std::abs(place.y)), 0.5f + 1e-6f);
    sum += place;
    const glm::ivec2 cell = glm::min(glm::ivec2((place + 0.5f) * 8.0f), glm::ivec2(7));
    ++hits[static_cast<std::size_t>(cell.y * 8 + cell.x)];
  }
  EXPECT_LE(std::max(std::abs(sum.x), std::abs(sum.y)) / 64, 0.02f);
  EXPECT_GE(64 - std::count(hits.begin(), hits.end(), 0), 40); // random places would fill 40 of 64 cells
  EXPECT_EQ(taaJitter(0), taaJitter(64));
}

} // namespace
} // namespace brickfield::test
