// Grid over a surface, the rule of which bricks are stored, and the encoding of a brick.
#include "field/brick_layout.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {
// Samples must differ by many float steps, or they coincide and bounds lie. With 256 steps a voxel the rounding of a
// point is below sqrt(3)/512 voxel, a quarter of the slack in brickBoundVoxels.
constexpr float kLeastStepsPerVoxel = 256.0f;
constexpr float kBoundSlackVoxels = 1.0f / 64.0f;

float largestMagnitude(const Box& box) {
  const glm::vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
  return std::max({reach.x, reach.y, reach.z});
}

int cellsToCover(float extent, float voxelSize) {
  // In double, where the quotient of two floats that divide evenly comes out whole or a hair off: the hair is dropped.
  return std::max(1, static_cast<int>(std::ceil(static_cast<double>(extent) / voxelSize - 1e-4)));
}
} // namespace

GridLayout layoutGrid(const Box& surfaceObject, int resolution, int mips) {
  if (resolution < 8 || resolution > 1024)
    throw BadInput("resolution", std::to_string(resolution), "must be from 8 to 1024");
  if (mips < 1 || mips > kMaxLevels)
    throw BadInput("mips", std::to_string(mips), fmt::format("must be from 1 to {}", kMaxLevels));
  if (surfaceObject.isEmpty() || !isFinite(surfaceObject.min) || !isFinite(surfaceObject.max))
    throw BadInput("surface box", "", "is empty or not finite");
  const glm::vec3 extent = surfaceObject.extent();
  const float longest = std::max({extent.x, extent.y, extent.z});
  const float voxelSize = longest / static_cast<float>(resolution);
  if (!std::isfinite(longest) || !(voxelSize >= 1e-18f) || voxelSize > 1e15f) // squares of distances must not overflow
    throw BadInput("surface box", "", fmt::format("a longest side of {} m cannot be divided into voxels", longest));
  const float floatStep = largestMagnitude(surfaceObject) * std::numeric_limits<float>::epsilon();
  if (voxelSize < kLeastStepsPerVoxel * floatStep)
    throw BadInput("surface box", "",
                   fmt::format("lies {} m from its origin, too far for voxels of {} m; move it nearer or lower the "
                               "resolution",
                               largestMagnitude(surfaceObject), voxelSize));

  GridLayout layout;
  layout.boundsObject = surfaceObject.expanded(voxelSize);
  layout.originObject = layout.boundsObject.min;
  const glm::vec3 extentGrown = layout.boundsObject.extent();
  for (int mip = 0; mip < mips; ++mip) {
    LevelLayout level;
    level.voxelSizeObject = std::ldexp(voxelSize, mip);
    glm::ivec3 cells;
    for (int axis = 0; axis < 3; ++axis) cells[axis] = cellsToCover(extentGrown[axis], level.voxelSizeObject);
    if (mip > 0 && std::max({cells.x, cells.y, cells.z}) < kBrickCells) break;
    level.brickCounts = (cells + (kBrickCells - 1)) / kBrickCells;
    layout.levels.push_back(level);
  }
  return layout;
}

DistanceFormat distanceFormatOfBits(int bits) {
  if (bits == 8) return DistanceFormat::R8Snorm;
  if (bits == 16) return DistanceFormat::R16Snorm;
  throw BadInput("bits", std::to_string(bits), "must be 8 or 16");
}

BrickLevel makeLevel(const LevelLayout& layout, DistanceFormat format, float rangeVoxels) {
  BrickLevel level;
  level.voxelSizeObject = layout.voxelSizeObject;
  level.brickCounts = layout.brickCounts;
  level.rangeVoxels = rangeVoxels;
  level.format = format;
  const auto cells = static_cast<std::size_t>(layout.brickCounts.x) * static_cast<std::size_t>(layout.brickCounts.y) *
                     static_cast<std::size_t>(layout.brickCounts.z);
  level.indirection.assign(cells, IndirectionCell::empty(false, 0).bits);
  return level;
}

float brickBoundVoxels(float centerDistanceVoxels) {
  // The distance changes by at most the way gone, and no point of the brick is farther than half a diagonal.
  return std::abs(centerDistanceVoxels) - kBrickHalfDiagonalVoxels - kBoundSlackVoxels;
}

float rangeVoxelsWithoutClamp(float largestDistanceVoxels) {
  return std::max(kNarrowBandVoxels, std::ceil(largestDistanceVoxels));
}

namespace {

/// As encodeDistance, of a share of the range that is clamped; without branches.
inline std::int32_t encodeShare(float share, float distanceVoxels, DistanceFormat format) {
  const float value = share * static_cast<float>(largestCode(format));
  const auto whole = static_cast<std::int32_t>(value);
  const float rest = value - static_cast<float>(whole); // exact
  const std::int32_t code = whole + std::int32_t{rest >= 0.5f} - std::int32_t{rest <= -0.5f};
  return code - (std::int32_t{code == 0} & std::int32_t{distanceVoxels < 0.0f});
}

} // namespace

void writeBrickVoxels(BrickLevel& level, std::size_t brickIndex, std::span<const float, kBrickSampleCount> distances) {
  const float range = level.rangeVoxels;
  std::byte* to = level.distances.data() + brickIndex * kBrickSampleCount * bytesPerSample(level.format);
  // A loop for each step, apart from the bytes, which could be anything's: compilers take four samples at once.
  std::array<float, kBrickSampleCount> shares;
  std::array<std::int32_t, kBrickSampleCount> codes;
  for (std::size_t i = 0; i < kBrickSampleCount; ++i) shares[i] = distances[i] / range;
  for (float& share : shares) share = share < 1.0f ? share : 1.0f; // NaN too
  for (float& share : shares) share = share > -1.0f ? share : -1.0f;
  const auto encode = [&](DistanceFormat format) {
    for (std::size_t i = 0; i < kBrickSampleCount; ++i) codes[i] = encodeShare(shares[i], distances[i], format);
  };
  if (level.format == DistanceFormat::R8Snorm) {
    encode(DistanceFormat::R8Snorm);
    for (std::size_t i = 0; i < kBrickSampleCount; ++i) to[i] = static_cast<std::byte>(codes[i] & 0xff);
    return;
  }
  encode(DistanceFormat::R16Snorm);
  for (std::size_t i = 0; i < kBrickSampleCount; ++i) {
    to[2 * i] = static_cast<std::byte>(codes[i] & 0xff);
    to[2 * i + 1] = static_cast<std::byte>((codes[i] >> 8) & 0xff);
  }
}

void appendBrick(BrickLevel& level, glm::ivec3 brick, std::span<const float, kBrickSampleCount> distancesObject) {
  const std::uint32_t brickIndex = level.brickCount();
  level.distances.resize(level.distances.size() + kBrickSampleCount * bytesPerSample(level.format));
  std::array<float, kBrickSampleCount> voxels;
  for (std::size_t i = 0; i < kBrickSampleCount; ++i) voxels[i] = distancesObject[i] / level.voxelSizeObject;
  writeBrickVoxels(level, brickIndex, voxels);
  level.indirection[level.cellIndex(brick)] = IndirectionCell::brick(brickIndex).bits;
}

} // namespace brickfield
