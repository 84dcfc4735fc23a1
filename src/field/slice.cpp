// One sample a pixel, coloured by signed distance with lines of even width.
#include "field/slice.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "field/brick_lookup.h"

namespace brickfield {

namespace {

constexpr int kLargestSidePixels = 16384;
// Colours of a picture, chosen to be told apart by the colour-blind: blue and orange differ in every kind of sight.
constexpr glm::vec3 kInside{0.10f, 0.35f, 0.80f}, kOutside{0.90f, 0.50f, 0.10f}, kPale{0.96f}, kEmpty{0.62f};

struct Pixel {
  double distanceVoxels = 0;
  bool isEmptyCell = false;
  bool isClamped = false;
};

Pixel readPixel(const BrickLevel& level, glm::dvec3 pointVoxels) {
  Pixel pixel;
  pixel.distanceVoxels = sampleVoxels(level, pointVoxels);
  pixel.isEmptyCell = cellAt(level, brickOfVoxel(voxelAt(level, pointVoxels))).isEmpty();
  // A voxel that is clamped in part already bends the distance.
  pixel.isClamped = std::abs(pixel.distanceVoxels) > level.rangeVoxels - 0.5;
  return pixel;
}

// How much a line of the given half width covers a pixel whose centre is so far from it, all in pixels.
float lineCoverage(double fromLinePixels, double halfWidthPixels) {
  return static_cast<float>(std::clamp(halfWidthPixels + 0.5 - fromLinePixels, 0.0, 1.0));
}

glm::vec3 pixelColor(const Pixel& pixel, double pixelVoxels) {
  constexpr double kFadeVoxels = 12.0, kIsoHalfWidth = 0.5, kSurfaceHalfWidth = 1.5;
  const bool isInside = std::signbit(pixel.distanceVoxels);
  const glm::vec3 full = isInside ? kInside : kOutside;
  if (pixel.isEmptyCell) return glm::mix(full, kEmpty, 0.8f);
  const double distance = std::abs(pixel.distanceVoxels);
  glm::vec3 color = glm::mix(full, kPale, static_cast<float>(std::min(1.0, distance / kFadeVoxels)));
  // Lines nearer than four pixels would run into one another; a clamped distance stays on one value and is no line.
  constexpr double kLeastPixelsBetweenLines = 4.0;
  if (!pixel.isClamped && pixelVoxels * kLeastPixelsBetweenLines <= 1.0)
    color *= 1.0f - 0.3f * lineCoverage(std::abs(distance - std::round(distance)) / pixelVoxels, kIsoHalfWidth);
  return color * (1.0f - lineCoverage(distance / pixelVoxels, kSurfaceHalfWidth));
}

float planePosition(const BrickField& field, const SliceCut& cut) {
  if (cut.axis < 0 || cut.axis > 2) throw BadInput("slice", "axis", fmt::format("{} is not 0, 1 or 2", cut.axis));
  if (cut.level >= field.levels.size())
    throw BadInput("slice", "level", fmt::format("{} of {}", cut.level, field.levels.size()));
  if (cut.longerSidePixels < 1 || cut.longerSidePixels > kLargestSidePixels)
    throw BadInput("slice", "size",
                   fmt::format("{} pixels are not from 1 to {}", cut.longerSidePixels, kLargestSidePixels));
  const float first = field.boundsObject.min[cut.axis], last = field.boundsObject.max[cut.axis];
  const float least = cut.isFraction ? 0.0f : first, most = cut.isFraction ? 1.0f : last;
  if (!(cut.position >= least && cut.position <= most))
    throw BadInput("slice", "position",
                   fmt::format("{:g} misses the field, which reaches from {:g} to {:g} along {}", cut.position, least,
                               most, "xyz"[cut.axis]));
  return cut.isFraction ? glm::mix(first, last, cut.position) : cut.position;
}

} // namespace

SliceImage cutField(const BrickField& field, const SliceCut& cut) {
  const float position = planePosition(field, cut);
  const BrickLevel& level = field.levels[cut.level];
  const int right = (cut.axis + 1) % 3, up = (cut.axis + 2) % 3;
  const glm::dvec3 extent(field.boundsObject.extent());
  const double pixelObject = std::max(extent[right], extent[up]) / cut.longerSidePixels;
  const auto pixelsAlong = [&](int axis) {
    const double pixels = pixelObject > 0 ? std::ceil(extent[axis] / pixelObject - 1e-6) : 1;
    return std::clamp(static_cast<int>(pixels), 1, cut.longerSidePixels);
  };
  SliceImage image{{pixelsAlong(right), pixelsAlong(up)}, {}};
  image.rgb.reserve(std::size_t{3} * static_cast<std::size_t>(image.size.x) * static_cast<std::size_t>(image.size.y));
  const double voxelSize = level.voxelSizeObject;
  for (int y = 0; y < image.size.y; ++y)
    for (int x = 0; x < image.size.x; ++x) {
      glm::dvec3 point(field.boundsObject.min);
      point[cut.axis] = position;
      point[right] += (x + 0.5) * pixelObject;
      point[up] = field.boundsObject.max[up] - (y + 0.5) * pixelObject;
      const Pixel pixel = readPixel(level, (point - glm::dvec3(field.originObject)) / voxelSize);
      const glm::vec3 color = pixelColor(pixel, pixelObject / voxelSize);
      for (int i = 0; i < 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(color[i] * 255.0f + 0.5f));
    }
  return image;
}

} // namespace brickfield
