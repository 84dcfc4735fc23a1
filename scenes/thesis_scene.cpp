// The measured scene of the thesis of 2017, with shapes of ours in the places of its own: a long and a round statue
// (its dragon and teapot) and rows of thin figures in a hall with pillars, one light, one camera. Fields have the
// voxels of its fields. What is not its: the hall and its pillars are triangles, where all of it are distances.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "scenes/glb_writer.h"
#include "scenes/scenes.h"
#include "scenes/shapes.h"
#include "scenes/teapot_patches.h"

namespace brickfield::scenes {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kStatues = 2; // beside the figures

Json sdfExtras(int resolution) { return {{"sdf", true}, {"resolution", resolution}}; }

float capsule(glm::vec3 p, glm::vec3 from, glm::vec3 to, float radius) {
  const glm::vec3 way = to - from;
  const float along = std::clamp(glm::dot(p - from, way) / glm::dot(way, way), 0.0f, 1.0f);
  return glm::distance(p, from + along * way) - radius;
}

/// Union with the corner rounded over a width (Quilez' polynomial).
float smoothMin(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0f) / width;
  return std::min(a, b) - 0.25f * width * h * h;
}

/// Five metres tall, four wide with the arms out and 0.7 thick, around the origin: the thesis' 295 x 350 x 50.
Shape figureShape() {
  struct Limb {
    glm::vec3 from, to;
    float radius;
  };
  static constexpr std::array<Limb, 9> kLimbs{{{{0, 1.95f, 0}, {0, 2.15f, 0}, 0.35f},           // head
                                               {{0, 1.3f, 0}, {0, 1.7f, 0}, 0.2f},              // neck
                                               {{-0.3f, 1.05f, 0}, {0.3f, 1.05f, 0}, 0.33f},    // chest
                                               {{0, 0.9f, 0}, {0, -0.2f, 0}, 0.35f},            // trunk
                                               {{-0.25f, -0.35f, 0}, {0.25f, -0.35f, 0}, 0.3f}, // hips
                                               {{0.5f, 1.1f, 0}, {1.9f, 1.5f, 0}, 0.18f},       // arms
                                               {{-0.5f, 1.1f, 0}, {-1.9f, 0.5f, 0}, 0.18f},
                                               {{0.3f, -0.5f, 0}, {0.75f, -2.25f, 0}, 0.23f}, // legs
                                               {{-0.3f, -0.5f, 0}, {-0.6f, -2.25f, 0}, 0.23f}}};
  return implicitShape(2.7f, 96, [](glm::vec3 p) {
    float field = capsule(p, kLimbs[0].from, kLimbs[0].to, kLimbs[0].radius);
    for (const Limb& limb : kLimbs) field = smoothMin(field, capsule(p, limb.from, limb.to, limb.radius), 0.15f);
    return field;
  });
}

/// A ringed serpent that winds through a box of about 13.5 x 9.6 x 6.1 metres, thick in its middle.
Shape serpentShape() {
  const auto curve = [](float along) {
    const float turn = glm::two_pi<float>() * along;
    return glm::vec3(5.6f * std::sin(2 * turn + 0.4f), 3.7f * std::sin(turn), 2.0f * std::cos(3 * turn));
  };
  const auto radius = [](float along, float around) {
    const float middle = 0.5f - 0.5f * std::cos(glm::two_pi<float>() * along);
    return 0.45f + 0.5f * middle + 0.07f * std::cos(glm::two_pi<float>() * 40 * along) + 0.06f * std::cos(3 * around);
  };
  return tubeShape(
      {.steps = 480, .sides = 32}, curve, [](float) { return glm::vec3(0.2f, 0.3f, 1); }, radius);
}

/// Slabs around the space of 86 x 43 x 86 metres over y = 0 and four pillars to each side.
void addHall(GlbWriter& glb) {
  constexpr float kHalf = 43, kTop = 41.5f, kThick = 1.5f, kPillar = 28;
  struct Slab {
    const char* name;
    glm::vec3 center, half;
  };
  static constexpr std::array<Slab, 6> kSlabs{
      {{"Floor", {0, -0.5f * kThick, 0}, {kHalf, 0.5f * kThick, kHalf}},
       {"Ceiling", {0, kTop + 0.5f * kThick, 0}, {kHalf, 0.5f * kThick, kHalf}},
       {"Wall left", {-kHalf - 0.5f * kThick, 0.5f * kTop, 0}, {0.5f * kThick, 0.5f * kTop + kThick, kHalf}},
       {"Wall right", {kHalf + 0.5f * kThick, 0.5f * kTop, 0}, {0.5f * kThick, 0.5f * kTop + kThick, kHalf}},
       {"Wall back", {0, 0.5f * kTop, -kHalf - 0.5f * kThick}, {kHalf, 0.5f * kTop + kThick, 0.5f * kThick}},
       {"Wall front", {0, 0.5f * kTop, kHalf + 0.5f * kThick}, {kHalf, 0.5f * kTop + kThick, 0.5f * kThick}}}};
  const int plaster = glb.addMaterial({.name = "Plaster", .baseColor = {0.72f, 0.68f, 0.60f}, .roughness = 0.9f});
  for (const Slab& slab : kSlabs) {
    const int mesh = glb.addMesh(slab.name, {{glb.addGeometry(roundedBoxShape(slab.half, 0.02f, 1)), plaster}});
    glb.addNode({.name = slab.name, .translation = slab.center, .mesh = mesh});
  }
  const int stone = glb.addMaterial({.name = "Stone", .baseColor = {0.55f, 0.52f, 0.50f}, .roughness = 0.7f});
  const int pillar = glb.addMesh("Pillar", {{glb.addGeometry(podiumShape(2.2f, kTop, 0.05f, 64)), stone}});
  for (const float x : {-kPillar, kPillar})
    for (const float z : {-30.0f, -10.0f, 10.0f, 30.0f})
      glb.addNode({.name = "Pillar", .translation = {x, 0, z}, .mesh = pillar});
}

} // namespace

std::vector<std::byte> thesisScene(int count) {
  GlbWriter glb;
  addHall(glb);
  const int green = glb.addMaterial({.name = "Jade", .baseColor = {0.20f, 0.50f, 0.30f}, .roughness = 0.35f});
  const int white = glb.addMaterial({.name = "Porcelain", .baseColor = {0.85f, 0.84f, 0.80f}, .roughness = 0.3f});
  const int clay = glb.addMaterial({.name = "Clay", .baseColor = {0.62f, 0.30f, 0.18f}, .roughness = 0.6f});
  glb.addNode({.name = "Serpent",
               .translation = {0, 4.8f, 10},
               .mesh = glb.addMesh("Serpent", {{glb.addGeometry(serpentShape()), green}}),
               .extras = sdfExtras(128)});
  Shape teapot = teapotShape(8);
  for (glm::vec3& p : teapot.positions) p = (p - glm::vec3(0.2f, 1.575f, 0)) * 1.5238f; // 9.8 long, 4.8 high
  glb.addNode({.name = "Teapot",
               .translation = {0, 2.4f, -15},
               .mesh = glb.addMesh("Teapot", {{glb.addGeometry(teapot), white}}),
               .extras = sdfExtras(200)});
  const int figure = glb.addMesh("Figure", {{glb.addGeometry(figureShape()), clay}});
  // Seven abreast, seven rows behind each other, then a storey higher.
  for (int i = 0; i < count - kStatues; ++i)
    glb.addNode({.name = "Figure",
                 .translation = {15.0f - 5.0f * static_cast<float>(i % 7), 2.8f + 12.0f * static_cast<float>(i / 49),
                                 -4.0f * static_cast<float>(i / 7 % 7)},
                 .mesh = figure,
                 .extras = sdfExtras(350)});
  NodeSpec camera{.name = "thesis", .translation = {0, 10, 30}};
  camera.camera = glb.addCamera("thesis", glm::radians(60.0f), 0.1f);
  glb.addNode(camera);
  NodeSpec light{.name = "Lamp", .translation = {0, 10, 3}};
  light.light = glb.addLight(
      {{"name", "Lamp"}, {"type", "point"}, {"intensity", 500.0f}, {"extras", {{"brickfield", {{"radius", 0.5f}}}}}});
  glb.addNode(light);
  return glb.finish();
}

} // namespace brickfield::scenes
