// Counts.
#include "app/field_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/parse.h"
#include "core/error.h"

namespace brickfield {

std::vector<LevelReport> reportLevels(const BrickField& field) {
  std::vector<LevelReport> reports;
  for (const BrickLevel& level : field.levels) {
    LevelReport report;
    report.voxelSizeObject = level.voxelSizeObject;
    report.brickCounts = level.brickCounts;
    report.rangeVoxels = level.rangeVoxels;
    report.bits = level.format == DistanceFormat::R8Snorm ? 8 : 16;
    report.cells = level.indirection.size();
    report.bricks = level.brickCount();
    for (const std::uint32_t bits : level.indirection) {
      const IndirectionCell cell{bits};
      if (cell.isEmpty()) ++(cell.isInside() ? report.emptyInside : report.emptyOutside);
    }
    report.bytes = level.distances.size() + sizeof(std::uint32_t) * (level.indirection.size() + level.baseColor.size() +
                                                                     level.material.size() + level.emission.size());
    report.hasAttributes = !level.baseColor.empty();
    reports.push_back(report);
  }
  return reports;
}

SlicePlane parseSlice(const std::string& flag, const std::string& text) {
  const auto pieces = splitText(text, ':');
  const std::size_t axis = std::string_view("xyz").find(pieces[0]);
  if (pieces.size() != 2 || pieces[0].size() != 1 || axis == std::string_view::npos)
    throw BadInput(flag, fmt::format("\"{}\"", text), "is not AXIS:POSITION, such as x:0.25");
  return {static_cast<int>(axis), static_cast<float>(parseNumber(flag, pieces[1], -1e6, 1e6))};
}

} // namespace brickfield
