// The objects that are drawn as SDFs: teapots, knot, porous ball, pebble, gear, cup, vase; with the meshes that cut
// them.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/shapes.h"
#include "scenes/still_life.h"
#include "scenes/teapot_patches.h"
#include "scenes/textures.h"

namespace brickfield::scenes {
namespace {

/// Scales a podium's side and top textures to metres.
void addPodium(StillLife& scene, const std::string& name, glm::vec3 foot, float radius, float height) {
  Shape shape = podiumShape(radius, height, 0.045f, 96);
  for (std::size_t i = 0; i < shape.uvs.size(); ++i) {
    glm::vec3 p = shape.positions[i];
    bool isTop = std::abs(shape.normals[i].y) > 0.7f;
    shape.uvs[i] = isTop ? glm::vec2(p.x, p.z) : glm::vec2(shape.uvs[i].x * std::round(6.2832f * radius), p.y);
  }
  scene.glb.addNode({.name = name, .translation = foot, .mesh = scene.mesh(name, shape, scene.materials.terrazzo)});
  scene.contacts.push_back({{foot.x, foot.z}, radius});
}

void addKnot(StillLife& scene) {
  addPodium(scene, "Tall podium", {1.95f, 0, -1.15f}, 0.62f, 1.12f);
  int mesh = scene.mesh("Trefoil", trefoilShape(0.46f, 0.135f, 240, 40, 0.10f), scene.materials.brass);
  glm::quat upright = rotationAbout({1, 0, 0}, 82);
  NodeSpec pivot{.name = "Trefoil pivot", .translation = {1.95f, 1.92f, -1.15f}};
  int parent = scene.glb.addNode(pivot);
  scene.glb.addNode({.name = "Trefoil", .rotation = upright, .mesh = mesh, .extras = sdfExtras(160)}, parent);
  scene.channels.push_back(spinChannel(parent, pivot.rotation, {0, 1, 0}, 8.0f));
}

void addPorousBall(StillLife& scene) {
  const glm::vec3 foot(-2.0f, 0, -0.95f);
  Shape block = roundedBoxShape({0.58f, 0.41f, 0.58f}, 0.045f, 5);
  scene.glb.addNode({.name = "Block podium",
                     .translation = foot + glm::vec3(0, 0.41f, 0),
                     .rotation = rotationAbout({0, 1, 0}, 24),
                     .mesh = scene.mesh("Block podium", block, scene.materials.terrazzo)});
  scene.contacts.push_back({{foot.x, foot.z}, 0.64f});

  constexpr float kRadius = 0.6f;
  Shape ball = porousBallShape(kRadius, 0.08f, 72);
  // Coral outside, pale gold inside.
  paint(ball, [](glm::vec3 p) {
    float outside = glm::smoothstep(kRadius - 0.07f, kRadius - 0.03f, glm::length(p));
    return glm::mix(glm::vec3(0.90f, 0.50f, 0.16f), glm::vec3(0.80f, 0.10f, 0.075f), outside);
  });
  MaterialSpec coral{.name = "Coral porcelain", .roughness = 0.38f};
  int mesh = scene.mesh("Porous ball", ball, scene.glb.addMaterial(coral));
  glm::vec3 center = foot + glm::vec3(0, 0.82f + kRadius, 0);
  scene.glb.addNode({.name = "Porous ball",
                     .translation = center,
                     .rotation = rotationAbout({1, 1, 0}, 25),
                     .mesh = mesh,
                     .extras = sdfExtras(192)});

  // The ring runs half inside, half outside the ball's hull, and turns in it.
  int ringMesh = scene.mesh("Ring", torusShape(0.6f, 0.07f, 112, 28), scene.materials.copper);
  NodeSpec ring{.name = "Ring", .translation = center, .rotation = rotationAbout({1, 0, 0.45f}, 38), .mesh = ringMesh};
  int node = scene.glb.addNode(ring);
  scene.channels.push_back(spinChannel(node, ring.rotation, {1, 0, 0}, 6.0f));
}

void addPebble(StillLife& scene) {
  const glm::vec3 foot(-1.95f, 0, 1.2f);
  MaterialSpec ochre{.name = "Ochre clay", .baseColor = {0.86f, 0.48f, 0.07f}, .roughness = 0.55f};
  Shape pebble = superellipsoidShape({0.42f, 0.42f, 0.42f}, 0.45f, 96);
  // Not the same scale along the axes, on purpose: distances must still come out right.
  scene.glb.addNode({.name = "Pebble",
                     .translation = foot + glm::vec3(0, 0.3f, 0),
                     .rotation = rotationAbout({0, 1, 0}, 32),
                     .scale = {1.15f, 0.714f, 0.9f},
                     .mesh = scene.mesh("Pebble", pebble, scene.glb.addMaterial(ochre)),
                     .extras = sdfExtras(96)});
  scene.contacts.push_back({{foot.x, foot.z}, 0.44f});
  MaterialSpec ivory{.name = "Ivory", .baseColor = {0.86f, 0.80f, 0.68f}, .roughness = 0.35f};
  int hoop = scene.mesh("Hoop", torusShape(0.5f, 0.055f, 112, 28), scene.glb.addMaterial(ivory));
  scene.glb.addNode({.name = "Hoop",
                     .translation = foot + glm::vec3(0, 0.36f, 0),
                     .rotation = rotationAbout({0, 1, 0}, 32) * rotationAbout({0.55f, 0, 1}, -34),
                     .mesh = hoop});
}

void addGear(StillLife& scene) {
  GearSettings settings{.teeth = 16,
                        .rootRadius = 0.43f,
                        .tipRadius = 0.54f,
                        .boreRadius = 0.13f,
                        .halfThickness = 0.1f,
                        .rounding = 0.025f};
  int mesh = scene.mesh("Gear", gearShape(settings), scene.materials.steel);
  // Leaning on the main podium.
  scene.glb.addNode({.name = "Gear",
                     .translation = {1.62f, 0.51f, 0.62f},
                     .rotation = rotationAbout({0, 1, 0}, 48) * rotationAbout({1, 0, 0}, 74),
                     .mesh = mesh,
                     .extras = sdfExtras(160)});
  scene.contacts.push_back({{1.66f, 0.68f}, 0.22f});
}

void addBlob(StillLife& scene) {
  addPodium(scene, "Low podium", {2.75f, 0, 1.1f}, 0.42f, 0.26f);
  Shape blob = sphereShape(0.27f, 64, 40);
  for (std::size_t i = 0; i < blob.positions.size(); ++i) {
    glm::vec3 p = blob.positions[i] / 0.27f;
    // Three lobes around, pinched at the waist; the morph carries the sphere there.
    float swell = 0.32f * (std::sin(3 * std::atan2(p.z, p.x)) * (1 - p.y * p.y) + 0.6f * p.y * p.y - 0.2f);
    blob.morphPositions.push_back(blob.positions[i] * swell);
  }
  Shape target = blob;
  for (std::size_t i = 0; i < target.positions.size(); ++i) target.positions[i] += blob.morphPositions[i];
  target.morphPositions.clear();
  std::vector<glm::vec3> positionsBefore = target.positions;
  smoothNormals(target, 180);
  // Splitting by normal keeps one vertex each at a crease of 180°, but in the order of use: match by position.
  for (std::size_t i = 0; i < blob.positions.size(); ++i) {
    auto found = std::find(target.positions.begin(), target.positions.end(), positionsBefore[i]);
    blob.morphNormals.push_back(target.normals[static_cast<std::size_t>(found - target.positions.begin())] -
                                blob.normals[i]);
  }
  MaterialSpec lilac{.name = "Lilac", .baseColor = {0.42f, 0.30f, 0.66f}, .roughness = 0.3f};
  int mesh = scene.mesh("Blob", blob, scene.glb.addMaterial(lilac));
  int node = scene.glb.addNode({.name = "Blob", .translation = {2.75f, 0.52f, 1.1f}, .mesh = mesh});
  scene.channels.push_back({node, "weights", {0, 1, 2, 3, 4, 5, 6, 7, 8}, {0, 0.6f, 1, 0.6f, 0, 0.6f, 1, 0.6f, 0}});
}

} // namespace

void addTeapots(StillLife& scene) {
  addPodium(scene, "Main podium", {0, 0, 0}, 1.18f, 0.3f);
  MaterialSpec glaze{.name = "Glaze", .metallic = 1.0f, .roughness = 1.0f};
  glaze.baseColorTexture.texture = scene.glb.addTexture("Glaze", glazeBaseColor(1024));
  glaze.metallicRoughnessTexture.texture = scene.glb.addTexture("Glaze metal", glazeMetallicRoughness(512));
  int material = scene.glb.addMaterial(glaze);
  glaze.name = "Celadon glaze";
  glaze.baseColor = {0.50f, 0.86f, 0.62f};
  int celadon = scene.glb.addMaterial(glaze);

  int geometry = scene.glb.addGeometry(teapotShape(14));
  int mesh = scene.glb.addMesh("Teapot", {{geometry, material}});
  int small = scene.glb.addMesh("Small teapot", {{geometry, celadon}});
  scene.glb.addNode({.name = "Teapot",
                     .translation = {-0.02f, 0.3f, 0},
                     .rotation = rotationAbout({0, 1, 0}, -24),
                     .scale = glm::vec3(0.315f),
                     .mesh = mesh,
                     .extras = sdfExtras(192)});
  // Mirrored and squat.
  scene.glb.addNode({.name = "Small teapot",
                     .translation = {-0.85f, 0, 1.75f},
                     .rotation = rotationAbout({0, 1, 0}, 28),
                     .scale = {-0.115f, 0.105f, 0.125f},
                     .mesh = small,
                     .extras = sdfExtras(128)});
  scene.contacts.push_back({{-0.85f, 1.75f}, 0.2f});
}

void addSculptures(StillLife& scene) {
  addKnot(scene);
  addPorousBall(scene);
  addPebble(scene);
  addGear(scene);
  addBlob(scene);
}

void addTableware(StillLife& scene) {
  const std::array<ProfileCorner, 8> cup{{{{0, 0.02f}},
                                          {{0.11f, 0.02f}, 0.01f},
                                          {{0.12f, 0.0f}, 0.01f},
                                          {{0.17f, 0.0f}, 0.05f},
                                          {{0.26f, 0.30f}, 0.012f},
                                          {{0.235f, 0.305f}, 0.012f},
                                          {{0.15f, 0.035f}, 0.06f},
                                          {{0, 0.035f}}}};
  Shape shape = revolvedShape(roundedProfile(cup, 6, false), false, 96);
  Shape handle = tubeShape(
      {48, 20, false},
      [](float along) {
        float angle = glm::radians(glm::mix(112.0f, -100.0f, along));
        return glm::vec3(0.215f + 0.11f * std::cos(angle), 0.16f + 0.095f * std::sin(angle), 0);
      },
      [](float) { return glm::vec3(0, 0, 1); }, [](float, float) { return 0.024f; });
  append(shape, handle);
  MaterialSpec porcelain{.name = "Celadon", .baseColor = {0.36f, 0.64f, 0.50f}, .roughness = 0.2f};
  int material = scene.glb.addMaterial(porcelain);
  const glm::vec3 foot(0.62f, 0, 1.85f);
  scene.glb.addNode({.name = "Cup",
                     .translation = foot + glm::vec3(0, 0.045f, 0),
                     .rotation = rotationAbout({0, 1, 0}, 20),
                     .mesh = scene.mesh("Cup", shape, material),
                     .extras = sdfExtras(128)});
  const std::array<ProfileCorner, 6> saucer{{{{0, 0.012f}},
                                             {{0.2f, 0.0f}, 0.03f},
                                             {{0.42f, 0.07f}, 0.012f},
                                             {{0.415f, 0.09f}, 0.012f},
                                             {{0.2f, 0.04f}, 0.06f},
                                             {{0, 0.042f}}}};
  Shape saucerShape = revolvedShape(roundedProfile(saucer, 5, false), false, 96);
  scene.glb.addNode({.name = "Saucer",
                     .translation = foot,
                     .mesh = scene.mesh("Saucer", saucerShape, material),
                     .extras = sdfExtras(128)});
  scene.contacts.push_back({{foot.x, foot.z}, 0.30f});
}

} // namespace brickfield::scenes
