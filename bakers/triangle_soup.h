// All triangles of a bake as one list, welded by position, in a space of its own: soup space. Its zero is the centre of
// the mesh's box and its unit a power of two, so that the mesh reaches about 1 far and floats do well on avocados of 6
// cm, trees of 2 km and meshes far from the origin.
//
//   object space (metres) --- minus centerObject, times unitsPerMetre (exact in double) ---> soup space
//
// Triangles without area are left out, but remembered for the topology: a closed mesh stays closed when a sliver of it
// has no area.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bakers/bake.h"
#include "bakers/large_vector.h"

namespace brickfield {

using TriangleVertices = std::array<std::uint32_t, 3>;

struct TriangleSoup {
  glm::dvec3 centerObject{0.0};                ///< zero of soup space
  double unitsPerMetre = 1;                    ///< a power of two
  LargeVector<glm::dvec3> positions;           ///< soup space, no two the same
  LargeVector<TriangleVertices> triangles;     ///< of positive area
  std::vector<TriangleVertices> slivers;       ///< dropped ones whose three vertices differ: only for topology
  LargeVector<std::uint32_t> primitiveIndices; ///< a triangle: into BakeInput::primitives
  LargeVector<std::uint32_t> triangleIndices;  ///< a triangle: number within its primitive
  /// A triangle: another one covers its back (MeshTopology::isFlatPair). Empty: none does.
  std::vector<bool> isBackCovered;
  std::uint64_t degenerateCount = 0; ///< dropped triangles
  Box boundsObject;                  ///< of the triangles that are kept
  double reach = 0;                  ///< no corner is farther from zero; soup space

  glm::dvec3 soupFromObject(glm::dvec3 pointObject) const { return (pointObject - centerObject) * unitsPerMetre; }
  /// Barycentric corners, in the triangle that triangleIndices names, of the last triangles: those that masks were cut
  /// into.
  std::vector<std::array<glm::vec2, 3>> pieceBarycentrics;

  std::size_t firstPiece() const { return triangles.size() - pieceBarycentrics.size(); }
  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
    const TriangleVertices& v = triangles[triangle];
    return {positions[v[0]], positions[v[1]], positions[v[2]]};
  }
  /// Soup space.
  double areaOf(std::uint32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    return 0.5 * glm::length(glm::cross(b - a, c - a));
  }
};

/// error BadInput that names input.label: indices out of range, a position that is not finite, no triangle of positive
///       area. A triangle counts as without area where its height is below 1e-12 of its longest edge.
TriangleSoup gatherTriangles(const BakeInput& input);

} // namespace brickfield
