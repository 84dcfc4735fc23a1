// What can be said of one BrickField on the CPU.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "field/brick_field.h"

namespace brickfield {

struct LevelReport {
  float voxelSizeObject = 0;
  glm::ivec3 brickCounts{0};
  float rangeVoxels = 0;
  int bits = 8;
  std::uint64_t cells = 0;
  std::uint64_t bricks = 0;
  std::uint64_t emptyInside = 0; ///< cells
  std::uint64_t emptyOutside = 0;
  std::uint64_t bytes = 0;
  bool hasAttributes = false;
  double emptyShare() const {
    return cells ? static_cast<double>(emptyInside + emptyOutside) / static_cast<double>(cells) : 0;
  }
};

/// Finest level first.
std::vector<LevelReport> reportLevels(const BrickField& field);

struct SlicePlane {
  int axis = 0;             ///< 0 x, 1 y, 2 z
  float positionObject = 0; ///< metres along it
};
/// "x:0.25". error BadInput that names the flag
SlicePlane parseSlice(const std::string& flag, const std::string& text);

} // namespace brickfield
