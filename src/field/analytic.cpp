// Closed-form distances, and baking them brick by brick.
#include "field/analytic.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "field/brick_layout.h"

namespace brickfield {

float sphereDistance(glm::vec3 point, glm::vec3 center, float radius) { return glm::length(point - center) - radius; }

float boxDistance(glm::vec3 point, glm::vec3 center, glm::vec3 halfExtent) {
  const glm::vec3 beyond = glm::abs(point - center) - halfExtent;
  const float inside = std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0f);
  return glm::length(glm::max(beyond, glm::vec3(0))) + inside;
}

float torusDistance(glm::vec3 point, glm::vec3 center, float ringRadius, float tubeRadius) {
  const glm::vec3 p = point - center;
  return glm::length(glm::vec2(glm::length(glm::vec2(p.x, p.z)) - ringRadius, p.y)) - tubeRadius;
}

float planeDistance(glm::vec3 point, glm::vec3 normal, float offset) { return glm::dot(point, normal) - offset; }

namespace {

using BrickDistances = std::array<float, kBrickSampleCount>;

template <typename Visit>
void forEachIn(glm::ivec3 counts, const Visit& visit) {
  for (int z = 0; z < counts.z; ++z)
    for (int y = 0; y < counts.y; ++y)
      for (int x = 0; x < counts.x; ++x) visit(glm::ivec3(x, y, z));
}

float finiteDistance(const DistanceFunction& distance, glm::vec3 pointObject) {
  const float value = distance(pointObject);
  if (!std::isfinite(value))
    throw BadInput("distance function", fmt::format("at {}, {}, {}", pointObject.x, pointObject.y, pointObject.z),
                   fmt::format("gives {}", value));
  return value;
}

void fillBrick(const DistanceFunction& distance, const BrickLevel& level, glm::vec3 origin, glm::ivec3 brick,
               BrickDistances& distances) {
  forEachIn(glm::ivec3(kBrickSamples), [&](glm::ivec3 sample) {
    const glm::vec3 point = samplePointObject(origin, level.voxelSizeObject, brick, sample);
    distances[sampleIndex(sample)] = finiteDistance(distance, point);
  });
}

BrickLevel bakeSparseLevel(const DistanceFunction& distance, const LevelLayout& layout, glm::vec3 origin,
                           DistanceFormat format) {
  BrickLevel level = makeLevel(layout, format);
  BrickDistances distances;
  forEachIn(level.brickCounts, [&](glm::ivec3 brick) {
    const float atCenter = finiteDistance(distance, brickCenterObject(origin, level.voxelSizeObject, brick));
    const float bound = brickBoundVoxels(atCenter / level.voxelSizeObject);
    if (!isBrickStored(bound)) {
      level.indirection[level.cellIndex(brick)] = IndirectionCell::empty(atCenter < 0, bound).bits;
      return;
    }
    fillBrick(distance, level, origin, brick, distances);
    appendBrick(level, brick, distances);
  });
  return level;
}

BrickLevel bakeWholeLevel(const DistanceFunction& distance, const LevelLayout& layout, glm::vec3 origin) {
  BrickLevel level = makeLevel(layout, DistanceFormat::R16Snorm);
  std::vector<BrickDistances> bricks(level.indirection.size());
  float largest = 0;
  forEachIn(level.brickCounts, [&](glm::ivec3 brick) {
    BrickDistances& distances = bricks[level.cellIndex(brick)];
    fillBrick(distance, level, origin, brick, distances);
    for (const float value : distances) largest = std::max(largest, std::abs(value));
  });
  level.rangeVoxels = rangeVoxelsWithoutClamp(largest / level.voxelSizeObject);
  if (level.rangeVoxels > kMaxRangeVoxels)
    throw BadInput("distance function", "", fmt::format("gives {} m, too far from the bounds", largest));
  forEachIn(level.brickCounts, [&](glm::ivec3 brick) { appendBrick(level, brick, bricks[level.cellIndex(brick)]); });
  return level;
}

} // namespace

BrickField makeAnalyticField(const DistanceFunction& distance, Box boundsSurface, int resolution, int bits, int mips) {
  const DistanceFormat format = distanceFormatOfBits(bits);
  const GridLayout layout = layoutGrid(boundsSurface, resolution, mips);
  BrickField field;
  field.boundsObject = layout.boundsObject;
  field.originObject = layout.originObject;
  for (std::size_t i = 0; i < layout.levels.size(); ++i) {
    const bool isCoarsest = i + 1 == layout.levels.size();
    field.levels.push_back(isCoarsest ? bakeWholeLevel(distance, layout.levels[i], field.originObject)
                                      : bakeSparseLevel(distance, layout.levels[i], field.originObject, format));
  }
  return field;
}

void addAttributes(BrickField& field, const std::function<SurfaceAttributes(glm::vec3 pointObject)>& attributes) {
  for (BrickLevel& level : field.levels) {
    const std::size_t samples = std::size_t{level.brickCount()} * kBrickSampleCount;
    level.baseColor.assign(samples, 0);
    level.material.assign(samples, 0);
    level.emission.assign(samples, 0);
    bool emits = false;
    forEachIn(level.brickCounts, [&](glm::ivec3 brick) {
      const IndirectionCell cell{level.indirection[level.cellIndex(brick)]};
      if (cell.isEmpty()) return;
      forEachIn(glm::ivec3(kBrickSamples), [&](glm::ivec3 sample) {
        const SurfaceAttributes a =
            attributes(samplePointObject(field.originObject, level.voxelSizeObject, brick, sample));
        const std::size_t i = std::size_t{cell.brickIndex()} * kBrickSampleCount + sampleIndex(sample);
        level.baseColor[i] = packRgba8(glm::vec4(srgbFromLinear(glm::vec3(a.baseColor)), a.baseColor.w));
        level.material[i] = packRgba8({a.metallic, a.roughness, a.occlusion, a.unlit ? 1.0f : 0.0f});
        level.emission[i] = packRgb9e5(a.emission);
        emits |= a.emission != glm::vec3(0);
      });
    });
    if (!emits) level.emission = {};
  }
}

} // namespace brickfield
