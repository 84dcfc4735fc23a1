// Counts and a coloured cut.
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

namespace {

glm::vec3 sliceColor(float distanceVoxels) {
  constexpr float kSurfaceVoxels = 0.35f, kLineVoxels = 0.06f, kFadeVoxels = 12.0f;
  if (std::abs(distanceVoxels) < kSurfaceVoxels) return glm::vec3(0.0f);
  const glm::vec3 full = distanceVoxels < 0 ? glm::vec3(0.1f, 0.35f, 0.8f) : glm::vec3(0.9f, 0.5f, 0.1f);
  const glm::vec3 pale = glm::mix(full, glm::vec3(0.95f), std::min(1.0f, std::abs(distanceVoxels) / kFadeVoxels));
  const float toLine = std::abs(distanceVoxels - std::round(distanceVoxels));
  return toLine < kLineVoxels ? 0.75f * pale : pale;
}

} // namespace

RgbImage sliceField(const BrickField& field, const SlicePlane& plane) {
  constexpr float kLongerSidePixels = 512;
  const Box& bounds = field.boundsObject;
  const int right = (plane.axis + 1) % 3, up = (plane.axis + 2) % 3;
  if (plane.positionObject < bounds.min[plane.axis] || plane.positionObject > bounds.max[plane.axis])
    throw BadInput("--slice", fmt::format("{}:{:g}", "xyz"[plane.axis], plane.positionObject),
                   fmt::format("misses the field, which reaches from {:g} to {:g}", bounds.min[plane.axis],
                               bounds.max[plane.axis]));
  const glm::vec3 extent = bounds.extent();
  const float pixelsPerMetre = kLongerSidePixels / std::max(extent[right], extent[up]);
  const glm::uvec2 size = glm::max(
      glm::uvec2(std::ceil(extent[right] * pixelsPerMetre), std::ceil(extent[up] * pixelsPerMetre)), glm::uvec2(1));
  RgbImage image{size, {}};
  image.pixels.reserve(std::size_t{size.x} * size.y);
  for (std::uint32_t y = 0; y < size.y; ++y)
    for (std::uint32_t x = 0; x < size.x; ++x) {
      glm::vec3 pointObject;
      pointObject[plane.axis] = plane.positionObject;
      pointObject[right] = bounds.min[right] + (static_cast<float>(x) + 0.5f) / pixelsPerMetre;
      pointObject[up] = bounds.max[up] - (static_cast<float>(y) + 0.5f) / pixelsPerMetre;
      image.pixels.push_back(sliceColor(sampleDistance(field, 0, pointObject) / field.levels[0].voxelSizeObject));
    }
  return image;
}

} // namespace brickfield
