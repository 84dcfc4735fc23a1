// The gate: whatever passes validateField can be sampled, traced and uploaded without a further check.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "field/brick_field.h"
#include "field/brick_layout.h"

namespace brickfield {

namespace {

std::string grid(glm::ivec3 counts) { return fmt::format("{}x{}x{}", counts.x, counts.y, counts.z); }

std::uint64_t cellCount(glm::ivec3 counts) {
  return static_cast<std::uint64_t>(counts.x) * static_cast<std::uint64_t>(counts.y) *
         static_cast<std::uint64_t>(counts.z);
}

std::string validateShape(const BrickLevel& level) {
  if (!(std::isnormal(level.voxelSizeObject) && level.voxelSizeObject > 0.0f))
    return fmt::format("voxel size {} is not a positive number", level.voxelSizeObject);
  if (!(level.rangeVoxels > 0.0f && level.rangeVoxels <= kMaxRangeVoxels))
    return fmt::format("range of {} voxels is not above 0 and at most {}", level.rangeVoxels, kMaxRangeVoxels);
  if (level.format != DistanceFormat::R8Snorm && level.format != DistanceFormat::R16Snorm)
    return fmt::format("distance format {} is unknown", static_cast<std::uint32_t>(level.format));
  for (int axis = 0; axis < 3; ++axis)
    if (level.brickCounts[axis] < 1 || level.brickCounts[axis] > kMaxBricksPerAxis)
      return fmt::format("{} bricks are not from 1 to {} along each axis", grid(level.brickCounts), kMaxBricksPerAxis);
  if (cellCount(level.brickCounts) > kMaxCellsPerLevel)
    return fmt::format("{} bricks are more than {}", grid(level.brickCounts), kMaxCellsPerLevel);
  return {};
}

std::string validateArrays(const BrickLevel& level) {
  if (level.indirection.size() != cellCount(level.brickCounts))
    return fmt::format("{} indirection cells for {} bricks", level.indirection.size(), grid(level.brickCounts));
  if (level.distances.size() % (kBrickSampleCount * bytesPerSample(level.format)) != 0)
    return fmt::format("{} bytes of distances are no whole number of bricks", level.distances.size());
  const std::uint64_t bricks = level.distances.size() / (kBrickSampleCount * bytesPerSample(level.format));
  if (bricks > level.indirection.size())
    return fmt::format("{} bricks for {} indirection cells", bricks, level.indirection.size());
  const std::uint64_t samples = bricks * kBrickSampleCount;
  const bool hasAttributes = !level.baseColor.empty() || !level.material.empty();
  if (hasAttributes && (level.baseColor.size() != samples || level.material.size() != samples))
    return fmt::format("{} base colours and {} materials for {} samples", level.baseColor.size(), level.material.size(),
                       samples);
  if (!level.emission.empty() && !(hasAttributes && level.emission.size() == samples))
    return fmt::format("{} emissions for {} samples{}", level.emission.size(), samples,
                       hasAttributes ? "" : " without base colour");
  return {};
}

std::string validateCells(const BrickLevel& level, bool isCoarsest) {
  constexpr std::uint32_t kUsedWhereEmpty = IndirectionCell::kEmptyBit | IndirectionCell::kInsideBit | 0xffffu;
  const std::uint32_t bricks = level.brickCount();
  for (std::size_t i = 0; i < level.indirection.size(); ++i) {
    const IndirectionCell cell{level.indirection[i]};
    if (!cell.isEmpty() && cell.brickIndex() >= bricks)
      return fmt::format("indirection cell {} names brick {} of {}", i, cell.brickIndex(), bricks);
    if (cell.isEmpty() && (cell.bits & ~kUsedWhereEmpty) != 0)
      return fmt::format("indirection cell {} has unknown bits (0x{:08x})", i, cell.bits);
    if (cell.isEmpty() && isCoarsest)
      return fmt::format("indirection cell {} is empty, but the coarsest level must have every brick", i);
  }
  return {};
}

// The grid must reach around the bounds, but for the rounding of floats and the hair that the layout drops.
std::string validateCover(const BrickField& field, const BrickLevel& level) {
  const double voxelSize = level.voxelSizeObject;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = field.originObject[axis];
    const double last = first + voxelSize * kBrickCells * level.brickCounts[axis];
    const double slack = 1e-2 * voxelSize;
    if (field.boundsObject.min[axis] < first - slack || field.boundsObject.max[axis] > last + slack)
      return fmt::format("the grid spans {} to {} m along {}, the bounds {} to {}", first, last, "xyz"[axis],
                         field.boundsObject.min[axis], field.boundsObject.max[axis]);
  }
  return {};
}

std::string validateLevel(const BrickField& field, std::size_t index) {
  const BrickLevel& level = field.levels[index];
  std::string wrong = validateShape(level);
  if (wrong.empty() && index > 0 && level.voxelSizeObject != 2.0f * field.levels[index - 1].voxelSizeObject)
    wrong = fmt::format("voxel size {} is not twice that of the level before ({})", level.voxelSizeObject,
                        field.levels[index - 1].voxelSizeObject);
  if (wrong.empty()) wrong = validateCover(field, level);
  if (wrong.empty()) wrong = validateArrays(level);
  if (wrong.empty()) wrong = validateCells(level, index + 1 == field.levels.size());
  return wrong;
}

} // namespace

std::string validateField(const BrickField& field) {
  if (field.levels.empty() || field.levels.size() > static_cast<std::size_t>(kMaxLevels))
    return fmt::format("{} levels are not from 1 to {}", field.levels.size(), kMaxLevels);
  if (!isFinite(field.boundsObject.min) || !isFinite(field.boundsObject.max) || field.boundsObject.isEmpty())
    return "the bounds are empty or not finite";
  if (!isFinite(field.originObject)) return "the origin is not finite";
  if (field.thinParts.perTenThousand > ThinParts::kWhole)
    return fmt::format("thin parts of {} ten-thousandths are more than all of the surface",
                       field.thinParts.perTenThousand);
  for (std::size_t i = 0; i < field.levels.size(); ++i)
    if (const std::string wrong = validateLevel(field, i); !wrong.empty()) return fmt::format("level {}: {}", i, wrong);
  if (fieldBytes(field) > kMaxFieldBytes)
    return fmt::format("{} bytes are more than {}", fieldBytes(field), kMaxFieldBytes);
  return {};
}

} // namespace brickfield
