// Tubes that are open at both ends.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "scene/scene.h"

namespace brickfield::test {

/// A prism along z without its two ends, whose corners lie on a circle. Each side has two triangles.
inline Mesh makeTubeMesh(float radius, float halfLength, std::uint32_t sides) {
  Mesh mesh;
  Primitive& primitive = mesh.primitives.emplace_back();
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double turn = 2 * std::numbers::pi * i / sides;
    const glm::vec3 outwards(std::cos(turn), std::sin(turn), 0);
    for (const float z : {-halfLength, halfLength}) {
      primitive.positions.push_back(radius * outwards + glm::vec3(0, 0, z));
      primitive.normals.push_back(outwards);
    }
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
    primitive.indices.insert(primitive.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
  }
  return mesh;
}

/// Of the prism, ends and all.
inline double tubeVolume(double radius, double halfLength, std::uint32_t sides) {
  return halfLength * sides * radius * radius * std::sin(2 * std::numbers::pi / sides);
}

} // namespace brickfield::test
