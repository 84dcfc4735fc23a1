// The reference's sample sets: uniform one by one, stratified together, independent of each other.
#include "bakers/reference_samples.h"

#include <array>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace brickfield::test {
namespace {

TEST(ReferenceSamples, EveryCountFillsItsRowsAndItsColumns) {
  for (const int count : {1, 2, 3, 7, 16, 37, 64, 1000}) {
    const PixelSamples samples({12, 34}, 5, count);
    std::set<int> rows;
    const int columns = static_cast<int>(std::sqrt(static_cast<double>(count)));
    std::vector<int> inColumn(static_cast<std::size_t>(columns), 0);
    for (int i = 0; i < count; ++i) {
      const glm::vec2 point = samples.point(i, SamplePurpose::Light, 3);
      ASSERT_GE(std::min(point.x, point.y), 0.0f);
      ASSERT_LT(std::max(point.x, point.y), 1.0f);
      rows.insert(static_cast<int>(point.y * static_cast<float>(count)));
      ++inColumn[static_cast<std::size_t>(point.x * static_cast<float>(columns))];
    }
    // A point on the border of a row may round to the next: at most one in a thousand here.
    EXPECT_GE(static_cast<int>(rows.size()), count - count / 1000 - (count > 500 ? 2 : 0)) << count;
    for (const int points : inColumn) EXPECT_NEAR(points, static_cast<double>(count) / columns, 1.01) << count;
  }
}

// Each point is uniform whatever its index and count: over many pixels the share in each of 4 x 4 cells is 1/16, with a
// standard deviation of sqrt(15/16² / n), n = 40000: 0.0012; five of them.
TEST(ReferenceSamples, EachPointIsUniform) {
  for (const auto& [count, index] : {std::pair(1, 0), std::pair(3, 2), std::pair(7, 0), std::pair(16, 5)}) {
    std::array<int, 16> cells{};
    for (std::uint32_t i = 0; i < 40000; ++i) {
      const glm::vec2 point = PixelSamples({i % 200, i / 200}, 1, count).point(index, SamplePurpose::Pixel);
      ++cells[static_cast<std::size_t>(point.x * 4) + 4 * static_cast<std::size_t>(point.y * 4)];
    }
    for (const int inCell : cells) EXPECT_NEAR(inCell / 40000.0, 1.0 / 16, 0.006) << count << " " << index;
  }
}

// Points of one index and two purposes: their products average to the product of the averages, 1/4, within five
// deviations of sqrt(1/9 - 1/16) / sqrt(n), n = 40000: 0.0055.
TEST(ReferenceSamples, PurposesAreIndependent) {
  for (const auto& [first, second] : {std::pair(SamplePurpose::Pixel, SamplePurpose::Light),
                                      std::pair(SamplePurpose::Occlusion, SamplePurpose::OcclusionLayer)}) {
    double xx = 0, xy = 0;
    for (std::uint32_t i = 0; i < 40000; ++i) {
      const PixelSamples samples({i % 200, i / 200}, 9, 4);
      const glm::vec2 a = samples.point(1, first), b = samples.point(1, second);
      xx += a.x * b.x, xy += a.x * b.y;
    }
    EXPECT_NEAR(xx / 40000, 0.25, 0.0055);
    EXPECT_NEAR(xy / 40000, 0.25, 0.0055);
  }
}

TEST(ReferenceSamples, SeedsAndPixelsDiffer) {
  const auto first = [](glm::uvec2 pixel, std::uint64_t seed) {
    return PixelSamples(pixel, seed, 4).point(0, SamplePurpose::Pixel);
  };
  EXPECT_EQ(first({1, 2}, 3), first({1, 2}, 3));
  EXPECT_NE(first({1, 2}, 3), first({2, 1}, 3));
  EXPECT_NE(first({1, 2}, 3), first({1, 2}, 4));
}

// Means over the square by 256 x 256 midpoints. Over a cap of height h about z, E[z] = 1 - h/2 and E[x²] follows from
// x² + y² + z² = 1 with E[z²] = 1 - h + h²/3. By the cosine E[z] = 2/3, E[z²] = 1/2.
TEST(ReferenceSamples, DirectionsHaveTheirDensities) {
  const glm::mat3 basis = basisAround(glm::normalize(glm::vec3(1, -2, -3)));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(glm::dot(basis[i], basis[j]), i == j ? 1.0f : 0.0f, 1e-6f);
  constexpr int kSide = 256;
  const auto moments = [&](const auto& direction) {
    glm::dvec3 mean(0), square(0);
    for (int i = 0; i < kSide * kSide; ++i) {
      const glm::vec2 at((static_cast<float>(i % kSide) + 0.5f) / kSide,
                         (static_cast<float>(i / kSide) + 0.5f) / kSide);
      const glm::dvec3 local(glm::transpose(basis) * direction(at));
      EXPECT_NEAR(glm::length(local), 1.0, 1e-5);
      mean += local / double{kSide * kSide};
      square += local * local / double{kSide * kSide};
    }
    return std::pair(mean, square);
  };
  for (const float height : {1e-4f, 0.3f, 1.0f, 1.9f}) {
    const auto [mean, square] = moments([&](glm::vec2 at) { return directionOfCap(basis, height, at); });
    const double meanSquare = 1.0 - height + double{height} * height / 3.0;
    EXPECT_NEAR(mean.z, 1.0 - height / 2.0, 1e-4) << height;
    EXPECT_NEAR(mean.x, 0.0, 1e-4);
    EXPECT_NEAR(square.z, meanSquare, 1e-4) << height;
    EXPECT_NEAR(square.x, 0.5 * (1.0 - meanSquare), 1e-4) << height;
  }
  const auto [mean, square] = moments([&](glm::vec2 at) { return directionByCosine(basis, at); });
  EXPECT_NEAR(mean.z, 2.0 / 3.0, 2e-4); // midpoints miss the steep root at the rim
  EXPECT_NEAR(square.z, 0.5, 1e-4);
  EXPECT_NEAR(square.x, 0.25, 1e-4);
}

} // namespace
} // namespace brickfield::test
