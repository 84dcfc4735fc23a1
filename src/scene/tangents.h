// Tangent space for normal maps by the rules of MikkTSpace (Mikkelsen, "Simulation of Wrinkled Surfaces Revisited",
// 2008), which glTF prescribes where a file brings no tangents. Written from the description; see tangents.cpp for
// where it deviates.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"

namespace brickfield {

/// Tangents of every corner of an indexed triangle list.
///
/// indices   three a triangle, below the number of positions
/// normals   unit; uvs of the normal map; both as many as positions
/// returns   one for each index: xyz unit and perpendicular to the corner's normal, w = +1 or -1 so that
///           bitangent = w * cross(normal, tangent),
///           which points against growing v: up in the image, as green in a glTF normal map. Corners of one vertex may
///           differ: split it there (makeTangents in primitive_build.h does). Corners of triangles without area in
///           space or uv take over their neighbour's, or an arbitrary perpendicular.
/// cost      O(n log n) in the number of corners
/// proved by tests/unit/scene/tangents_test.cpp
std::vector<glm::vec4> cornerTangents(std::span<const std::uint32_t> indices, std::span<const glm::vec3> positions,
                                      std::span<const glm::vec3> normals, std::span<const glm::vec2> uvs);

/// Some unit vector perpendicular to a unit normal, the same for the same normal.
glm::vec3 anyPerpendicular(glm::vec3 normal);

} // namespace brickfield
