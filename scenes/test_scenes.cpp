// Scenes for tests and measurements: things that cut each other, and very many things.
#include <array>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "scenes/glb_writer.h"
#include "scenes/noise.h"
#include "scenes/scenes.h"
#include "scenes/shapes.h"
#include "scenes/teapot_patches.h"

namespace brickfield::scenes {
namespace {

using Json = nlohmann::ordered_json;

void addCamera(GlbWriter& glb, const std::string& name, glm::vec3 eye, glm::vec3 target, float fovDegrees) {
  NodeSpec node{.name = name, .translation = eye, .rotation = lookRotation(eye, target)};
  node.camera = glb.addCamera(name, glm::radians(fovDegrees), 0.01f);
  glb.addNode(node);
}

void addSun(GlbWriter& glb, glm::vec3 from) {
  NodeSpec node{.name = "Sun", .translation = from, .rotation = lookRotation(from, {0, 0, 0})};
  node.light = glb.addLight({{"name", "Sun"}, {"type", "directional"}, {"intensity", 3.0f}});
  glb.addNode(node);
}

Json sdfExtras(int resolution) { return {{"sdf", true}, {"resolution", resolution}}; }

/// A small mesh of the stress scene; all fit a ball of radius about 0.5.
struct StressMesh {
  const char* name;
  Shape shape;
  int resolution;
  glm::vec3 color;
  float metallic = 0;
};

std::vector<StressMesh> stressMeshes() {
  const std::array<ProfileCorner, 4> cone{
      {{{0, -0.4f}}, {{0.4f, -0.4f}, 0.08f}, {{0.05f, 0.42f}, 0.06f}, {{0, 0.45f}}}};
  const std::array<ProfileCorner, 5> bowl{
      {{{0, -0.25f}}, {{0.3f, -0.25f}, 0.2f}, {{0.45f, 0.2f}, 0.03f}, {{0.36f, 0.2f}, 0.03f}, {{0, -0.12f}}}};
  Shape teapot = teapotShape(5);
  for (glm::vec3& p : teapot.positions) p = (p - glm::vec3(0.2f, 1.5f, 0)) * 0.15f;
  Shape capsule = superellipsoidShape({0.2f, 0.48f, 0.2f}, 0.9f, 32);
  GearSettings gear{.teeth = 9,
                    .rootRadius = 0.33f,
                    .tipRadius = 0.47f,
                    .boreRadius = 0.12f,
                    .halfThickness = 0.12f,
                    .rounding = 0.03f};
  std::vector<StressMesh> meshes;
  meshes.push_back({"Sphere", sphereShape(0.42f, 32, 20), 32, {0.80f, 0.16f, 0.12f}});
  meshes.push_back({"Box", roundedBoxShape({0.36f, 0.3f, 0.26f}, 0.05f, 3), 32, {0.14f, 0.40f, 0.66f}});
  meshes.push_back({"Torus", torusShape(0.34f, 0.12f, 48, 20), 40, {0.86f, 0.55f, 0.10f}});
  meshes.push_back({"Trefoil", trefoilShape(0.28f, 0.08f, 120, 14, 0), 64, {1.0f, 0.72f, 0.32f}, 1});
  meshes.push_back({"Gear", gearShape(gear), 64, {0.56f, 0.57f, 0.60f}, 1});
  meshes.push_back({"Pebble", superellipsoidShape({0.4f, 0.28f, 0.34f}, 0.5f, 40), 32, {0.30f, 0.55f, 0.34f}});
  meshes.push_back({"Octahedroid", superellipsoidShape({0.46f, 0.46f, 0.46f}, 1.9f, 40), 48, {0.50f, 0.28f, 0.62f}});
  meshes.push_back({"Capsule", std::move(capsule), 40, {0.84f, 0.78f, 0.66f}});
  meshes.push_back({"Cone", revolvedShape(roundedProfile(cone, 5, false), false, 40), 40, {0.12f, 0.52f, 0.52f}});
  meshes.push_back({"Bowl", revolvedShape(roundedProfile(bowl, 5, false), false, 48), 48, {0.88f, 0.40f, 0.20f}});
  meshes.push_back({"Porous ball", porousBallShape(0.45f, 0.1f, 34), 64, {0.80f, 0.82f, 0.84f}});
  meshes.push_back({"Teapot", std::move(teapot), 64, {0.90f, 0.88f, 0.82f}});
  return meshes;
}

/// Uniform over all rotations (Shoemake 1992).
glm::quat randomRotation(Random& random) {
  float a = random.uniform();
  float angleFirst = glm::two_pi<float>() * random.uniform();
  float angleSecond = glm::two_pi<float>() * random.uniform();
  float first = std::sqrt(1 - a), second = std::sqrt(a);
  return glm::quat(second * std::cos(angleSecond), first * std::sin(angleFirst), first * std::cos(angleFirst),
                   second * std::sin(angleSecond));
}

} // namespace

std::vector<std::byte> interpenetrationScene() {
  GlbWriter glb;
  int red = glb.addMaterial({.name = "Red", .baseColor = {0.75f, 0.12f, 0.10f}, .roughness = 0.4f});
  int blue = glb.addMaterial({.name = "Blue", .baseColor = {0.10f, 0.25f, 0.70f}, .roughness = 0.4f});
  int green = glb.addMaterial({.name = "Green", .baseColor = {0.15f, 0.55f, 0.20f}, .roughness = 0.4f});
  int yellow = glb.addMaterial({.name = "Yellow", .baseColor = {0.85f, 0.65f, 0.10f}, .roughness = 0.4f});
  auto mesh = [&](const char* name, const Shape& shape, int material) {
    return glb.addMesh(name, {{glb.addGeometry(shape), material}});
  };
  glb.addNode({.name = "Sphere",
               .translation = {-0.35f, 0.25f, 0.25f},
               .mesh = mesh("Sphere", sphereShape(0.5f, 96, 64), red)});
  glb.addNode({.name = "Box",
               .translation = {0.15f, 0, 0},
               .rotation = rotationAbout({0, 1, 0}, 30),
               .mesh = mesh("Box", roundedBoxShape({0.5f, 0.5f, 0.5f}, 0.06f, 6), blue),
               .extras = sdfExtras(96)});
  glb.addNode({.name = "Torus",
               .translation = {0.35f, 0.2f, 0.45f},
               .rotation = rotationAbout({1, 0, 0.3f}, 70),
               .mesh = mesh("Torus", torusShape(0.45f, 0.14f, 128, 48), green),
               .extras = sdfExtras(128)});
  glb.addNode({.name = "Ring",
               .translation = {0.45f, 0.2f, 0.1f},
               .rotation = rotationAbout({0, 0, 1}, 55),
               .mesh = mesh("Ring", torusShape(0.5f, 0.06f, 128, 32), yellow)});
  addCamera(glb, "front", {0.8f, 1.0f, 3.4f}, {0.05f, 0.1f, 0.1f}, 32);
  addCamera(glb, "top", {0.1f, 3.6f, 0.6f}, {0.1f, 0, 0.1f}, 32);
  addSun(glb, {-2, 4, 3});
  return glb.finish();
}

std::vector<std::byte> stressScene(int count, std::uint64_t seed) {
  GlbWriter glb;
  Random random(seed);
  const std::vector<StressMesh> meshes = stressMeshes();
  // Objects of about one metre, a quarter of the room filled.
  const float side = 1.6f * std::cbrt(static_cast<float>(count));
  struct Placement {
    std::vector<glm::vec3> translations;
    std::vector<glm::quat> rotations;
    std::vector<glm::vec3> scales;
  };
  std::vector<Placement> placements(meshes.size());
  for (int i = 0; i < count; ++i) {
    Placement& placement = placements[static_cast<std::size_t>(i) % meshes.size()];
    glm::vec3 place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = random.uniform(-0.5f * side, 0.5f * side);
    placement.translations.push_back(place);
    placement.rotations.push_back(randomRotation(random));
    placement.scales.push_back(glm::vec3(random.uniform(0.6f, 1.4f)));
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (placements[i].translations.empty()) continue;
    const StressMesh& entry = meshes[i];
    int material =
        glb.addMaterial({.name = entry.name, .baseColor = entry.color, .metallic = entry.metallic, .roughness = 0.4f});
    int mesh = glb.addMesh(entry.name, {{glb.addGeometry(entry.shape), material}});
    int node = glb.addNode({.name = entry.name, .mesh = mesh, .extras = sdfExtras(entry.resolution)});
    glb.addInstances(node, placements[i].translations, placements[i].rotations, placements[i].scales);
  }
  float far = 1.25f * side + 2.0f;
  addCamera(glb, "outside", {0.55f * far, 0.4f * far, far}, {0, 0, 0}, 45);
  addCamera(glb, "inside", {0.0f, 0.0f, 0.45f * side}, {0, 0, 0}, 60);
  addSun(glb, {-2, 4, 3});
  return glb.finish();
}

} // namespace brickfield::scenes
