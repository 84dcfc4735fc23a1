// The surface of a field as triangles: marching cubes over the cells of one level (cube_loops.h). Vertices lie on the
// edges of cells, exactly where the trilinear field has the value; loops of five and more get one more vertex in their
// middle, moved onto the surface. Sharp edges of a mesh are cut as the field itself cuts them, within a voxel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "field/brick_field.h"

namespace brickfield {

/// Object space. Three indices a triangle, counter-clockwise as seen from outside.
struct IsoSurface {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals; ///< a vertex: the field's unit gradient, outwards
  std::vector<std::uint32_t> indices;
};

/// Beyond this many voxels from the surface a level need not have bricks.
inline constexpr double kMostIsoVoxels = 0.9;

/// All points at the distance `isoMetres` from the field's surface, as a closed manifold: every edge has two triangles
/// that agree on its direction, every vertex one fan, for any field that validateField passes, whether or not its
/// bricks make sense; beyond the grid it is outside. Vertices keep 1/256 voxel from the grid's points, so that no two
/// are the same, as long as a voxel is at least 2^-14 of the coordinates.
///
/// isoMetres  negative: inside; at most kMostIsoVoxels of the level's voxels
/// progress   in layers of bricks; may cancel
/// returns    the same on every run; empty where the field has no inside
/// error      BadInput that names the setting: level, isoMetres; Cancelled
/// cost       one thread; about 2 us a triangle
/// proved by  tests/unit/field/iso_surface_test.cpp
IsoSurface extractIsoSurface(const BrickField& field, std::size_t level, double isoMetres,
                             const Progress& progress = {});

} // namespace brickfield
