// How the triangles of one mesh hang together, all its primitives at once: which corners are one vertex, what lies
// beyond each edge, which parts enclose something. Positions do not change it: what is welded here stays together
// however skins and morphs deform it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace brickfield {

/// Triangles are numbered through all primitives of the mesh in their order. Edge k runs from corner k to corner k+1.
struct SurfaceTopology {
  static constexpr std::uint32_t kNone = ~0u;

  /// A triangle that closes a small hole, behind those of the mesh in all that has a row a triangle.
  struct Cap {
    std::uint32_t primitive;
    std::array<std::uint32_t, 3> vertices; ///< of the primitive
  };

  std::uint32_t vertexCount = 0;
  std::vector<std::array<std::uint32_t, 3>> vertices;   ///< a triangle: its welded corners
  std::vector<std::array<std::uint32_t, 3>> neighbours; ///< a triangle: who shares the edge and nobody else, walking
                                                        ///< it the other way; else kNone
  std::vector<bool> isDegenerate; ///< a triangle: two of its corners are one; it has no part in anything else here
  std::vector<std::uint32_t> componentOf; ///< a triangle: number of its component, kNone for degenerate ones
  std::vector<bool> isClosedComponent;    ///< a component: every edge has two uses of opposite direction, and there is
                                          ///< room between the sides
  /// The corners around vertex v are fanCorners[fanStarts[v]] up to before fanStarts[v + 1]: 4 * triangle + corner.
  std::vector<std::uint32_t> fanStarts;
  std::vector<std::uint32_t> fanCorners;
  std::vector<Cap> caps; ///< by their primitives

  std::size_t triangleCount() const { return vertices.size(); }
  bool isClosed(std::size_t triangle) const {
    return componentOf[triangle] != kNone && isClosedComponent[componentOf[triangle]];
  }
};

enum class SmallHoles { Open, Closed };

/// With SmallHoles::Closed caps close what is thin and long, faces outwards, and has all edges used twice but those
/// around holes that are together no larger than a fiftieth of its surface: a twig, of which only the ends are open. As
/// a sheet it would be thicker by half a texel to each side. What is wide stays open, for things may stand within: a
/// room with a window. All this of the mesh at rest, in object space; no transform or pose that widens a hole opens it
/// again.
///
/// Corners are one vertex where their rest positions are equal, their joints and weights (in any order) and the offsets
/// of all morph targets too, and where edges connect their triangles: surfaces that only touch in a point have a vertex
/// each there, so that its pseudonormal knows one fan.
///
/// mesh    indices in range, as imported
/// bound   holes of more than 256 edges, of several primitives, or left with triangles of no height when the roundest
///         corners are cut off first, stay open
/// cost    nearly linear, one thread: half a microsecond a triangle
/// proved by tests/unit/scene/surface_topology_test.cpp
SurfaceTopology analyseSurface(const Mesh& mesh, SmallHoles holes = SmallHoles::Closed);

} // namespace brickfield
