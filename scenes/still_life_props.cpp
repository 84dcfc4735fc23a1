// Plain meshes around the SDF objects: spheres, books, a lamp, flowers that bend on a skeleton.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/shapes.h"
#include "scenes/still_life.h"
#include "scenes/textures.h"

namespace brickfield::scenes {
namespace {

constexpr float kTau = glm::two_pi<float>();
constexpr int kStemJoints = 5;
constexpr float kStemLength = 1.5f;

void addBook(StillLife& scene, const std::string& name, glm::vec3 center, float turnDegrees, glm::vec3 halfExtent,
             int cover, int paper) {
  // Cover: two boards and a spine; pages: a block that stands back from them on three sides.
  constexpr float kBoard = 0.012f;
  Shape boards = roundedBoxShape({halfExtent.x, kBoard, halfExtent.z}, 0.008f, 3);
  Shape top = boards;
  transform(top, glm::translate(glm::mat4(1), {0, halfExtent.y - kBoard, 0}));
  transform(boards, glm::translate(glm::mat4(1), {0, kBoard - halfExtent.y, 0}));
  append(boards, top);
  Shape spine = roundedBoxShape({kBoard, halfExtent.y, halfExtent.z}, 0.008f, 3);
  transform(spine, glm::translate(glm::mat4(1), {-halfExtent.x + kBoard, 0, 0}));
  append(boards, spine);
  Shape pages = roundedBoxShape({halfExtent.x - 0.02f, halfExtent.y - kBoard, halfExtent.z - 0.025f}, 0.004f, 1);
  int mesh = scene.glb.addMesh(name, {{scene.glb.addGeometry(boards), cover}, {scene.glb.addGeometry(pages), paper}});
  scene.glb.addNode(
      {.name = name, .translation = center, .rotation = rotationAbout({0, 1, 0}, turnDegrees), .mesh = mesh});
}

/// Stands on y = 0; height about 0.95.
void addLamp(StillLife& scene, glm::vec3 foot) {
  const std::array<ProfileCorner, 6> stand{{{{0, 0}},
                                            {{0.2f, 0}, 0.01f},
                                            {{0.2f, 0.035f}, 0.015f},
                                            {{0.022f, 0.05f}, 0.02f},
                                            {{0.018f, 0.62f}, 0.01f},
                                            {{0, 0.62f}}}};
  int standMesh =
      scene.mesh("Lamp stand", revolvedShape(roundedProfile(stand, 5, false), false, 64), scene.materials.brass);
  int parent = scene.glb.addNode({.name = "Lamp", .translation = foot, .mesh = standMesh});

  const std::array<ProfileCorner, 6> shade{{{{0, 0.92f}},
                                            {{0.12f, 0.92f}, 0.1f},
                                            {{0.36f, 0.60f}, 0.012f},
                                            {{0.345f, 0.595f}, 0.012f},
                                            {{0.11f, 0.895f}, 0.09f},
                                            {{0, 0.895f}}}};
  MaterialSpec opal{
      .name = "Opal shade", .baseColor = {0.9f, 0.82f, 0.66f}, .roughness = 0.6f, .emission = {0.85f, 0.52f, 0.22f}};
  scene.glb.addNode({.name = "Lamp shade",
                     .mesh = scene.mesh("Lamp shade", revolvedShape(roundedProfile(shade, 8, false), false, 96),
                                        scene.glb.addMaterial(opal))},
                    parent);
  MaterialSpec glow{.name = "Bulb",
                    .baseColor = {1, 0.9f, 0.75f},
                    .roughness = 0.5f,
                    .emission = {1, 0.74f, 0.42f},
                    .emissionStrength = 6.0f};
  scene.glb.addNode({.name = "Bulb",
                     .translation = {0, 0.70f, 0},
                     .mesh = scene.mesh("Bulb", sphereShape(0.085f, 32, 20), scene.glb.addMaterial(glow))},
                    parent);
  // Under the bulb, not in it: its own glass must not hide the light.
  NodeSpec light{.name = "Lamp light", .translation = {0, 0.56f, 0.12f}};
  light.light = scene.glb.addLight(
      {{"name", "Lamp light"}, {"type", "point"}, {"color", {1.0f, 0.62f, 0.3f}}, {"intensity", 3.5f}});
  scene.glb.addNode(light, parent);
}

/// A petal in the plane y = 0 from the origin along +X, cupped upwards.
Shape petalShape(float length, float width) {
  Shape petal = gridShape(6, 8, {}, [=](float u, float v) {
    float x = length * v;
    float half = width * std::sqrt(std::max(std::sin(glm::pi<float>() * std::pow(v, 0.75f)), 0.0f));
    float across = 2 * u - 1;
    return glm::vec3(x, 0.35f * half * across * across + 0.35f * x * v, -half * across);
  });
  smoothNormals(petal, 180);
  return petal;
}

Shape flowerShape(glm::vec3 petalColor) {
  Shape flower = tubeShape(
      {40, 10, false}, [](float along) { return glm::vec3(0, kStemLength * along, 0); },
      [](float) { return glm::vec3(1, 0, 0); }, [](float along, float) { return 0.02f - 0.008f * along; });
  paint(flower, glm::vec3(0.10f, 0.25f, 0.07f));
  const glm::mat4 top = glm::translate(glm::mat4(1), {0, kStemLength - 0.01f, 0});
  for (int ring = 0; ring < 2; ++ring) {
    int count = ring == 0 ? 9 : 7;
    for (int i = 0; i < count; ++i) {
      float turn = kTau * (static_cast<float>(i) + 0.5f * static_cast<float>(ring)) / static_cast<float>(count);
      Shape petal = petalShape(ring == 0 ? 0.24f : 0.18f, ring == 0 ? 0.075f : 0.06f);
      paint(petal,
            [&](glm::vec3 p) { return glm::mix(0.45f * petalColor, petalColor, std::clamp(p.x / 0.16f, 0.0f, 1.0f)); });
      float tilt = ring == 0 ? 0.15f : 0.7f;
      transform(petal, top * glm::rotate(glm::mat4(1), turn, {0, 1, 0}) * glm::rotate(glm::mat4(1), tilt, {0, 0, 1}));
      append(flower, petal);
    }
  }
  Shape heart = sphereShape(0.06f, 24, 16);
  paint(heart, glm::vec3(0.9f, 0.55f, 0.06f));
  transform(heart, top * glm::scale(glm::mat4(1), {1, 0.7f, 1}));
  append(flower, heart);
  for (int i = 0; i < 2; ++i) {
    Shape leaf = petalShape(0.34f, 0.06f);
    paint(leaf, glm::vec3(0.13f, 0.32f, 0.09f));
    glm::mat4 place = glm::translate(glm::mat4(1), {0, 0.82f + 0.16f * static_cast<float>(i), 0});
    transform(leaf, place * glm::rotate(glm::mat4(1), 0.8f + 2.6f * static_cast<float>(i), {0, 1, 0}) *
                        glm::rotate(glm::mat4(1), 0.55f, {0, 0, 1}));
    append(flower, leaf);
  }
  return flower;
}

/// Weights: along the stem each point hangs on the two joints it lies between; the head on the last.
void bindToStem(Shape& flower) {
  constexpr float kSpacing = kStemLength / kStemJoints;
  for (glm::vec3 p : flower.positions) {
    float place = std::clamp(p.y / kSpacing - 0.5f, 0.0f, static_cast<float>(kStemJoints - 1));
    auto lower = std::min(static_cast<int>(place), kStemJoints - 2);
    float share = place - static_cast<float>(lower);
    flower.joints.push_back({static_cast<std::uint8_t>(lower), static_cast<std::uint8_t>(lower + 1), 0, 0});
    flower.jointWeights.push_back({1 - share, share, 0, 0});
  }
}

struct StemPose {
  std::string name;
  glm::vec3 foot;
  float turnDegrees; ///< which way it leans
  float bendDegrees; ///< at every joint
  float phase;       ///< of the sway, 0 to 1
};

void addStem(StillLife& scene, int mesh, const StemPose& pose) {
  constexpr float kSpacing = kStemLength / kStemJoints;
  std::vector<int> joints;
  std::vector<glm::mat4> jointFromBind;
  int parent = scene.glb.addNode(
      {.name = pose.name + " root", .translation = pose.foot, .rotation = rotationAbout({0, 1, 0}, pose.turnDegrees)});
  for (int i = 0; i < kStemJoints; ++i) {
    float rest = i == 0 ? 0.5f * pose.bendDegrees : pose.bendDegrees;
    parent = scene.glb.addNode({.name = pose.name + " joint " + std::to_string(i),
                                .translation = {0, i == 0 ? 0.0f : kSpacing, 0},
                                .rotation = rotationAbout({0, 0, -1}, rest)},
                               parent);
    joints.push_back(parent);
    jointFromBind.push_back(glm::translate(glm::mat4(1), {0, -kSpacing * static_cast<float>(i), 0}));
    if (i == 0) continue; // the foot stands still
    ChannelSpec sway{parent, "rotation", {}, {}};
    for (int key = 0; key <= 16; ++key) {
      float share = static_cast<float>(key) / 16.0f;
      float angle = rest + 3.5f * (std::sin(kTau * (2 * share + pose.phase)) - std::sin(kTau * pose.phase));
      glm::quat rotation = rotationAbout({0, 0, -1}, angle);
      sway.seconds.push_back(8.0f * share);
      sway.values.insert(sway.values.end(), {rotation.x, rotation.y, rotation.z, rotation.w});
    }
    scene.channels.push_back(sway);
  }
  int skin = scene.glb.addSkin(pose.name, joints, jointFromBind);
  scene.glb.addNode({.name = pose.name, .mesh = mesh, .skin = skin});
}

} // namespace

void addFlowers(StillLife& scene) {
  const glm::vec3 foot(-3.15f, 0, 0.15f);
  const std::array<ProfileCorner, 9> vase{{{{0, 0}},
                                           {{0.17f, 0}, 0.02f},
                                           {{0.36f, 0.38f}, 0.28f},
                                           {{0.11f, 0.74f}, 0.14f},
                                           {{0.17f, 0.92f}, 0.014f},
                                           {{0.145f, 0.925f}, 0.014f},
                                           {{0.085f, 0.74f}, 0.12f},
                                           {{0.32f, 0.38f}, 0.26f},
                                           {{0, 0.04f}}}};
  MaterialSpec ink{.name = "Ink glaze", .baseColor = {0.035f, 0.075f, 0.17f}, .roughness = 0.22f};
  Shape shape = revolvedShape(roundedProfile(vase, 9, false), false, 80);
  scene.glb.addNode({.name = "Vase",
                     .translation = foot,
                     .mesh = scene.mesh("Vase", shape, scene.glb.addMaterial(ink)),
                     .extras = sdfExtras(128)});
  scene.contacts.push_back({{foot.x, foot.z}, 0.27f});

  MaterialSpec petals{.name = "Flower", .roughness = 0.6f, .doubleSided = true};
  int material = scene.glb.addMaterial(petals);
  auto flowerMesh = [&](const char* name, glm::vec3 color) {
    Shape flower = flowerShape(color);
    bindToStem(flower);
    return scene.mesh(name, flower, material);
  };
  int white = flowerMesh("White flower", {0.92f, 0.88f, 0.80f});
  int pink = flowerMesh("Pink flower", {0.90f, 0.30f, 0.33f});
  glm::vec3 inVase = foot + glm::vec3(0, 0.30f, 0);
  addStem(scene, pink, {"Flower A", inVase, -50, 9, 0.0f});
  addStem(scene, white, {"Flower B", inVase + glm::vec3(0.03f, 0.18f, 0), -110, 5, 0.3f});
  addStem(scene, pink, {"Flower C", inVase + glm::vec3(-0.03f, 0.05f, 0), -165, 10, 0.6f});
}

void addSpheres(StillLife& scene) {
  MaterialSpec chequer{.name = "Chequer", .roughness = 0.3f};
  chequer.baseColorTexture.texture =
      scene.glb.addTexture("Chequer", chequerBaseColor(256, 16, 8, {0.86f, 0.83f, 0.76f}, {0.035f, 0.03f, 0.035f}));
  int chequered = scene.mesh("Chequered sphere", sphereShape(0.3f, 64, 40), scene.glb.addMaterial(chequer));
  scene.glb.addNode({.name = "Chequered sphere",
                     .translation = {-2.55f, 0.3f, 1.75f},
                     .rotation = rotationAbout({1, 0, 0.5f}, 28),
                     .mesh = chequered});
  scene.contacts.push_back({{-2.55f, 1.75f}, 0.12f, 0.0f});

  struct Ball {
    const char* name;
    glm::vec2 xz;
    float radius;
    glm::vec3 color;
    float roughness;
  };
  const std::array<Ball, 4> balls{{{"Chrome ball", {-0.2f, 2.35f}, 0.21f, {0.86f, 0.87f, 0.88f}, 0.12f},
                                   {"Gold ball", {1.35f, 2.2f}, 0.16f, {1.0f, 0.72f, 0.32f}, 0.22f},
                                   {"Rose ball", {1.72f, 1.75f}, 0.2f, {0.95f, 0.60f, 0.54f}, 0.3f},
                                   {"Dark ball", {0.2f, 2.55f}, 0.12f, {0.30f, 0.33f, 0.40f}, 0.25f}}};
  int geometry = scene.glb.addGeometry(sphereShape(1.0f, 64, 40));
  for (const Ball& ball : balls) {
    MaterialSpec metal{.name = ball.name, .baseColor = ball.color, .metallic = 1.0f, .roughness = ball.roughness};
    int mesh = scene.glb.addMesh(ball.name, {{geometry, scene.glb.addMaterial(metal)}});
    scene.glb.addNode({.name = ball.name,
                       .translation = {ball.xz.x, ball.radius, ball.xz.y},
                       .scale = glm::vec3(ball.radius),
                       .mesh = mesh});
    scene.contacts.push_back({ball.xz, 0.4f * ball.radius, 0.0f});
  }
}

void addBooksAndLamp(StillLife& scene) {
  int linen = scene.glb.addTexture("Linen normal", linenNormal(256));
  auto cloth = [&](const char* name, glm::vec3 color) {
    MaterialSpec spec{.name = name, .baseColor = color, .roughness = 0.8f};
    spec.normalTexture = {linen, 0, 3.0f};
    return scene.glb.addMaterial(spec);
  };
  int paper = scene.glb.addMaterial({.name = "Paper", .baseColor = {0.80f, 0.73f, 0.58f}, .roughness = 0.9f});
  struct Book {
    const char* name;
    glm::vec3 color;
    glm::vec3 halfExtent;
    float turnDegrees;
  };
  const std::array<Book, 4> books{{{"Red book", {0.42f, 0.05f, 0.05f}, {0.56f, 0.085f, 0.42f}, 14},
                                   {"Blue book", {0.04f, 0.11f, 0.28f}, {0.52f, 0.065f, 0.40f}, -8},
                                   {"Cream book", {0.74f, 0.62f, 0.42f}, {0.46f, 0.075f, 0.36f}, 22},
                                   {"Green book", {0.05f, 0.20f, 0.11f}, {0.42f, 0.055f, 0.32f}, 3}}};
  const glm::vec3 foot(3.3f, 0, -0.25f);
  float height = 0;
  for (const Book& book : books) {
    addBook(scene, book.name, foot + glm::vec3(0, height + book.halfExtent.y, 0), book.turnDegrees + 150,
            book.halfExtent, cloth(book.name, book.color), paper);
    height += 2 * book.halfExtent.y;
  }
  scene.contacts.push_back({{foot.x, foot.z}, 0.56f});
  addLamp(scene, foot + glm::vec3(0, height, 0));
}

} // namespace brickfield::scenes
