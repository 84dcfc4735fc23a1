// A leaf card in closed form: a half plane, stored as the slab and the coverage that a bake makes of it, and rays that
// meet the slab.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "field/card_crossing.h"
#include "field/surface_attributes.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield::test {

struct CardSlab {
  static constexpr float kHalfVoxels = 0.525f; // as bake.cpp has slabs of cards

  glm::vec3 normal, along; ///< of the card, and within it, unit; it is where along.p is below the border
  float offset, border;    ///< metres
  BrickField field;

  float voxel() const { return field.levels[0].voxelSizeObject; }
  float height(glm::vec3 p) const { return glm::dot(normal, p) - offset; }
  float beyond(glm::vec3 p) const { return glm::dot(along, p) - border; }
};

/// Over a box of about 2 m, with voxels of 2/48 m, in 16 bits.
inline CardSlab makeCardSlab(Random& random, bool isUnlit) {
  constexpr int kResolution = 48;
  CardSlab card;
  card.normal = random.direction();
  card.along = glm::normalize(glm::cross(card.normal, random.direction()));
  card.offset = random.between(-0.1f, 0.1f), card.border = random.between(-0.2f, 0.2f);
  const Box box{glm::vec3(-1), glm::vec3(1)};
  const float half = CardSlab::kHalfVoxels * 2.0f / kResolution;
  card.field = makeAnalyticField([&](glm::vec3 p) { return std::abs(card.height(p)) - half; }, box, kResolution, 16, 2);
  addAttributes(card.field, [&](glm::vec3 p) {
    SurfaceAttributes attributes;
    attributes.baseColor.w = std::clamp(0.5f - card.beyond(p) / (2.0f / kResolution), 0.0f, 1.0f);
    return attributes;
  });
  const std::uint32_t byte = cardByte(nearestCardAxis(card.normal), isUnlit);
  for (BrickLevel& level : card.field.levels)
    for (std::uint32_t& material : level.material) material = (material & 0xffffffu) | byte << 24;
  return card;
}

struct CardRay {
  glm::vec3 met, direction; ///< where it meets the slab, or comes out of it; unit
  bool isBack;
  bool isCrossing;   ///< it crosses the card itself
  bool isSure;       ///< not so near its border that heights off by 0.03 voxels could tell otherwise
  bool isKeptBefore; ///< coverage where it meets the slab is one half or more
};

/// Rays by where they cross the card's plane, up to 10 voxels from its border, 2 to 17 degrees aslant: so flat
/// that the nearest axis tells, too.
inline std::vector<CardRay> cardRays(const CardSlab& card, std::size_t count, Random& random) {
  std::vector<CardRay> rays;
  const float voxel = card.voxel();
  while (rays.size() < count) {
    const float slope = random.between(0.035f, 0.3f), beyond = random.between(-10.0f, 10.0f) * voxel;
    const glm::vec3 beside = glm::cross(card.normal, card.along);
    const glm::vec3 crossing =
        card.offset * card.normal + (card.border + beyond) * card.along + random.between(-0.3f, 0.3f) * beside;
    const glm::vec3 level =
        glm::normalize(random.between(-1.0f, 1.0f) * card.along + random.between(-1.0f, 1.0f) * beside);
    CardRay ray;
    ray.direction = std::sqrt(1 - slope * slope) * level + (random.unit() < 0.5f ? slope : -slope) * card.normal;
    ray.isBack = random.unit() < 0.5f;
    const float back = 3.0f * voxel / slope;
    const glm::vec3 inwards = ray.isBack ? -ray.direction : ray.direction;
    const glm::vec3 origin = crossing - back * inwards;
    const std::optional<float> way = traceField(card.field, 0, origin, inwards, 0, back);
    if (!way) continue;
    ray.met = origin + *way * inwards;
    if (glm::any(glm::greaterThan(glm::max(glm::abs(crossing), glm::abs(ray.met)), glm::vec3(0.9f)))) continue;
    ray.isCrossing = beyond < 0;
    ray.isSure = std::abs(beyond) > (0.25f + 0.06f / slope) * voxel;
    ray.isKeptBefore = card.beyond(ray.met) < 0;
    rays.push_back(ray);
  }
  return rays;
}

} // namespace brickfield::test
