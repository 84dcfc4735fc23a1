// Generated shapes; deterministic.
#include "tests/support/hand_scenes.h"

#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace brickfield::test {

namespace {

constexpr float kTurn = 6.2831853f;

// A closed grid of quads; rows and columns wrap around where said.
Mesh gridMesh(std::string name, int rows, int columns, bool wrapRows,
              const std::function<void(float, float, Primitive&)>& add) {
  Primitive primitive;
  const int rowCount = wrapRows ? rows : rows + 1;
  for (int r = 0; r < rowCount; ++r)
    for (int c = 0; c < columns; ++c)
      add(static_cast<float>(r) / static_cast<float>(rows), static_cast<float>(c) / static_cast<float>(columns),
          primitive);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto at = [&](int row, int column) {
        return static_cast<std::uint32_t>((row % rowCount) * columns + column % columns);
      };
      for (const std::uint32_t index :
           {at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c), at(r + 1, c + 1), at(r, c + 1)})
        primitive.indices.push_back(index);
    }
  Mesh mesh;
  mesh.name = std::move(name);
  mesh.primitives.push_back(std::move(primitive));
  return mesh;
}

void addNode(Scene& scene, std::string name, int mesh, const glm::mat4& worldFromObject) {
  Node node;
  node.name = std::move(name);
  node.mesh = mesh;
  node.matrix = worldFromObject;
  scene.scenes[0].nodes.push_back(static_cast<int>(scene.nodes.size()));
  scene.nodes.push_back(std::move(node));
}

Scene emptyScene() {
  Scene scene;
  scene.name = "hand-made";
  scene.scenes.push_back({"scene", {}});
  return scene;
}

} // namespace

Mesh makeTorusMesh(float majorRadius, float minorRadius, int segments, int sides) {
  return gridMesh("Torus", segments, sides, true, [&](float u, float v, Primitive& primitive) {
    const float a = std::fmod(u, 1.0f) * kTurn, b = std::fmod(v, 1.0f) * kTurn; // seams meet to the bit
    const glm::vec3 outwards(std::cos(a), std::sin(a), 0);
    const glm::vec3 normal = outwards * std::cos(b) + glm::vec3(0, 0, std::sin(b));
    primitive.positions.push_back(outwards * majorRadius + normal * minorRadius);
    primitive.normals.push_back(normal);
  });
}

Mesh makeSphereMesh(float radius, int rings, int segments) {
  return gridMesh("Sphere", rings, segments, false, [&](float u, float v, Primitive& primitive) {
    const float polar = u * kTurn / 2, around = std::fmod(v, 1.0f) * kTurn; // seams and poles meet to the bit
    const float ring = u == 0 || u == 1 ? 0.0f : std::sin(polar);
    const glm::vec3 normal(ring * std::cos(around), std::cos(polar), -ring * std::sin(around));
    primitive.positions.push_back(normal * radius);
    primitive.normals.push_back(normal);
  });
}

Mesh makeBoxMesh(glm::vec3 halfExtent) {
  Primitive primitive;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0), u(0), v(0);
      normal[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1;
      const auto first = static_cast<std::uint32_t>(primitive.positions.size());
      for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        primitive.positions.push_back((normal + u * corner.x + v * corner.y) * halfExtent);
        primitive.normals.push_back(normal);
      }
      for (const std::uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u}) primitive.indices.push_back(first + index);
    }
  Mesh mesh;
  mesh.name = "Box";
  mesh.primitives.push_back(std::move(primitive));
  return mesh;
}

Scene makeTransformedTorus(const glm::mat4& worldFromObject) {
  Scene scene = emptyScene();
  scene.meshes.push_back(makeTorusMesh(0.6f, 0.22f, 128, 64));
  addNode(scene, "Torus", 0, worldFromObject);
  return scene;
}

Scene makeTorusAlone() { return makeTransformedTorus(glm::mat4(1)); }

Scene makeInterpenetration() {
  Scene scene = makeTorusAlone();
  scene.meshes.push_back(makeSphereMesh(0.5f, 64, 128));
  addNode(scene, "Sphere", 1, glm::translate(glm::mat4(1), glm::vec3(0.25f, 0.1f, 0)));
  return scene;
}

Scene makeCrowd() {
  Scene scene = emptyScene();
  scene.meshes = {makeTorusMesh(0.3f, 0.1f, 48, 24), makeSphereMesh(0.25f, 24, 48), makeBoxMesh({0.2f, 0.15f, 0.25f})};
  constexpr int kObjects = 40;
  for (int i = 0; i < kObjects; ++i) {
    // Golden-ratio steps spread places and turns without a generator.
    const auto part = [i](float step) { return std::fmod(static_cast<float>(i) * step + 0.5f, 1.0f); };
    glm::mat4 placed =
        glm::translate(glm::mat4(1), glm::vec3(part(0.618034f), part(0.754878f), part(0.569840f)) * 2.0f - 1.0f);
    placed = glm::rotate(placed, kTurn * part(0.4142f), glm::normalize(glm::vec3(part(0.7321f), 1, part(0.2361f))));
    addNode(scene, fmt::format("{}{}", i % 2 ? "Sdf" : "Mesh", i), i % 3, placed);
  }
  return scene;
}

namespace {

// One metre, facing +Z or -Z.
Mesh sheetMesh(float side, int material) {
  Primitive primitive;
  for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
    primitive.positions.emplace_back(corner.x * side * 0.5f, corner.y * 0.5f, 0);
    primitive.normals.emplace_back(0, 0, side);
    primitive.uvs[0].push_back(corner * glm::vec2(0.5f, -0.5f) + 0.5f);
  }
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = material;
  Mesh mesh;
  mesh.name = "Sheet";
  mesh.primitives.push_back(std::move(primitive));
  return mesh;
}

// White; alpha 0 in a disk around the middle and in the upper right corner.
Image holeImage() {
  constexpr int kSide = 128;
  Image image;
  image.size = {kSide, kSide};
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const glm::vec2 uv((static_cast<float>(column) + 0.5f) / kSide, (static_cast<float>(row) + 0.5f) / kSide);
      const bool isHole = glm::distance(uv, glm::vec2(0.5f)) < 0.3f || (uv.x > 0.8f && uv.y < 0.2f);
      image.rgba.insert(image.rgba.end(), {255, 255, 255, isHole ? std::uint8_t{0} : std::uint8_t{255}});
    }
  return image;
}

} // namespace

Scene makeSheets() {
  Scene scene = emptyScene();
  scene.images.push_back(holeImage());
  scene.textures.emplace_back();
  scene.textures[0].image = 0;
  scene.materials.resize(3);
  for (const std::size_t masked : {std::size_t{1}, std::size_t{2}}) {
    scene.materials[masked].alphaMode = AlphaMode::Mask;
    scene.materials[masked].baseColorTexture.texture = 0;
  }
  scene.materials[1].doubleSided = true;
  scene.meshes = {sheetMesh(1, 0), sheetMesh(-1, 0), sheetMesh(1, 1), sheetMesh(1, 2)};
  const auto add = [&](const char* name, int mesh, glm::vec3 place, glm::vec3 scale) {
    addNode(scene, name, mesh, glm::scale(glm::translate(glm::mat4(1), place), scale));
  };
  add("Front", 0, {-1.2f, 0.6f, 0}, glm::vec3(1));
  add("Back", 1, {0, 0.6f, 0}, glm::vec3(1));
  add("Mirrored", 0, {1.2f, 0.6f, 0}, {-1, 1, 1});
  add("TurnedOver", 0, {-1.2f, -0.6f, 0}, {1, 1, -1});
  add("Masked", 2, {0, -0.6f, 0}, glm::vec3(1));
  add("MaskedFront", 3, {1.2f, -0.6f, 0}, glm::vec3(1));
  return scene;
}

Scene makeBoxAlone(Material material, const glm::mat4& worldFromObject) {
  Scene scene;
  scene.materials.push_back(std::move(material));
  scene.meshes.push_back(makeBoxMesh(glm::vec3(0.5f)));
  scene.meshes[0].primitives[0].material = 0;
  Node node;
  node.mesh = 0;
  node.matrix = worldFromObject;
  scene.nodes.push_back(node);
  scene.scenes.push_back({"scene", {0}});
  return scene;
}

std::vector<AffineCase> affineCases() {
  glm::mat4 shear(1);
  shear[1][0] = 0.8f;
  shear[2][1] = -0.5f;
  const glm::mat4 turned = glm::rotate(glm::mat4(1), 0.9f, glm::normalize(glm::vec3(1, 2, 0.5f)));
  return {{"non-uniform", glm::scale(glm::mat4(1), glm::vec3(1, 3, 0.2f))},
          {"non-uniform, turned", turned * glm::scale(glm::mat4(1), glm::vec3(1, 3, 0.2f))},
          {"shear", shear * turned},
          {"mirror", glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1)) * turned},
          {"mirrored shear", shear * glm::scale(glm::mat4(1), glm::vec3(1, 1, -2)) * turned}};
}

} // namespace brickfield::test
