// Counts what keeps triangles from being a closed manifold, by indices alone: welded, if at all, by the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace brickfield::test {

struct ManifoldCheck {
  std::size_t vertices = 0; ///< that a triangle names
  std::size_t edges = 0, triangles = 0;
  std::size_t wrongEdges = 0;    ///< not walked exactly once in each direction
  std::size_t wrongVertices = 0; ///< whose triangles are no single closed fan
  std::size_t flatTriangles = 0; ///< that name a vertex twice
  std::size_t components = 0;    ///< joined by vertices

  bool isClosedManifold() const { return wrongEdges == 0 && wrongVertices == 0 && flatTriangles == 0; }
  /// 2 a sphere, 0 a torus, summed over all components.
  std::ptrdiff_t eulerCharacteristic() const {
    return static_cast<std::ptrdiff_t>(vertices + triangles) - static_cast<std::ptrdiff_t>(edges);
  }
};

ManifoldCheck checkManifold(std::span<const std::uint32_t> indices);

/// Indices with vertices at the same place made one.
std::vector<std::uint32_t> weldedIndices(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices);

/// Volume that the triangles enclose, positive where they face outwards (divergence theorem).
double enclosedVolume(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices);
double surfaceArea(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices);

/// How often they wrap a point, by all solid angles (Van Oosterom and Strackee 1983).
double windingNumberAt(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices, glm::dvec3 point);

} // namespace brickfield::test
