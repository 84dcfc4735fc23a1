// Reading one level in its own space, where a voxel has edge 1 and sample 0 lies at 0: what sampling and tracing share.
// In double, so that a ray may start far away and a crossing is found to a small part of a voxel.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/glm.hpp>

#include "field/brick_field.h"

namespace brickfield {

/// The eight samples of a voxel, in voxels: corner (x,y,z) at index x + 2y + 4z.
using VoxelCorners = std::array<double, 8>;

inline double trilinear(const VoxelCorners& c, glm::dvec3 f) {
  const double y0z0 = c[0] + (c[1] - c[0]) * f.x, y1z0 = c[2] + (c[3] - c[2]) * f.x;
  const double y0z1 = c[4] + (c[5] - c[4]) * f.x, y1z1 = c[6] + (c[7] - c[6]) * f.x;
  const double z0 = y0z0 + (y1z0 - y0z0) * f.y, z1 = y0z1 + (y1z1 - y0z1) * f.y;
  return z0 + (z1 - z0) * f.z;
}

/// The voxel that a point is in, counted through the whole level, clamped to the grid. On a border it is the voxel that
/// a ray of the given direction is about to pass; without a direction the one above. Integers decide, not a quotient by
/// 7, which may round up to the next brick.
inline glm::ivec3 voxelAt(const BrickLevel& level, glm::dvec3 pointVoxels, glm::dvec3 direction = glm::dvec3(0)) {
  glm::ivec3 voxel;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = direction[axis] < 0 ? std::ceil(pointVoxels[axis]) - 1 : std::floor(pointVoxels[axis]);
    voxel[axis] = static_cast<int>(std::clamp(at, 0.0, kBrickCells * level.brickCounts[axis] - 1.0));
  }
  return voxel;
}
inline glm::ivec3 brickOfVoxel(glm::ivec3 voxel) { return voxel / kBrickCells; }

inline IndirectionCell cellAt(const BrickLevel& level, glm::ivec3 brick) {
  return IndirectionCell{level.indirection[level.cellIndex(brick)]};
}

/// voxelOfBrick 0 to 6 along each axis
VoxelCorners voxelCorners(const BrickLevel& level, std::uint32_t brickIndex, glm::ivec3 voxelOfBrick);

/// Signed distance in voxels at a point of the level's space, clamped to the grid.
double sampleVoxels(const BrickLevel& level, glm::dvec3 pointVoxels);

} // namespace brickfield
