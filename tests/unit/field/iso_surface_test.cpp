// Closed manifolds from any field, and sphere, torus and box against their closed forms.
#include "field/iso_surface.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/manifold_check.h"
#include "tests/unit/field/analytic_cases.h"

namespace brickfield {
namespace {

using namespace test;

void expectClosed(const IsoSurface& surface, const std::string& what) {
  ASSERT_FALSE(surface.indices.empty()) << what;
  ASSERT_EQ(surface.normals.size(), surface.positions.size());
  const ManifoldCheck check = checkManifold(weldedIndices(surface.positions, surface.indices));
  EXPECT_EQ(check.wrongEdges, 0u) << what;
  EXPECT_EQ(check.wrongVertices, 0u) << what;
  EXPECT_EQ(check.flatTriangles, 0u) << what;
  EXPECT_EQ(check.vertices, surface.positions.size()) << what << ": vertices fell together or are unused";
}

TEST(IsoSurface, BodiesAreWhereTheyAreOnEveryLevel) {
  for (const Body& body : bodies())
    for (const int bits : {8, 16}) {
      const BrickField field = fieldOf(body, 64, bits, 3);
      for (std::size_t level = 0; level < field.levels.size(); ++level) {
        const std::string what = body.name + " level " + std::to_string(level);
        const IsoSurface surface = extractIsoSurface(field, level, 0);
        expectClosed(surface, what);
        const BrickLevel& bricks = field.levels[level];
        const float h = bricks.voxelSizeObject;
        for (std::size_t i = 0; i < surface.positions.size(); ++i) {
          const glm::vec3 point = surface.positions[i];
          // On the trilinear field but for 1/256 voxel beside grid points; that is off by its own error and the code.
          const float bound =
              trilinearErrorVoxels(body, point, h) + codeVoxels(bricks) + 1.0f / 256 + floatErrorVoxels(h) + 1e-3f;
          ASSERT_LE(std::abs(body.distance(point)), bound * h) << what;
          ASSERT_NEAR(glm::length(surface.normals[i]), 1.0f, 1e-5f);
        }
      }
    }
}

TEST(IsoSurface, SphereAndTorusHaveTheirTopologyVolumeAndArea) {
  constexpr double kPi = std::numbers::pi;
  struct Expected {
    Body body;
    std::ptrdiff_t euler;
    double volume, area;
    glm::dvec3 inside;
  };
  const double r = kRadius, ring = kRing, tube = kTube;
  const Expected cases[] = {
      {sphereBody(), 2, 4.0 / 3.0 * kPi * r * r * r, 4 * kPi * r * r, glm::dvec3(kCenter)},
      {torusBody(), 0, 2 * kPi * kPi * ring * tube * tube, 4 * kPi * kPi * ring * tube,
       glm::dvec3(kCenter) + glm::dvec3(ring, 0, 0)},
  };
  for (const Expected& expected : cases) {
    const IsoSurface surface = extractIsoSurface(fieldOf(expected.body, 96, 16, 1), 0, 0);
    const ManifoldCheck check = checkManifold(surface.indices);
    EXPECT_EQ(check.eulerCharacteristic(), expected.euler);
    EXPECT_EQ(check.components, 1u);
    // Chords of curvature k over edges up to sqrt(3) h lie k (sqrt(3) h)^2 / 8 inside, the field itself as much again;
    // 0.4 % of the torus' tube is that with k = 1 / 0.4 m and h = 2.8 m / 96.
    EXPECT_NEAR(enclosedVolume(surface.positions, surface.indices), expected.volume, 0.004 * expected.volume);
    EXPECT_NEAR(surfaceArea(surface.positions, surface.indices), expected.area, 0.004 * expected.area);
    EXPECT_NEAR(windingNumberAt(surface.positions, surface.indices, expected.inside), 1.0, 1e-5);
    EXPECT_NEAR(windingNumberAt(surface.positions, surface.indices, glm::dvec3(kCenter) + glm::dvec3(0, 1.2, 0)), 0.0,
                1e-5);
  }
}

TEST(IsoSurface, NormalsPointOutwardsAsTheTrianglesDo) {
  const IsoSurface surface = extractIsoSurface(fieldOf(torusBody(), 64, 16, 1), 0, 0);
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const std::uint32_t a = surface.indices[i], b = surface.indices[i + 1], c = surface.indices[i + 2];
    const glm::vec3 front =
        glm::cross(surface.positions[b] - surface.positions[a], surface.positions[c] - surface.positions[a]);
    ASSERT_GE(glm::dot(front, surface.normals[a] + surface.normals[b] + surface.normals[c]), 0.0f);
  }
  for (std::size_t i = 0; i < surface.positions.size(); ++i) {
    const glm::vec3 from = surface.positions[i] - kCenter;
    const glm::vec3 onRing = kRing * glm::normalize(glm::vec3(from.x, 0, from.z));
    // Central differences over a voxel h turn by no more than k h; k h = 0.11 here, and the samples' codes are 16 bits.
    ASSERT_GT(glm::dot(surface.normals[i], glm::normalize(from - onRing)), 0.99f);
  }
}

TEST(IsoSurface, IsMovedByTheDistanceAskedFor) {
  const BrickField field = fieldOf(sphereBody(), 64, 16, 2);
  const float h = field.levels[0].voxelSizeObject;
  for (const double voxels : {-0.9, -0.4, 0.5, 0.9}) {
    const IsoSurface surface = extractIsoSurface(field, 0, voxels * h);
    expectClosed(surface, std::to_string(voxels));
    for (const glm::vec3 point : surface.positions)
      ASSERT_NEAR((glm::length(point - kCenter) - kRadius) / h, voxels, 0.05);
  }
}

/// A field of one level whose bricks and cells contradict each other in every way, all the grid's border included.
BrickField nonsenseField(std::uint32_t seed, float storedShare, float insideShare) {
  Random random(seed);
  BrickField field = makeAnalyticField([](glm::vec3) { return 1.0f; }, {glm::vec3(0), glm::vec3(1)}, 24, 8, 1);
  BrickLevel& level = field.levels[0];
  std::uint32_t stored = 0;
  for (std::uint32_t& cell : level.indirection)
    cell = random.unit() < storedShare ? IndirectionCell::brick(stored++).bits
                                       : IndirectionCell::empty(random.unit() < insideShare, random.between(0, 3)).bits;
  level.distances.resize(std::size_t{stored} * kBrickSampleCount);
  for (std::byte& code : level.distances)
    code = static_cast<std::byte>(static_cast<std::int8_t>(random.unit() < insideShare
                                                               ? -1 - static_cast<int>(random.unit() * 126)
                                                               : static_cast<int>(random.unit() * 127)));
  return field;
}

TEST(IsoSurface, NonsenseIsAClosedManifoldToo) {
  // Not what validateField passes as a whole, where the coarsest level has every brick; but a finer level may be so.
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    const float storedShare = seed % 3 == 0 ? 1.0f : seed % 3 == 1 ? 0.5f : 0.1f;
    const BrickField field = nonsenseField(seed, storedShare, seed % 2 ? 0.5f : 0.05f);
    expectClosed(extractIsoSurface(field, 0, 0), "seed " + std::to_string(seed));
    expectClosed(extractIsoSurface(field, 0, 0.3 * field.levels[0].voxelSizeObject),
                 "iso, seed " + std::to_string(seed));
  }
}

TEST(IsoSurface, ZerosAtGridPointsMakeNoPointOfSeveralVertices) {
  // Faces of the box run through grid points: every sample there is exactly 0.
  const BrickField field = makeAnalyticField([](glm::vec3 p) { return boxDistance(p, glm::vec3(0), glm::vec3(0.5f)); },
                                             {glm::vec3(-0.5f), glm::vec3(0.5f)}, 32, 16, 1);
  int zeros = 0;
  for (int i = 0; i < kBrickSampleCount; ++i)
    for (std::uint32_t brick = 0; brick < field.levels[0].brickCount(); ++brick)
      zeros += storedDistance(field.levels[0], brick, {i & 7, i >> 3 & 7, i >> 6}) == 0;
  EXPECT_GT(zeros, 1000);
  expectClosed(extractIsoSurface(field, 0, 0), "box");
}

TEST(IsoSurface, HiddenSurfaceIsNone) {
  // A box in a box: samples on the inner one are 0, all around them negative.
  const auto distance = [](glm::vec3 p) {
    const float outer = boxDistance(p, glm::vec3(0), glm::vec3(0.5f)),
                inner = boxDistance(p, glm::vec3(0), glm::vec3(0.25f));
    return outer >= 0 ? outer : -std::min(-outer, std::abs(inner));
  };
  const BrickField field = makeAnalyticField(distance, {glm::vec3(-0.5f), glm::vec3(0.5f)}, 32, 16, 1);
  EXPECT_GE(sampleDistance(field, 0, {0.25f, 0, 0}), 0.0f);
  const ManifoldCheck check = checkManifold(extractIsoSurface(field, 0, 0).indices);
  EXPECT_TRUE(check.isClosedManifold());
  EXPECT_EQ(check.components, 1u);
}

TEST(IsoSurface, SurfaceCutOffByTheGridIsClosedThere) {
  // The sphere reaches through the box that was given for it.
  const BrickField field = makeAnalyticField([](glm::vec3 p) { return sphereDistance(p, glm::vec3(0), 0.5f); },
                                             {glm::vec3(-0.3f), glm::vec3(0.6f)}, 32, 8, 2);
  for (std::size_t level = 0; level < 2; ++level) {
    const IsoSurface surface = extractIsoSurface(field, level, 0);
    expectClosed(surface, "cut");
    EXPECT_EQ(checkManifold(surface.indices).eulerCharacteristic(), 2);
  }
}

TEST(IsoSurface, FieldWithoutInsideHasNone) {
  const BrickField field = makeAnalyticField([](glm::vec3) { return 0.5f; }, {glm::vec3(0), glm::vec3(1)}, 16, 8, 1);
  EXPECT_TRUE(extractIsoSurface(field, 0, 0).positions.empty());
}

TEST(IsoSurface, RefusesWhatIsNotThere) {
  const BrickField field = fieldOf(sphereBody(), 20, 8, 1);
  const double h = field.levels[0].voxelSizeObject;
  EXPECT_THROW(extractIsoSurface(field, 1, 0), BadInput);
  EXPECT_THROW(extractIsoSurface(field, 0, 0.95 * h), BadInput);
  EXPECT_THROW(extractIsoSurface(field, 0, -0.95 * h), BadInput);
  EXPECT_THROW(extractIsoSurface(field, 0, std::nan("")), BadInput);
}

TEST(IsoSurface, CanBeCancelled) {
  const BrickField field = fieldOf(sphereBody(), 20, 8, 1);
  const std::atomic<bool> cancelled{true};
  EXPECT_THROW(extractIsoSurface(field, 0, 0, {{}, &cancelled}), Cancelled);
}

} // namespace
} // namespace brickfield
