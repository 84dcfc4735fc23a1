// Operations on a Primitive's vertices that the importer composes: triangle lists from strips and fans, gathering
// vertices, normals and tangents where a file has none. Useful to hosts that build scenes by hand, too.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace brickfield {

enum class TriangleTopology : std::uint8_t { List, Strip, Fan };

/// The triangles of a run of vertices as a list, front faces kept counter-clockwise. Left-over vertices of an
/// incomplete triangle are dropped.
std::vector<std::uint32_t> triangleList(TriangleTopology topology, std::span<const std::uint32_t> vertices);

/// Makes vertex i a copy of the old vertex sources[i], with all attributes, influences and morph targets. Indices stay.
void gatherVertices(Primitive& primitive, const std::vector<std::uint32_t>& sources);

/// Gives every triangle vertices of its own and its own normal; tangents and morphed normals are dropped, flatNormals
/// is set. Triangles without area get +Z.
void makeFlat(Primitive& primitive);

/// What had to be changed in given normals.
struct NormalRepair {
  std::uint64_t rescaled = 0; ///< length off by more than 2 %: eight normalized bits already err by 0.7 %
  std::uint64_t replaced = 0; ///< zero: made from the triangles around
};
/// Makes all normals unit.
NormalRepair repairNormals(Primitive& primitive);

/// Tangents by MikkTSpace over uv set `uvSet`; splits vertices where tangent spaces differ. Without that uv set every
/// vertex gets some perpendicular.
void makeTangents(Primitive& primitive, int uvSet);

} // namespace brickfield
