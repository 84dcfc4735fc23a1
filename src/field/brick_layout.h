// How bricks are laid over a surface and filled: the part that the mesh baker and the analytic baker share. It decides
// where samples lie, which bricks are stored and what stands in the cells of the others. It computes no distances.
//
//   boundsObject.min = sample 0 of every level
//   |<-- 1 h -->|<------ surface box ------>|<-- 1 h -->|        h: voxel of the finest level
//   |-------------|-------------|-------------|-------------|    bricks of 7 h; the last may reach beyond boundsObject
//   |---------------------------|---------------------------|    the next level: bricks of 14 h over the same box
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/brick_field.h"

namespace brickfield {

inline constexpr float kNarrowBandVoxels = 4.0f; // range of every level but the coarsest
inline constexpr float kTouchVoxels = 1.0f;      // a brick is stored if the surface comes this near to it
inline constexpr float kBrickHalfDiagonalVoxels = 0.5f * static_cast<float>(kBrickCells) * 1.7320509f;

// What a field may have at most: validateField, the file reader and the layout refuse more.
inline constexpr int kMaxLevels = 8;
inline constexpr int kMaxBricksPerAxis = 1024;
inline constexpr std::uint64_t kMaxCellsPerLevel = std::uint64_t{1} << 24;
inline constexpr std::uint64_t kMaxFieldBytes = std::uint64_t{8} << 30;
inline constexpr float kMaxRangeVoxels = 65536.0f; // the longest diagonal of a level has 12,416 voxels

struct LevelLayout {
  float voxelSizeObject = 0;
  glm::ivec3 brickCounts{0};
};

struct GridLayout {
  Box boundsObject;                ///< the surface grown by one voxel of the finest level
  glm::vec3 originObject{0};       ///< boundsObject.min
  std::vector<LevelLayout> levels; ///< finest first
};

/// The grid over a surface.
///
/// surfaceObject metres in object space; may be flat along an axis, its longest side must be positive
/// resolution    voxels along the longest side, 8 to 1024
/// mips          levels, 1 to 8; levels of less than one brick (7 cells) along the longest side are left out
/// error         BadInput: empty, infinite or too small a box; a box so far from the origin that floats cannot tell
///               the samples apart; settings out of range
/// proved by     tests/unit/field/brick_layout_test.cpp
GridLayout layoutGrid(const Box& surfaceObject, int resolution, int mips);

/// The format of 8 or 16 bits a sample. error BadInput for other numbers.
DistanceFormat distanceFormatOfBits(int bits);

/// A level of the layout, all cells empty and outside with a bound of 0, no bricks.
BrickLevel makeLevel(const LevelLayout& layout, DistanceFormat format, float rangeVoxels = kNarrowBandVoxels);

/// Where a sample lies. The same grid point gives the same float whichever brick asks.
inline glm::vec3 samplePointObject(glm::vec3 originObject, float voxelSizeObject, glm::ivec3 brick, glm::ivec3 sample) {
  return originObject + voxelSizeObject * glm::vec3(kBrickCells * brick + sample);
}
inline glm::vec3 brickCenterObject(glm::vec3 originObject, float voxelSizeObject, glm::ivec3 brick) {
  return originObject + voxelSizeObject * (static_cast<float>(kBrickCells) * (glm::vec3(brick) + 0.5f));
}

/// Position of a sample in the 512 of its brick.
inline std::size_t sampleIndex(glm::ivec3 sample) {
  return static_cast<std::size_t>((sample.z * kBrickSamples + sample.y) * kBrickSamples + sample.x);
}

/// Lower bound in voxels of the unsigned distance over a closed brick, from the true one at its centre, less a slack of
/// 1/64 voxel for float rounding. At most 0 where the surface may cross the brick.
float brickBoundVoxels(float centerDistanceVoxels);

/// Whether a brick with this bound is stored; if not, its cell is IndirectionCell::empty(inside, boundVoxels).
inline bool isBrickStored(float boundVoxels) { return boundVoxels <= kTouchVoxels; }

/// Range that clamps no distance of a level whose largest absolute one is given: whole voxels, at least 4.
float rangeVoxelsWithoutClamp(float largestDistanceVoxels);

/// Encodes one brick in place; safe from several threads for different bricks. `level.distances` must be large enough.
/// distances voxels of the level, negative inside, i fastest
void writeBrickVoxels(BrickLevel& level, std::size_t brickIndex, std::span<const float, kBrickSampleCount> distances);

/// Adds one brick at the end and points its cell at it.
/// distancesObject metres, negative inside, i fastest
void appendBrick(BrickLevel& level, glm::ivec3 brick, std::span<const float, kBrickSampleCount> distancesObject);

} // namespace brickfield
