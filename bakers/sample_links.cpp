// Eight samples of a row against the eight beside them; floods take a slice of 64 samples at once.
#include "bakers/sample_links.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "bakers/float4.h"
#include "bakers/simd_level.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors of 32 bytes are passed within this file alone, and inlined

namespace brickfield {

namespace {

constexpr float kSegmentSlackVoxels = 1e-4f; // over the rounding of distances to float

/// Samples from whose place a step along an axis stays in the brick: a slice's, by columns or rows.
constexpr std::uint64_t columnsFor(int x) { return 0x0101010101010101u * (x > 0 ? 0x7fu : x < 0 ? 0xfeu : 0xffu); }
constexpr std::uint64_t rowsFor(int y) {
  return y > 0 ? ~std::uint64_t{0} >> 8 : y < 0 ? ~std::uint64_t{0} << 8 : ~std::uint64_t{0};
}

/// A step to a neighbour as masks are made by it.
struct LinkStep {
  int places;            ///< that it leads on
  float reach;           ///< over its length by the slack
  std::size_t slices;    ///< from which it stays in the brick
  std::uint64_t inBrick; ///< samples of a slice from which it does
};

#define BRICKFIELD_SIMD_FILE "bakers/sample_links.inl"
#include "bakers/each_simd.inl"

/// Calls visit(number) with 0 to count - 1 as types.
template <std::size_t... kNumbers, typename Visit>
void forEachNumber(std::index_sequence<kNumbers...>, const Visit& visit) {
  (visit(std::integral_constant<std::size_t, kNumbers>{}), ...);
}

} // namespace

SampleMask samplesOffSurface(const float* distances) {
  SampleMask mask;
  BRICKFIELD_BEST_SIMD(markPositive(distances, mask));
  return mask;
}

bool areAllLinked(const float* distances) {
  const float least = leastOf(distances, kBrickSampleCount, [](Float4 v) { return v; });
  return 2.0f * least > 1.0f + kSegmentSlackVoxels; // along the axes, over which all are reached
}

std::size_t deepestOf(const SampleMask& samples, const float* distances) {
  auto deepest = static_cast<std::size_t>(kBrickSampleCount);
  forEachSample(samples, [&](std::size_t i) {
    if (deepest == kBrickSampleCount || distances[i] > distances[deepest]) deepest = i;
  });
  return deepest;
}

SampleLinks::SampleLinks(const float* distances) {
  constexpr std::size_t kPad = 1 + kBrickSamples; // a step within the slice leads so far beside it at most
  std::array<float, kBrickSampleCount + 2 * kPad> padded{};
  std::copy_n(distances, kBrickSampleCount, padded.begin() + kPad);
  std::array<LinkStep, kLaterNeighbours.size()> steps;
  std::transform(kLaterNeighbours.begin(), kLaterNeighbours.end(), steps.begin(), [](const Step& step) {
    return LinkStep{step.x + kBrickSamples * step.y + 64 * step.z, step.length + kSegmentSlackVoxels,
                    static_cast<std::size_t>(kBrickSamples - step.z), columnsFor(step.x) & rowsFor(step.y)};
  });
  BRICKFIELD_BEST_SIMD(markAllLinks(&padded[kPad], steps, links_.data()));
}

/// Samples moved by a step.
template <std::size_t kStep>
std::uint64_t SampleLinks::ahead(std::uint64_t bits) {
  constexpr int kBy = kLaterNeighbours[kStep].x + kBrickSamples * kLaterNeighbours[kStep].y;
  if constexpr (kBy >= 0)
    return bits << kBy;
  else
    return bits >> -kBy;
}
template <std::size_t kStep>
std::uint64_t SampleLinks::behind(std::uint64_t bits) {
  constexpr int kBy = kLaterNeighbours[kStep].x + kBrickSamples * kLaterNeighbours[kStep].y;
  if constexpr (kBy >= 0)
    return bits >> kBy;
  else
    return bits << -kBy;
}

std::uint64_t SampleLinks::grownWithin(std::size_t z, std::uint64_t front) const {
  std::uint64_t grown = 0;
  forEachNumber(std::make_index_sequence<kStepsWithinSlice>{}, [&](auto step) {
    grown |= ahead<step>(front & links_[step][z]) | (behind<step>(front) & links_[step][z]);
  });
  return grown;
}

std::uint64_t SampleLinks::grownUp(std::size_t z, std::uint64_t bits) const {
  std::uint64_t grown = 0;
  forEachNumber(std::make_index_sequence<kLaterNeighbours.size() - kStepsWithinSlice>{}, [&](auto number) {
    constexpr std::size_t kStep = kStepsWithinSlice + number;
    grown |= ahead<kStep>(bits & links_[kStep][z]);
  });
  return grown;
}

std::uint64_t SampleLinks::grownDown(std::size_t z, std::uint64_t bits) const {
  std::uint64_t grown = 0;
  forEachNumber(std::make_index_sequence<kLaterNeighbours.size() - kStepsWithinSlice>{}, [&](auto number) {
    constexpr std::size_t kStep = kStepsWithinSlice + number;
    grown |= behind<kStep>(bits) & links_[kStep][z - 1];
  });
  return grown;
}

SampleMask SampleLinks::flood(std::size_t from, SampleMask& left) const {
  SampleMask reached{}, added{};
  unsigned pending = 0; // slices with what was added and has not spread
  const auto add = [&](std::size_t z, std::uint64_t bits) {
    bits &= left[z];
    if (bits == 0) return;
    left[z] &= ~bits, added[z] |= bits;
    pending |= 1u << z;
  };
  add(from / 64, std::uint64_t{1} << (from % 64));
  while (pending != 0) {
    const auto z = static_cast<std::size_t>(std::countr_zero(pending));
    pending &= pending - 1;
    std::uint64_t all = std::exchange(added[z], 0);
    for (std::uint64_t front = all; front != 0; all |= front) {
      front = grownWithin(z, front) & left[z];
      left[z] &= ~front;
    }
    reached[z] |= all;
    if (z + 1 < added.size()) add(z + 1, grownUp(z, all));
    if (z > 0) add(z - 1, grownDown(z, all));
  }
  return reached;
}

} // namespace brickfield
