// The measure finds nothing in a good bake, and what was put into a bad one.
#include "bakers/bake_error.h"

#include <gtest/gtest.h>

#include "field/brick_layout.h"
#include "tests/bake/bakers/mesh_cases.h"

namespace brickfield {
namespace {

using namespace test;

constexpr std::uint64_t kSamples = 50000;

BakeSettings settingsOf(int resolution, int bits) {
  BakeSettings settings;
  settings.resolution = resolution, settings.bits = bits;
  settings.attributes = false;
  return settings;
}

MeshCase ball() {
  MeshCase sphere;
  sphere.addSphere({0, 0, 0}, 1, 24, 48);
  return sphere;
}

TEST(BakeError, GoodBakeIsOffByItsCodeAndNoSign) {
  const MeshCase sphere = ball();
  for (const int bits : {8, 16}) {
    const BakeError error =
        measureBakeError(bakeField(sphere.input(), settingsOf(64, bits)).field, sphere.input(), kSamples);
    EXPECT_EQ(error.openEdges, 0u);
    EXPECT_EQ(error.closedTriangles, error.triangles);
    ASSERT_EQ(error.levels.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const LevelError& level = error.levels[i];
      // Half a code, for small negative distances a whole one; the coarsest has 16 bits over up to 16 voxels.
      const double code = bits == 16 || i == 2 ? 16.0 / 32767 : 4.0 / 127;
      EXPECT_LE(level.max, code + 1e-5) << bits << " bits, level " << i;
      EXPECT_GT(level.rms, 0.0);
      EXPECT_LE(level.rms, level.p999);
      EXPECT_LE(level.p999, level.max);
      EXPECT_EQ(level.wrongSigns, 0u);
      EXPECT_GT(level.samples, 500u);
      EXPECT_GE(level.signedSamples, level.samples);
      EXPECT_EQ(level.openSamples, 0u);
    }
  }
}

TEST(BakeError, FindsWhatWasSpoiled) {
  const MeshCase sphere = ball();
  BrickField field = bakeField(sphere.input(), settingsOf(64, 8)).field;
  BrickLevel& level = field.levels[0];
  for (std::size_t i = 0; i < level.distances.size(); i += 100) // one of a hundred samples says 2 voxels outside
    level.distances[i] = static_cast<std::byte>(encodeDistance(2, 4, DistanceFormat::R8Snorm));
  const LevelError error = measureBakeError(field, sphere.input(), level.distances.size()).levels[0];
  EXPECT_EQ(error.signedSamples, level.distances.size());
  EXPECT_GT(error.max, 6) << "2 instead of -4 and less";
  EXPECT_GT(error.p999, 1);
  const double wrongShare = static_cast<double>(error.wrongSigns) / static_cast<double>(error.signedSamples);
  EXPECT_NEAR(wrongShare, 0.005, 0.001) << "half of the samples are inside";
  EXPECT_GT(error.farthestWrongSign, 4);
}

TEST(BakeError, OpenPartsAreKeptApart) {
  MeshCase both = ball();
  both.addQuad({3, -1, -1}, {3, 1, -1}, {3, 1, 1}, {3, -1, 1});
  const BakeError error = measureBakeError(bakeField(both.input(), settingsOf(96, 8)).field, both.input(), kSamples);
  EXPECT_EQ(error.openEdges, 4u);
  EXPECT_EQ(error.triangles, error.closedTriangles + 2);
  EXPECT_LE(error.levels[0].max, 4.0 / 127 + 1e-5);
  EXPECT_EQ(error.levels[0].wrongSigns, 0u);
  EXPECT_GT(error.levels[0].openSamples, 100u);
  EXPECT_LE(error.levels[0].openMax, 1.8) << "a slab is at most 1.755 voxels deep";
}

} // namespace
} // namespace brickfield
