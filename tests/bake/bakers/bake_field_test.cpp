// Whole bakes of solids: distances against closed forms and brute force, signs, bounds, determinism, what is refused.
#include "bakers/bake.h"

#include <gtest/gtest.h>

#include "bakers/mesh_distance.h"
#include "core/error.h"
#include "field/brick_layout.h"
#include "field/bricks_file.h"
#include "tests/bake/bakers/mesh_cases.h"

using namespace brickfield;
using namespace brickfield::test;

namespace {

BakeSettings settingsOf(int resolution, int bits = 16) {
  BakeSettings settings;
  settings.resolution = resolution;
  settings.bits = bits;
  settings.attributes = false;
  return settings;
}

/// Calls `visit` with the object-space point and stored distance (metres) of every sample of a level.
template <typename Visit>
void forEachSample(const BrickField& field, const BrickLevel& level, Visit visit) {
  for (std::size_t cell = 0; cell < level.indirection.size(); ++cell) {
    const IndirectionCell content{level.indirection[cell]};
    if (content.isEmpty()) continue;
    const auto x = static_cast<std::size_t>(level.brickCounts.x), y = static_cast<std::size_t>(level.brickCounts.y);
    const glm::ivec3 brick(cell % x, cell / x % y, cell / (x * y));
    for (int i = 0; i < kBrickSampleCount; ++i) {
      const glm::ivec3 sample(i % 8, i / 8 % 8, i / 64);
      const glm::dvec3 point = glm::dvec3(field.originObject) +
                               static_cast<double>(level.voxelSizeObject) * glm::dvec3(kBrickCells * brick + sample);
      visit(point, static_cast<double>(storedDistance(level, content.brickIndex(), sample)));
    }
  }
}

/// Half a step of the code, and float rounding of the decoded value.
double quantumVoxels(const BrickLevel& level) {
  return level.rangeVoxels / (level.format == DistanceFormat::R8Snorm ? 127.0 : 32767.0) * 0.5 + 1e-5 +
         1e-6 * static_cast<double>(level.rangeVoxels);
}

/// Compares every sample of every level with a signed distance in metres.
template <typename Distance>
void expectField(const BrickField& field, Distance distance, double toleranceVoxels = 0) {
  for (const BrickLevel& level : field.levels) {
    double worst = 0;
    forEachSample(field, level, [&](glm::dvec3 point, double stored) {
      const double range = level.rangeVoxels;
      const double truth = std::clamp<double>(distance(point) / level.voxelSizeObject, -range, range);
      // A negative distance never becomes 0, so it may be a whole step off instead of half of one; on the surface
      // itself either sign is right.
      const double lost = std::abs(truth) < 2 * quantumVoxels(level) ? quantumVoxels(level) : 0;
      worst = std::max(worst, std::abs(stored - truth) - lost);
    });
    EXPECT_LE(worst, quantumVoxels(level) + toleranceVoxels) << "voxel " << level.voxelSizeObject;
  }
}

double boxDistance(glm::dvec3 p, glm::dvec3 halfExtent) {
  const glm::dvec3 q = glm::abs(p) - halfExtent;
  return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

} // namespace

TEST(BakeField, BoxHasItsExactDistancesEverywhere) {
  MeshCase box;
  box.addBox({-1, -0.5, -0.25}, {1, 0.5, 0.25});
  for (const int bits : {8, 16}) {
    const BakeResult result = bakeField(box.input(), settingsOf(64, bits));
    EXPECT_EQ(validateField(result.field), "");
    EXPECT_EQ(result.field.levels.size(), 3u);
    expectField(result.field, [](glm::dvec3 p) { return boxDistance(p, {1, 0.5, 0.25}); });
  }
}

TEST(BakeField, BoundsAreTheMeshAndAVoxel) {
  MeshCase box;
  box.addBox({-1, -0.5, -0.25}, {1, 0.5, 0.25});
  const BrickField field = bakeField(box.input(), settingsOf(64)).field;
  const float voxel = 2.0f / 64;
  EXPECT_NEAR(glm::length(field.boundsObject.min - glm::vec3(-1 - voxel, -0.5f - voxel, -0.25f - voxel)), 0, 1e-6);
  EXPECT_NEAR(glm::length(field.boundsObject.max - glm::vec3(1 + voxel, 0.5f + voxel, 0.25f + voxel)), 0, 1e-6);
  EXPECT_FLOAT_EQ(field.levels[0].voxelSizeObject, voxel);
}

TEST(BakeField, SphereIsTheSphereLessItsFacets) {
  MeshCase sphere;
  sphere.addSphere({0, 0, 0}, 1, 128, 256);
  const BrickField field = bakeField(sphere.input(), settingsOf(64)).field;
  // The polyhedron lies inside the sphere by at most the sagitta of its facets, with corners pi/128 apart: r (1 - cos
  // of half a facet's diagonal).
  const double sagitta = 1 - std::cos(std::numbers::pi / 128 * std::numbers::sqrt2 / 2);
  expectField(
      field, [](glm::dvec3 p) { return glm::length(p) - 1; }, sagitta / (2.0 / 64));
}

TEST(BakeField, RealMeshesAgreeWithBruteForceInDistanceAndSign) {
  for (const char* name : {"torus_5k.glb", "stanford_dragon_11k.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    SCOPED_TRACE(name);
    const FileCase file(name);
    BakeSettings settings = settingsOf(48);
    settings.sign = SignMethod::Winding; // no sheets: the dragon has flat folds that Auto thickens
    const BakeResult result = bakeField(file.input(), settings);
    const TriangleSoup soup = gatherTriangles(file.input());
    const BrickLevel& level = result.field.levels[0];
    std::uint32_t number = 0;
    forEachSample(result.field, level, [&](glm::dvec3 point, double stored) {
      if (++number % 499 != 0) return; // brute force is slow: a few hundred samples
      const glm::dvec3 p = soup.soupFromObject(point);
      const double unsignedVoxels = bruteDistance(soup, p) / soup.unitsPerMetre / level.voxelSizeObject;
      EXPECT_NEAR(std::abs(stored), std::min(4.0, unsignedVoxels), 2 * quantumVoxels(level));
      if (unsignedVoxels > 1e-4) {
        EXPECT_EQ(stored < 0, std::abs(bruteWinding(soup, p)) >= 0.5) << unsignedVoxels;
      }
    });
    EXPECT_GT(number, 40000u);
  }
}

namespace {

/// Compares the bound of every empty cell with the least distance that is found from it to the surface.
void expectSafeBounds(const BakeInput& input, int resolution) {
  BakeSettings settings = settingsOf(resolution, 8);
  settings.sign = SignMethod::Winding;
  const BrickField field = bakeField(input, settings).field;
  const TriangleSoup soup = gatherTriangles(input);
  const MeshHierarchy hierarchy(soup, allTriangles(soup));
  const BrickLevel& level = field.levels[0];
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, kBrickCells);
  double tightest = 1e9;
  for (std::size_t cell = 0; cell < level.indirection.size(); ++cell) {
    const IndirectionCell content{level.indirection[cell]};
    if (!content.isEmpty()) continue;
    EXPECT_GT(content.boundVoxels(), kTouchVoxels - 0.1f); // else it ought to be stored
    const auto x = static_cast<std::size_t>(level.brickCounts.x), y = static_cast<std::size_t>(level.brickCounts.y);
    const glm::dvec3 corner = static_cast<double>(kBrickCells) * glm::dvec3(cell % x, cell / x % y, cell / (x * y));
    for (int i = 0; i < 12; ++i) {
      // From a random point of the cell to the surface and back, which leads to where the two are closest.
      glm::dvec3 inCell = corner + glm::dvec3(share(random), share(random), share(random));
      double truth = 0;
      for (int step = 0; step < 6; ++step) {
        const glm::dvec3 point = glm::dvec3(field.originObject) + static_cast<double>(level.voxelSizeObject) * inCell;
        const ClosestTriangle closest = MeshDistance(hierarchy).closest(soup.soupFromObject(point));
        truth = closest.distance / soup.unitsPerMetre / level.voxelSizeObject;
        const glm::dvec3 onSurface = closest.on.point / soup.unitsPerMetre + soup.centerObject;
        const glm::dvec3 voxels =
            (onSurface - glm::dvec3(field.originObject)) / static_cast<double>(level.voxelSizeObject);
        inCell = glm::clamp(voxels, corner, corner + static_cast<double>(kBrickCells));
      }
      ASSERT_GE(truth + 1e-6, static_cast<double>(content.boundVoxels()));
      tightest = std::min(tightest, truth - static_cast<double>(content.boundVoxels()));
    }
  }
  EXPECT_LT(tightest, 0.3); // the bound is of use
}

} // namespace

TEST(BakeField, EmptyCellsOfARealMeshAreSafeAndNeverTooFar) {
  BRICKFIELD_NEEDS_DATA("stanford_dragon_11k.glb");
  expectSafeBounds(FileCase("stanford_dragon_11k.glb").input(), 96);
}

TEST(BakeField, BrickBesideASpikeIsStored) {
  MeshCase grains; // two at the ends make voxels of 1 with sample 0 at -1; one stands beside the brick that begins at x
                   // = 27,
  grains.addBox(glm::vec3(0), glm::vec3(0.01f)); // opposite the middle of a voxel's face: no sample is near it
  grains.addBox(glm::vec3(63.99f), glm::vec3(64));
  const float distance = 0.98f;
  grains.addBox({27 - distance - 0.01f, 30.495f, 30.495f}, {27 - distance, 30.505f, 30.505f});
  const BrickField field = bakeField(grains.input(), settingsOf(64, 8)).field;
  const BrickLevel& level = field.levels[0];
  ASSERT_EQ(level.voxelSizeObject, 1.0f);
  for (const int x : {3, 4})
    EXPECT_FALSE(IndirectionCell{level.indirection[level.cellIndex({x, 4, 4})]}.isEmpty()) << x;
  EXPECT_TRUE(IndirectionCell{level.indirection[level.cellIndex({5, 4, 4})]}.isEmpty());
}

TEST(BakeField, CoarsestLevelIsCompleteAndUnclamped) {
  MeshCase box;
  box.addBox({-1, -0.1f, -0.1f}, {1, 0.1f, 0.1f});
  box.addBox({-1, 0.9f, 0.9f}, {-0.9f, 1, 1});
  const BrickLevel level = bakeField(box.input(), settingsOf(64, 8)).field.levels.back();
  EXPECT_EQ(level.format, DistanceFormat::R16Snorm);
  EXPECT_EQ(level.brickCount(), level.indirection.size());
  float largest = 0;
  for (std::uint32_t b = 0; b < level.brickCount(); ++b)
    for (int i = 0; i < kBrickSampleCount; ++i)
      largest = std::max(largest, std::abs(storedDistance(level, b, {i % 8, i / 8 % 8, i / 64})));
  EXPECT_GT(largest, 4.5f);
  EXPECT_LT(largest, level.rangeVoxels);
}

TEST(BakeField, SameBytesOnAnyNumberOfThreads) {
  for (const char* name : {"stanford_dragon_11k.glb", "utah_teapot_1k.glb", "flight_helmet.glb"}) {
    BRICKFIELD_NEEDS_DATA(name);
    const FileCase file(name);
    BakeSettings settings;
    settings.resolution = 40;
    settings.threads = 1;
    const std::vector<std::byte> one = encodeBricks(bakeField(file.input(), settings).field);
    for (const int threads : {2, 5}) {
      settings.threads = threads;
      EXPECT_TRUE(encodeBricks(bakeField(file.input(), settings).field) == one) << name << ", threads " << threads;
    }
  }
}

TEST(BakeField, FarTinyAndHugeMeshesAreLikeAnyOther) {
  MeshCase plain;
  plain.addBox({-1, -0.5, -0.25}, {1, 0.5, 0.25});
  const std::vector<std::byte> expected = bakeField(plain.input(), settingsOf(32)).field.levels[0].distances;
  for (const float scale : {std::ldexp(1.0f, -40), std::ldexp(1.0f, -6), std::ldexp(1.0f, 11), std::ldexp(1.0f, 40)}) {
    MeshCase box;
    box.addBox(scale * glm::vec3(-1, -0.5, -0.25), scale * glm::vec3(1, 0.5, 0.25));
    EXPECT_TRUE(bakeField(box.input(), settingsOf(32)).field.levels[0].distances == expected) << scale;
  }
  MeshCase far;
  const glm::vec3 offset(1024, -512, 256);
  far.addBox(offset + glm::vec3(-1, -0.5, -0.25), offset + glm::vec3(1, 0.5, 0.25));
  expectField(bakeField(far.input(), settingsOf(32)).field, [&](glm::dvec3 p) {
    return boxDistance(p - glm::dvec3(offset), {1, 0.5, 0.25});
  });
}

TEST(BakeField, DegenerateTrianglesAreDroppedAndCounted) {
  MeshCase box;
  box.addBox({-1, -1, -1}, {1, 1, 1});
  box.addTriangle({0, 0, 0}, {0, 0, 0}, {3, 0, 0});
  box.addTriangle({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
  const BakeResult result = bakeField(box.input(), settingsOf(32));
  EXPECT_EQ(result.stats.triangles, 12u);
  EXPECT_EQ(result.stats.degenerateTriangles, 2u);
  EXPECT_NEAR(result.field.boundsObject.max.x, 1 + 2.0 / 32, 1e-6);
}

TEST(BakeField, SliverOfAClosedMeshLeavesItClosed) {
  MeshCase box; // a face cut at a point of its edge: the sliver between has no area, but closes the seam
  box.addBox({-1, -1, -1}, {1, 1, 1});
  auto& indices = box.primitive().indices;
  indices.erase(indices.begin(), indices.begin() + 6); // face x = -1
  const glm::vec3 a(-1, -1, -1), b(-1, -1, 1), c(-1, 1, 1), d(-1, 1, -1), middle(-1, 0, 1);
  box.addTriangle(a, b, middle), box.addTriangle(a, middle, c), box.addTriangle(a, c, d), box.addTriangle(middle, b, c);
  const BakeResult result = bakeField(box.input(), settingsOf(32));
  EXPECT_EQ(result.stats.degenerateTriangles, 1u);
  EXPECT_EQ(result.stats.openEdges, 0u);
  EXPECT_EQ(result.stats.sheetTriangles, 0u);
}

TEST(BakeField, WhatCannotBeBakedIsRefusedByName) {
  const auto expectRefused = [](const BakeInput& input, const BakeSettings& settings, const std::string& word) {
    try {
      bakeField(input, settings);
      ADD_FAILURE() << "accepted; expected a message with " << word;
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  MeshCase empty;
  expectRefused(empty.input("node 3 \"Ghost\""), settingsOf(32), "node 3 \"Ghost\"");
  MeshCase flat;
  flat.addTriangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  expectRefused(flat.input("line"), settingsOf(32), "line");
  MeshCase infinite;
  infinite.addTriangle({0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0});
  expectRefused(infinite.input("case"), settingsOf(32), "position 2");
  MeshCase outOfRange;
  outOfRange.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  outOfRange.primitive().indices[1] = 7;
  expectRefused(outOfRange.input("case"), settingsOf(32), "index 7");
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  expectRefused(box.input(), settingsOf(4), "resolution");
  expectRefused(box.input(), settingsOf(2000), "2000");
  expectRefused(box.input(), settingsOf(32, 12), "bits");
  BakeSettings settings = settingsOf(32);
  settings.mips = 5;
  expectRefused(box.input(), settings, "mips");
  settings = settingsOf(32);
  settings.thickness = -1;
  expectRefused(box.input(), settings, "thickness");
  MeshCase far;
  far.addBox(glm::vec3(1e8f), glm::vec3(1e8f) + 64.0f);
  expectRefused(far.input("far"), settingsOf(128), "far");
}

TEST(BakeField, TooLargeALevelIsRefusedBeforeItIsMade) {
  MeshCase box;
  box.addBox(glm::vec3(-1), glm::vec3(1));
  BakeSettings settings = settingsOf(1024);
  settings.mips = 1; // every cell a brick: 148^3 of them
  try {
    bakeField(box.input("cube"), settings);
    FAIL() << "accepted";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("GiB"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("cube"), std::string::npos) << error.what();
  }
}

TEST(BakeField, CancelledBakeThrows) {
  MeshCase sphere;
  sphere.addSphere({0, 0, 0}, 1, 64, 128);
  std::atomic<bool> cancelled = false;
  std::uint64_t reports = 0;
  Progress progress;
  progress.cancelled = &cancelled;
  progress.report = [&](std::string_view stage, std::uint64_t done, std::uint64_t total) {
    EXPECT_NE(stage.find("ball"), std::string_view::npos);
    EXPECT_LE(done, total);
    if (++reports == 2) cancelled = true;
  };
  EXPECT_THROW(bakeField(sphere.input("ball"), settingsOf(64), progress), Cancelled);
  EXPECT_EQ(reports, 2u);
}

TEST(BakeField, SingleTriangleAndDuplicatesAndNestsAreBaked) {
  MeshCase triangle;
  triangle.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const BakeResult single = bakeField(triangle.input(), settingsOf(16));
  EXPECT_EQ(single.stats.sign, "two-sided");
  EXPECT_EQ(validateField(single.field), "");
  EXPECT_LT(sampleDistance(single.field, 0, {0.2f, 0.2f, 0}), 0);
  MeshCase twice;
  for (int i = 0; i < 2; ++i) twice.addBox(glm::vec3(-1), glm::vec3(1));
  expectField(bakeField(twice.input(), settingsOf(24)).field,
              [](glm::dvec3 p) { return boxDistance(p, glm::dvec3(1)); });
  MeshCase inverted;
  inverted.addBox(glm::vec3(-1), glm::vec3(1), true);
  expectField(bakeField(inverted.input(), settingsOf(24)).field,
              [](glm::dvec3 p) { return boxDistance(p, glm::dvec3(1)); });
}
