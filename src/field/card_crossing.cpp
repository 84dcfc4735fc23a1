// How high a point lies over a card is half the difference of the distances a little to either side, along the card's
// axis: |h + a| - |h - a| = 2 h. Both are linear around there, where the distance itself has a kink that the lattice
// blurs; and beyond the card's border the sign stays.
#include "field/card_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "field/brick_layout.h"
#include "field/brick_lookup.h"
#include "field/surface_attributes.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kUnlit = 128; // bytes from here on, as all readers take one half for the border
constexpr std::uint32_t kUnlitNoCard = 255;

constexpr float kSteepFacing = 0.5f;    // |cos|: at 30 degrees a slab is hardly wider than what is seen of its card
constexpr double kAsideVoxels = 1.25;   // from where a slab's faces are, 0.525, over the reach of a voxel's samples
constexpr float kFirstVoxels = 0.5f;    // in from the surface, off the slab's rim
constexpr float kApartVoxels = 2.0f;    // of the two heights that tell how steep the ray is
constexpr float kMostWayVoxels = 32.0f; // to the crossing: what is flatter is seen as a line, if at all
constexpr float kLeastSlope = 1e-3f;

/// Of the sample nearest to a point.
std::uint32_t cardByteAt(const BrickLevel& level, glm::dvec3 pointVoxels) {
  const glm::ivec3 brick = brickOfVoxel(voxelAt(level, pointVoxels));
  const IndirectionCell cell = cellAt(level, brick);
  if (level.material.empty() || cell.isEmpty()) return 0;
  const glm::ivec3 sample(glm::floor(pointVoxels - glm::dvec3(kBrickCells * brick) + 0.5));
  return level.material[std::size_t{cell.brickIndex()} * kBrickSampleCount + sampleIndex(sample)] >> 24;
}

} // namespace

glm::vec3 cardAxis(int number) {
  constexpr float kGoldenAngle = 2.39996323f;
  const float z = (static_cast<float>(number) + 0.5f) / kCardAxes, radius = std::sqrt(1.0f - z * z);
  const float angle = kGoldenAngle * static_cast<float>(number);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

int nearestCardAxis(glm::vec3 normal) {
  static const std::array<glm::vec3, kCardAxes> kAxes = [] {
    std::array<glm::vec3, kCardAxes> axes;
    for (int i = 0; i < kCardAxes; ++i) axes[static_cast<std::size_t>(i)] = cardAxis(i);
    return axes;
  }();
  const auto isFarther = [normal](glm::vec3 a, glm::vec3 b) {
    return std::abs(glm::dot(a, normal)) < std::abs(glm::dot(b, normal));
  };
  return static_cast<int>(std::max_element(kAxes.begin(), kAxes.end(), isFarther) - kAxes.begin());
}

std::uint8_t cardByte(int axisNumber, bool isUnlit) {
  return static_cast<std::uint8_t>(static_cast<std::uint32_t>(axisNumber) + (isUnlit ? kUnlit : 1));
}

bool isCovered(const BrickField& field, std::size_t level, glm::vec3 pointObject, glm::vec3 directionObject,
               bool isBack) {
  const BrickLevel& bricks = field.levels[level];
  const glm::dvec3 last(kBrickCells * bricks.brickCounts);
  const auto voxelsOf = [&](glm::vec3 point) {
    return (glm::dvec3(point) - glm::dvec3(field.originObject)) / double{bricks.voxelSizeObject};
  };
  const std::uint32_t byte = cardByteAt(bricks, glm::clamp(voxelsOf(pointObject), glm::dvec3(0), last));
  const auto isCoveredAt = [&](glm::vec3 point, bool whereNone) {
    const std::optional<SurfaceAttributes> found = attributesAt(field, level, point);
    return found ? found->baseColor.w >= 0.5f : whereNone;
  };
  if (byte == 0 || byte == kUnlitNoCard) return isCoveredAt(pointObject, true);
  const glm::vec3 axis = cardAxis(static_cast<int>(byte - (byte < kUnlit ? 1 : kUnlit)));
  const glm::vec3 inwards = (isBack ? -1.0f : 1.0f) * glm::normalize(directionObject);
  if (std::abs(glm::dot(axis, inwards)) >= kSteepFacing) return isCoveredAt(pointObject, true);
  const auto heightAt = [&](float wayVoxels) {
    const glm::dvec3 at = voxelsOf(pointObject) + glm::dvec3(wayVoxels * inwards);
    return static_cast<float>(0.5 * (sampleVoxels(bricks, at + kAsideVoxels * glm::dvec3(axis)) -
                                     sampleVoxels(bricks, at - kAsideVoxels * glm::dvec3(axis))));
  };
  const float first = heightAt(kFirstVoxels);
  float slope = (heightAt(kFirstVoxels + kApartVoxels) - first) / kApartVoxels;
  if (std::abs(slope) < kLeastSlope) slope = kLeastSlope;
  const float way = -first / slope;
  return std::abs(way) <= kMostWayVoxels &&
         isCoveredAt(pointObject + (kFirstVoxels + way) * bricks.voxelSizeObject * inwards, false);
}

} // namespace brickfield
