// Rims at the samples of bricks against the exact winding number, and what cuts links.
#include "bakers/rim_turns.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "bakers/inside_test.h"
#include "bakers/level_sampler.h"
#include "bakers/simd_level.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

constexpr std::size_t kSamples = kBrickSampleCount;

/// Tubes that stand apart, open at one end or both, each askew in another way.
MeshCase tubes() {
  MeshCase tubes;
  for (int i = 0; i < 27; ++i) {
    const glm::vec3 from = 0.5f * glm::vec3(i % 3, i / 3 % 3, i / 9);
    const glm::vec3 axis = glm::normalize(glm::vec3(i % 5 - 2, i % 7 - 3, i % 4 - 1.5f));
    const glm::vec3 x = glm::normalize(glm::cross(axis, glm::vec3(0.3f, 0.9f, -0.2f))), y = glm::cross(axis, x);
    const auto corner = [&](int k, float along) {
      const float angle = 6.2831853f * static_cast<float>(k % 6) / 6;
      return from + 0.12f * (std::cos(angle) * x + std::sin(angle) * y) + along * axis;
    };
    for (int k = 0; k < 6; ++k) {
      tubes.addQuad(corner(k, 0), corner(k + 1, 0), corner(k + 1, 0.3f), corner(k, 0.3f));
      if (i % 2) tubes.addTriangle(corner(k + 1, 0), corner(k, 0), from);
    }
  }
  return tubes;
}

/// A soup's winding number, exact distances and bricks of it.
struct Tubes {
  MeshCase mesh = tubes();
  TriangleSoup soup = gatherTriangles(mesh.input());
  MeshHierarchy hierarchy{soup, allTriangles(soup)};
  MeshDistance distance{hierarchy};
  OpenWinding winding{soup, allTriangles(soup)};

  /// Bricks of such voxels, all about places on the triangles.
  template <typename Visit>
  void forEachBrick(double voxel, const Visit& visit) const {
    for (std::uint32_t t = 0; t < soup.triangles.size(); t += 5) {
      const auto corners = soup.corners(t);
      const SampleGrid grid{corners[t % 3] - voxel * glm::dvec3(2.3, 3.9, 4.6), voxel, glm::ivec3(1)};
      visit(grid);
    }
  }
};

} // namespace

TEST(RimTurns, AreOffByAWholeNumber) {
  const Tubes tubes;
  std::size_t known = 0, all = 0, sharp = 0;
  for (const double voxel : {0.01, 0.03, 0.1})
    tubes.forEachBrick(voxel, [&](const SampleGrid& grid) {
      const RimTurns rims(tubes.winding.rims(), grid.origin, grid.voxelSize);
      if (!rims.areMeasured()) return;
      for (std::size_t i = 0; i < kSamples; i += 7) {
        const NearlyTurns turns = rims.at(i);
        const double off = turns.turns - tubes.winding.exactlyAt(grid.sample(glm::ivec3(0), sampleOfIndex(i)));
        ++all;
        known += isIn(rims.known(), i), sharp += turns.slack < 0.1;
        EXPECT_LE(std::abs(off - std::round(off)), turns.slack + 1e-9);
      }
    });
  EXPECT_GT(all, 10'000u);
  EXPECT_GT(known, all * 9 / 10);
  EXPECT_GT(sharp, all * 8 / 10);
}

TEST(RimTurns, AreOffByTheSameNumberAlongLinksThatNothingCuts) {
  const Tubes tubes;
  std::size_t bricks = 0, together = 0, cut = 0;
  for (const double voxel : {0.01, 0.03, 0.1})
    tubes.forEachBrick(voxel, [&](const SampleGrid& grid) {
      const RimTurns rims(tubes.winding.rims(), grid.origin, grid.voxelSize);
      if (!rims.areMeasured()) return;
      ++bricks;
      std::array<float, kSamples> distances;
      for (std::size_t i = 0; i < kSamples; ++i)
        distances[i] =
            static_cast<float>(tubes.distance.nearest(grid.sample(glm::ivec3(0), sampleOfIndex(i))).distance / voxel);
      SampleLinks links(distances.data());
      const SampleLinks uncut = links;
      rims.cut(links);
      const auto groupsBy = [&](const SampleLinks& by, const auto& visit) {
        SampleMask left = rims.known();
        for (std::size_t z = 0; z < left.size(); ++z)
          while (left[z] != 0) visit(by.flood(64 * z + static_cast<std::size_t>(std::countr_zero(left[z])), left));
      };
      const auto differencesIn = [&](const SampleMask& group) {
        int least = 1 << 20, most = -least;
        forEachSample(group, [&](std::size_t i) {
          const double exact = tubes.winding.exactlyAt(grid.sample(glm::ivec3(0), sampleOfIndex(i)));
          const int off = static_cast<int>(std::round(rims.at(i).turns - exact));
          least = std::min(least, off), most = std::max(most, off), ++together;
        });
        return most - least;
      };
      groupsBy(links, [&](const SampleMask& group) { EXPECT_EQ(differencesIn(group), 0); });
      groupsBy(uncut, [&](const SampleMask& group) { cut += differencesIn(group) != 0; });
    });
  EXPECT_GT(bricks, 100u);
  EXPECT_GT(together, 20'000u);
  EXPECT_GT(cut, bricks / 10); // curtains are needed
}

TEST(RimTurns, FewLinksAreCut) {
  std::array<float, kSamples> far;
  far.fill(4.0f);
  SampleLinks links(far.data());
  links.cutBelow({3.5f, -1.0f, 2.5f}, {3.5f, 9.0f, 2.5f}); // a wall across the brick, up to between slices 2 and 3
  SampleMask left = allSamplesMask();
  for (std::size_t z = 3; z < left.size(); ++z) left[z] = 0;
  const SampleMask half = links.flood(0, left);
  for (std::size_t z = 0; z < left.size(); ++z) EXPECT_EQ(half[z], z < 3 ? 0x0f0f0f0f0f0f0f0fu : 0u);
  for (std::size_t z = 0; z < 3; ++z) EXPECT_EQ(left[z], 0xf0f0f0f0f0f0f0f0u);
  left = allSamplesMask();
  EXPECT_EQ(links.flood(0, left), allSamplesMask()); // around above it
}

TEST(RimTurns, AreTheSameByAllSetsOfInstructions) {
  const Tubes tubes;
  tubes.forEachBrick(0.03, [&](const SampleGrid& grid) {
    const RimTurns rims(tubes.winding.rims(), grid.origin, grid.voxelSize);
    for (const SimdLevel level : {SimdLevel::Avx2, SimdLevel::Portable}) {
      limitSimd(level);
      const RimTurns same(tubes.winding.rims(), grid.origin, grid.voxelSize);
      limitSimd(SimdLevel::Avx512);
      if (!rims.areMeasured()) continue;
      for (std::size_t i = 0; i < kSamples; ++i) {
        EXPECT_EQ(rims.at(i).turns, same.at(i).turns);
        EXPECT_EQ(rims.at(i).slack, same.at(i).slack);
      }
    }
  });
}
