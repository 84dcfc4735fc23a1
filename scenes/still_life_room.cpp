// Floor, wall, the disk on the wall, podium stone and metals. The floor is darkened where things stand on it: in its
// occlusion map (second texture coordinates) for the light of the surroundings and a little in its vertex colours.
#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "scenes/shapes.h"
#include "scenes/still_life.h"
#include "scenes/textures.h"

namespace brickfield::scenes {
namespace {

constexpr glm::vec2 kFloorMinXz{-8.0f, -5.5f};
constexpr glm::vec2 kFloorMaxXz{8.0f, 7.5f};
constexpr float kWallRadius = 6.4f;
constexpr glm::vec2 kWallCenterXz{0.0f, 2.4f};
constexpr float kWallHeight = 4.6f;
// Wide enough for the main camera at 16:9; more on the left would put the flowers into the wall's shadow.
constexpr float kWallFromDegrees = -80.0f;
constexpr float kWallToDegrees = 72.0f;
constexpr float kPlankTileMetres = 2.4f;

/// Share of the upper hemisphere that is left open at a point of the floor, roughly: each contact hides what a disk of
/// its radius hides that hovers over it, the wall hides half of the sky where it stands.
float floorOpenness(const std::vector<Contact>& contacts, glm::vec2 pointXz) {
  float open = 1.0f;
  for (const Contact& contact : contacts) {
    float gap = std::max(glm::distance(pointXz, contact.centerXz) - contact.radius, 0.0f);
    float reach = 0.42f * contact.radius + 0.05f;
    float nearness = 1.0f / (1.0f + (gap * gap) / (reach * reach));
    float lifted = 1.0f / (1.0f + contact.height * contact.height / (reach * reach));
    open *= 1.0f - 0.9f * nearness * nearness * lifted;
  }
  float toWall = std::max(kWallRadius - glm::distance(pointXz, kWallCenterXz), 0.0f);
  if (pointXz.y < kWallCenterXz.y) open *= 1.0f - 0.5f * std::exp(-toWall / 0.5f);
  return open;
}

Shape floorShape(const std::vector<Contact>& contacts) {
  glm::vec2 extent = kFloorMaxXz - kFloorMinXz;
  // Denser in the middle, where things stand: 4 cm there, 25 cm at the rim.
  auto denserInside = [](float t) {
    float s = 2 * t - 1;
    return 0.5f + 0.5f * s * (0.45f + 0.55f * s * s);
  };
  Shape shape = gridShape(160, 132, {}, [&](float u, float v) {
    glm::vec2 xz = kFloorMinXz + glm::vec2(denserInside(u), denserInside(1 - v)) * extent;
    return glm::vec3(xz.x, 0, xz.y);
  });
  smoothNormals(shape, 30);
  for (glm::vec3 p : shape.positions) {
    shape.uvsSecond.push_back((glm::vec2(p.x, p.z) - kFloorMinXz) / extent);
  }
  for (std::size_t i = 0; i < shape.uvs.size(); ++i) {
    shape.uvs[i] = glm::vec2(shape.positions[i].x, shape.positions[i].z) / kPlankTileMetres;
  }
  paint(shape, [&](glm::vec3 p) {
    float open = floorOpenness(contacts, {p.x, p.z});
    return glm::mix(glm::vec3(0.40f, 0.34f, 0.32f), glm::vec3(1.0f), open);
  });
  return shape;
}

void addFloor(StillLife& scene) {
  int baseColor = scene.glb.addTexture("Oak", plankBaseColor(1024));
  int roughness = scene.glb.addTexture("Oak roughness", plankRoughness(512));
  int normal = scene.glb.addTexture("Oak normal", plankNormal(1024));
  glm::vec2 extent = kFloorMaxXz - kFloorMinXz;
  int occlusion = scene.glb.addTexture("Floor occlusion", paintedPng(512, 416, 1, false, [&](glm::vec2 uv) {
                                         return glm::vec3(floorOpenness(scene.contacts, kFloorMinXz + uv * extent));
                                       }));
  MaterialSpec oak{.name = "Oak", .roughness = 1.0f};
  oak.metallic = 1.0f;
  oak.baseColorTexture.texture = baseColor;
  oak.metallicRoughnessTexture.texture = roughness;
  oak.normalTexture.texture = normal;
  oak.occlusionTexture = {occlusion, 1};
  int mesh = scene.mesh("Floor", floorShape(scene.contacts), scene.glb.addMaterial(oak));
  scene.glb.addNode({.name = "Floor", .mesh = mesh});
}

void addWall(StillLife& scene) {
  MaterialSpec plaster{.name = "Plaster", .baseColor = {0.075f, 0.18f, 0.195f}, .roughness = 0.85f};
  plaster.normalTexture = {scene.glb.addTexture("Plaster normal", plasterNormal(512))};
  Shape shape = gridShape(72, 20, {}, [](float u, float v) {
    float angle = glm::radians(glm::mix(kWallFromDegrees, kWallToDegrees, u));
    return glm::vec3(kWallCenterXz.x + kWallRadius * std::sin(angle), kWallHeight * v,
                     kWallCenterXz.y - kWallRadius * std::cos(angle));
  });
  smoothNormals(shape, 30);
  paint(shape, [](glm::vec3 p) {
    // Darker towards the floor and the ceiling: where a real wall would be hidden from lamps and window.
    float low = 1.0f - 0.45f * std::exp(-p.y / 0.35f);
    float high = glm::mix(1.0f, 0.55f, glm::smoothstep(1.4f, 5.5f, p.y));
    return glm::vec3(low * high);
  });
  for (glm::vec2& uv : shape.uvs) uv *= glm::vec2(7, 2);
  int mesh = scene.mesh("Wall", shape, scene.glb.addMaterial(plaster));
  scene.glb.addNode({.name = "Wall", .mesh = mesh});

  MaterialSpec apricot{.name = "Apricot", .baseColor = {0.80f, 0.25f, 0.08f}, .roughness = 0.75f};
  int disk = scene.mesh("Disk", podiumShape(1.6f, 0.16f, 0.03f, 128), scene.glb.addMaterial(apricot));
  scene.glb.addNode(
      {.name = "Disk", .translation = {0.05f, 1.58f, -2.2f}, .rotation = rotationAbout({1, 0, 0}, 90), .mesh = disk});
  scene.contacts.push_back({{0.05f, -2.1f}, 0.25f});
}

} // namespace

void addSharedMaterials(StillLife& scene) {
  MaterialSpec terrazzo{.name = "Terrazzo", .roughness = 1.0f};
  terrazzo.metallic = 1.0f;
  terrazzo.baseColorTexture.texture = scene.glb.addTexture("Terrazzo", terrazzoBaseColor(512));
  terrazzo.metallicRoughnessTexture.texture = scene.glb.addTexture("Terrazzo roughness", terrazzoRoughness(256));
  scene.materials.terrazzo = scene.glb.addMaterial(terrazzo);

  int brushed = scene.glb.addTexture("Brushed roughness", brushedRoughness(256));
  auto metal = [&](const char* name, glm::vec3 color, float roughness) {
    MaterialSpec spec{.name = name, .baseColor = color, .metallic = 1.0f, .roughness = roughness};
    spec.metallicRoughnessTexture.texture = brushed;
    return scene.glb.addMaterial(spec);
  };
  // Reflectances at normal incidence as tabled by Lagarde 2011 (brass between copper and gold).
  scene.materials.brass = metal("Brushed gold", {1.0f, 0.72f, 0.32f}, 0.95f);
  scene.materials.copper = metal("Copper", {0.955f, 0.55f, 0.43f}, 0.9f);
  scene.materials.steel = metal("Steel", {0.62f, 0.63f, 0.66f}, 1.0f);
}

void addRoom(StillLife& scene) {
  addWall(scene);
  addFloor(scene);
}

} // namespace brickfield::scenes
