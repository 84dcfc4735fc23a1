// Rays through a half plane that is stored as a slab.
#include "field/card_crossing.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/card_slab.h"

namespace brickfield {
namespace {

using namespace test;

TEST(CardCrossing, AxesAreUnitAndNearToAllNormals) {
  std::set<int> bytes;
  for (int i = 0; i < kCardAxes; ++i) {
    ASSERT_NEAR(glm::length(cardAxis(i)), 1.0f, 1e-6f);
    ASSERT_EQ(nearestCardAxis(-3.0f * cardAxis(i)), i);
    bytes.insert(cardByte(i, false)), bytes.insert(cardByte(i, true));
    ASSERT_LT(cardByte(i, false) / 255.0f, 0.5f);
    ASSERT_GT(cardByte(i, true) / 255.0f, 0.5f);
  }
  EXPECT_EQ(bytes.size(), 2u * kCardAxes);
  EXPECT_EQ(bytes.count(0) + bytes.count(255), 0u);
  Random random(1);
  float worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 normal = random.direction();
    worst = std::max(worst, std::acos(std::abs(glm::dot(normal, cardAxis(nearestCardAxis(normal))))));
  }
  EXPECT_LT(worst, 0.19f);
}

TEST(CardCrossing, RaysAslantSeeTheCardWhereTheyCrossIt) {
  Random random(2);
  std::size_t sure = 0, wrong = 0, wrongBefore = 0;
  for (int c = 0; c < 24; ++c) {
    const CardSlab card = makeCardSlab(random, c % 2 == 1);
    for (const CardRay& ray : cardRays(card, 400, random)) {
      if (!ray.isSure) continue;
      ++sure;
      wrong += isCovered(card.field, 0, ray.met, 2.0f * ray.direction, ray.isBack) != ray.isCrossing;
      wrongBefore += ray.isKeptBefore != ray.isCrossing;
    }
  }
  std::printf("%zu rays, %zu wrong, %zu by coverage where they meet the slab\n", sure, wrong, wrongBefore);
  EXPECT_GT(sure, 5000u);
  EXPECT_GT(wrongBefore, sure / 20);
  EXPECT_EQ(wrong, 0u);
}

TEST(CardCrossing, OtherSurfacesAndSteepRaysGoByWhatTheyMeet) {
  Random random(3);
  CardSlab card = makeCardSlab(random, false);
  const auto isByMet = [&](float slope) {
    for (const CardRay& ray : cardRays(card, 200, random)) {
      const float beyond = card.beyond(ray.met);
      if (std::abs(beyond) < 0.5f * card.voxel()) continue;
      const glm::vec3 direction = slope * card.normal + std::sqrt(1 - slope * slope) * card.along;
      if (isCovered(card.field, 0, ray.met, direction, ray.isBack) != (beyond < 0)) return false;
    }
    return true;
  };
  EXPECT_TRUE(isByMet(0.75f));
  EXPECT_FALSE(isByMet(0.2f));
  for (std::uint32_t& material : card.field.levels[0].material) material &= 0xffffffu;
  EXPECT_TRUE(isByMet(0.2f));
  for (std::uint32_t& material : card.field.levels[0].material) material |= 0xff000000u;
  EXPECT_TRUE(isByMet(0.2f));
  card.field.levels[0].baseColor.clear(), card.field.levels[0].material.clear();
  EXPECT_TRUE(isCovered(card.field, 0, {0, 0, 0}, card.along, false)) << "without attributes";
}

} // namespace
} // namespace brickfield
