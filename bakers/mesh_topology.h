// How the triangles of a soup hang together: edges, connected components, coincident triangles. A component is closed
// where each of its edges is walked as often in one direction as in the other: then its winding number is a whole
// number everywhere, even where the mesh is not manifold.
#pragma once

#include <cstdint>
#include <vector>

#include "bakers/triangle_soup.h"

namespace brickfield {

inline constexpr std::uint32_t kNoTriangle = ~0u;

struct MeshTopology {
  std::uint64_t openEdges = 0;            ///< used by one triangle
  std::uint64_t nonManifoldEdges = 0;     ///< used by three or more, or by two that disagree on the direction
  std::uint64_t unbalancedEdges = 0;      ///< more often walked in one direction than in the other
  std::vector<std::uint32_t> componentOf; ///< a triangle: the first triangle of its component
  std::vector<bool> inClosedComponent;    ///< a triangle
  std::vector<bool> isTwisted;            ///< a triangle: neighbours in its component disagree on the front
  std::vector<bool> isFlatPair;           ///< a triangle: coincides with others so that they cancel out
  std::vector<bool> isFlatPairCopy;       ///< a triangle: a flat pair's second, third...

  bool isClosed() const { return unbalancedEdges == 0; }
};

/// cost O(n log n), all threads
MeshTopology analyseTopology(const TriangleSoup& soup);

/// For each edge k (from vertex k to k+1) of each triangle the triangle beyond it.
///
/// returns empty unless the soup is a closed manifold without slivers: each edge has two triangles that agree on the
///         direction, the triangles around each vertex form one fan
std::vector<std::array<std::uint32_t, 3>> closedManifoldNeighbours(const TriangleSoup& soup);

} // namespace brickfield
