// Bands of real meshes against brute force in double: distances, codes, signs; and the same bytes by each set of
// instructions.
#include <gtest/gtest.h>

#include "bakers/band_accuracy.h"
#include "bakers/mesh_hierarchy.h"
#include "bakers/simd_level.h"
#include "tests/bake/bakers/mesh_cases.h"

namespace brickfield::test {
namespace {

constexpr double kMostError = 1e-5;     // voxels, before coding
constexpr double kBruteWork = 2e7;      // samples times triangles
constexpr double kRoundingTurns = 1e-7; // so near one half, the brute force itself may err
constexpr double kHierarchyBytes = 95;  // a triangle, with moments

BakeSettings windingAt(int resolution, int bits) {
  BakeSettings settings;
  settings.resolution = resolution;
  settings.bits = bits;
  settings.sign = SignMethod::Winding; // no slabs, no solids drawn thicker: distances are those to triangles
  return settings;
}

std::size_t affordable(const BandBake& band) {
  return static_cast<std::size_t>(std::clamp(kBruteWork / static_cast<double>(band.stats.triangles), 100.0, 4000.0));
}

class LimitedSimd {
public:
  explicit LimitedSimd(SimdLevel most) { limitSimd(most); }
  ~LimitedSimd() { limitSimd(SimdLevel::Avx512); }
};

} // namespace

TEST(BandBake, ClosedMeshesHaveTheirDistancesAndNoWrongSign) {
  for (const char* name :
       {"torus_5k.glb", "stanford_bunny_closed.glb", "stanford_dragon_11k.glb", "stanford_dragon_100k.glb",
        "stanford_dragon_871k.glb", "blub_fish.glb", "scorpion_100k.glb", "box.glb", "fox.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    for (const auto& [resolution, bits] : {std::pair(64, 8), std::pair(200, 16)}) {
      const BandBake band = bakeBand(file.input(), windingAt(resolution, bits));
      const BandAccuracy accuracy = measureBand(band, affordable(band));
      EXPECT_GE(accuracy.samples, 100u);
      EXPECT_LE(accuracy.largestError, kMostError) << resolution;
      EXPECT_LE(accuracy.largestCodedError, accuracy.quantum + kMostError) << resolution;
      EXPECT_EQ(accuracy.wrongSigns, 0u) << resolution;
    }
  }
}

TEST(BandBake, OpenMeshesAreInsideWhereTheyWrapByHalf) {
  for (const char* name : {"utah_teapot_1k.glb", "utah_teapot_2464.glb", "utah_teapot_6k.glb", "stanford_bunny_69k.glb",
                           "plane_holes_17k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    for (const int resolution : {64, 128}) {
      const BandBake band = bakeBand(file.input(), windingAt(resolution, 8));
      EXPECT_GT(band.stats.openEdges, 0u);
      const BandAccuracy accuracy = measureBand(band, affordable(band));
      EXPECT_LE(accuracy.farthestTurns, kRoundingTurns) << accuracy.wrongSigns << " at " << resolution;
    }
  }
}

TEST(BandBake, AccuracyNoticesWhatIsWrong) {
  MeshCase box;
  box.addBox({-1, -0.5f, -0.25f}, {1, 0.5f, 0.25f});
  BandBake band = bakeBand(box.input(), windingAt(32, 8));
  for (float& distance : band.signedVoxels) distance = -distance - 0.01f;
  const BandAccuracy accuracy = measureBand(band, 2000);
  EXPECT_NEAR(accuracy.largestError, 0.01, 1e-4);
  EXPECT_GT(accuracy.wrongSigns, 1500u);
}

TEST(BandBake, SameBytesByAllSetsOfInstructions) {
  if (activeSimd() != SimdLevel::Avx512)
    std::fprintf(stderr, "NOT RUN: all of it, this processor has no %s\n",
                 activeSimd() == SimdLevel::Avx2 ? "AVX-512" : "AVX2");
  for (const char* name : {"stanford_dragon_11k.glb", "utah_teapot_1k.glb", "tree_leaf_cards.glb", "box.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const FileCase file(name);
    BakeSettings settings;
    settings.resolution = 64;
    settings.bits = 16;
    const BandBake best = bakeBand(file.input(), settings);
    for (const SimdLevel level : {SimdLevel::Portable, SimdLevel::Avx2}) {
      if (level > activeSimd()) continue;
      const LimitedSimd limited(level);
      ASSERT_EQ(activeSimd(), level);
      const BandBake other = bakeBand(file.input(), settings);
      EXPECT_TRUE(best.level.distances == other.level.distances) << name;
      EXPECT_TRUE(best.signedVoxels == other.signedVoxels) << name;
      EXPECT_TRUE(best.level.indirection == other.level.indirection) << name;
    }
  }
}

TEST(BandBake, HierarchyTakesFewBytesATriangle) {
  for (const char* name : {"stanford_bunny_closed.glb", "stanford_dragon_871k.glb", "plane_holes_17k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const BandBake band = bakeBand(FileCase(name).input(), windingAt(64, 8));
    const auto triangles = static_cast<double>(band.stats.triangles);
    EXPECT_LE(static_cast<double>(band.stats.hierarchyBytes) / triangles, kHierarchyBytes) << name;
    const MeshHierarchy hierarchy(band.soup, allTriangles(band.soup));
    std::vector<bool> isIn(band.soup.triangles.size(), false);
    for (const HierarchyLeaf& leaf : hierarchy.leaves())
      for (std::uint32_t i = 0; i < leaf.count(); ++i) {
        EXPECT_FALSE(isIn[leaf.triangles[i]]);
        isIn[leaf.triangles[i]] = true;
      }
    EXPECT_EQ(std::count(isIn.begin(), isIn.end(), true), static_cast<std::ptrdiff_t>(isIn.size())) << name;
  }
}

TEST(BandBake, RimsTakeFewBytesATriangleToo) {
  BRICKFIELD_NEEDS_DATA("tree_leaf_cards.glb");
  BakeSettings settings;
  settings.resolution = 256; // from which on the branches, tubes of a few triangles, count as solids
  const BakeStats stats = bakeBand(FileCase("tree_leaf_cards.glb").input(), settings).stats;
  ASSERT_NE(stats.sign.find("open surfaces"), std::string::npos);
  EXPECT_LE(static_cast<double>(stats.hierarchyBytes) / static_cast<double>(stats.triangles), kHierarchyBytes);
}

TEST(BandBake, StagesAddUpToTheWhole) {
  MeshCase sphere;
  sphere.addSphere({0, 0, 0}, 1, 64, 128);
  const BakeStats stats = bakeBand(sphere.input(), windingAt(64, 8)).stats;
  const BakeSeconds& s = stats.stages;
  EXPECT_GT(std::min({s.gather, s.hierarchy, s.distance, s.sign, s.packing}), 0.0);
  EXPECT_EQ(s.attributes, 0.0);
  EXPECT_LE(s.gather + s.hierarchy + s.distance + s.sign + s.packing, stats.seconds);
  EXPECT_GT(stats.queries, 343u * stats.bricks / 2);
}

} // namespace brickfield::test
