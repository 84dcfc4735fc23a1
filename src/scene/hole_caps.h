// Triangles that close the small holes of a surface: ears are cut off the loops around them, the roundest first.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace brickfield {

/// An edge that one triangle uses, walked as one beyond it would.
struct RimEdge {
  std::uint32_t component;
  std::uint32_t from, to;   ///< welded vertices
  std::uint32_t primitive;  ///< of the edge's triangle
  std::uint32_t vertexFrom; ///< of the primitive
  glm::dvec3 pointFrom;
};

/// Numbers of rim edges that begin at its corners.
using HoleCap = std::array<std::uint32_t, 3>;

/// All holes of a component are closed, or none is.
///
/// rims       of components whose other edges are fine, all of each
/// areas      of the components, before
/// triangles  welded vertices; of those that are no rim's anything
/// returns    caps, those of a primitive together
/// bound      see analyseSurface
/// cost       quadratic in a loop's edges
/// proved by  tests/unit/scene/surface_topology_test.cpp
std::vector<HoleCap> capSmallHoles(std::span<const RimEdge> rims, std::span<const double> areas,
                                   std::span<const std::array<std::uint32_t, 3>> triangles);

} // namespace brickfield
