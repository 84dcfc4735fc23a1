// Encoding of distances and trilinear sampling of one level.
#include "field/brick_field.h"

#include <algorithm>
#include <cmath>

#include "field/brick_layout.h"
#include "field/brick_lookup.h"

namespace brickfield {

IndirectionCell IndirectionCell::empty(bool inside, float boundVoxels) {
  constexpr float kMostSteps = 65535.0f;
  const float steps = std::floor(boundVoxels * kBoundStepsPerVoxel);
  // Written so that NaN gives 0, the bound that promises nothing.
  const auto bound = static_cast<std::uint32_t>(steps > 0.0f ? std::min(steps, kMostSteps) : 0.0f);
  return {kEmptyBit | (inside ? kInsideBit : 0u) | bound};
}

float decodeDistance(std::int32_t code, float rangeVoxels, DistanceFormat format) {
  // The lowest code (-128, -32768) stands for -1 as well, as OpenGL defines SNORM.
  return std::max(static_cast<float>(code) / static_cast<float>(largestCode(format)), -1.0f) * rangeVoxels;
}

float storedDistance(const BrickLevel& level, std::uint32_t brickIndex, glm::ivec3 sample) {
  const std::size_t index = std::size_t{brickIndex} * kBrickSampleCount + sampleIndex(sample);
  std::int32_t code;
  if (level.format == DistanceFormat::R8Snorm) {
    code = static_cast<std::int8_t>(level.distances[index]);
  } else {
    const auto low = static_cast<std::uint16_t>(level.distances[2 * index]);
    const auto high = static_cast<std::uint16_t>(level.distances[2 * index + 1]);
    code = static_cast<std::int16_t>(static_cast<std::uint16_t>(low | high << 8));
  }
  return decodeDistance(code, level.rangeVoxels, level.format);
}

VoxelCorners voxelCorners(const BrickLevel& level, std::uint32_t brickIndex, glm::ivec3 voxelOfBrick) {
  VoxelCorners corners;
  for (int i = 0; i < 8; ++i)
    corners[static_cast<std::size_t>(i)] =
        storedDistance(level, brickIndex, voxelOfBrick + glm::ivec3(i & 1, (i >> 1) & 1, i >> 2));
  return corners;
}

double sampleVoxels(const BrickLevel& level, glm::dvec3 pointVoxels) {
  const glm::dvec3 clamped = glm::clamp(pointVoxels, glm::dvec3(0), glm::dvec3(kBrickCells * level.brickCounts));
  const glm::ivec3 voxel = voxelAt(level, clamped);
  const glm::ivec3 brick = brickOfVoxel(voxel);
  const IndirectionCell cell = cellAt(level, brick);
  if (cell.isEmpty()) return cell.isInside() ? -cell.boundVoxels() : cell.boundVoxels();
  return trilinear(voxelCorners(level, cell.brickIndex(), voxel - kBrickCells * brick), clamped - glm::dvec3(voxel));
}

float sampleDistance(const BrickField& field, std::size_t level, glm::vec3 pointObject) {
  const BrickLevel& bricks = field.levels[level];
  const double voxelSize = bricks.voxelSizeObject;
  const glm::dvec3 pointVoxels = (glm::dvec3(pointObject) - glm::dvec3(field.originObject)) / voxelSize;
  return static_cast<float>(sampleVoxels(bricks, pointVoxels) * voxelSize);
}

glm::vec3 fieldNormal(const BrickField& field, std::size_t level, glm::vec3 pointObject) {
  const BrickLevel& bricks = field.levels[level];
  const glm::dvec3 pointVoxels =
      (glm::dvec3(pointObject) - glm::dvec3(field.originObject)) / static_cast<double>(bricks.voxelSizeObject);
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 halfVoxel(0);
    halfVoxel[axis] = 0.5;
    gradient[axis] = sampleVoxels(bricks, pointVoxels + halfVoxel) - sampleVoxels(bricks, pointVoxels - halfVoxel);
  }
  const double length = glm::length(gradient);
  // Where the field is flat (deep inside a clamped brick, an empty cell) any unit vector is as good as another.
  return length > 0.0 ? glm::vec3(gradient / length) : glm::vec3(0, 1, 0);
}

std::size_t fieldBytes(const BrickField& field) {
  std::size_t bytes = 0;
  for (const BrickLevel& level : field.levels)
    bytes += level.distances.size() + sizeof(std::uint32_t) * (level.indirection.size() + level.baseColor.size() +
                                                               level.material.size() + level.emission.size());
  return bytes;
}

} // namespace brickfield
