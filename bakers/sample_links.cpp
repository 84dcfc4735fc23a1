// Eight samples of a row against the eight beside them; floods take a slice of 64 samples at once.
#include "bakers/sample_links.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "bakers/float4.h"

namespace brickfield {

namespace {

constexpr float kSegmentSlackVoxels = 1e-4f; // over the rounding of distances to float
constexpr int kLastRow = kBrickSamples - 1;

/// Samples from whose place a step along an axis stays in the brick: a slice's, by columns or rows.
constexpr std::uint64_t columnsFor(int x) { return 0x0101010101010101u * (x > 0 ? 0x7fu : x < 0 ? 0xfeu : 0xffu); }
constexpr std::uint64_t rowsFor(int y) {
  return y > 0 ? ~std::uint64_t{0} >> 8 : y < 0 ? ~std::uint64_t{0} << 8 : ~std::uint64_t{0};
}

/// Calls visit(number) with 0 to count - 1 as types.
template <std::size_t... kNumbers, typename Visit>
void forEachNumber(std::index_sequence<kNumbers...>, const Visit& visit) {
  (visit(std::integral_constant<std::size_t, kNumbers>{}), ...);
}

} // namespace

SampleMask samplesOffSurface(const float* distances) {
  SampleMask mask;
  for (std::size_t z = 0; z < mask.size(); ++z) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 64; ++i) bits |= std::uint64_t{distances[64 * z + i] > 0} << i;
    mask[z] = bits;
  }
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
  for (std::size_t s = 0; s < kLaterNeighbours.size(); ++s) {
    const Step& step = kLaterNeighbours[s];
    const Float4 reach = broadcast(step.length + kSegmentSlackVoxels);
    const std::uint64_t inBrick = columnsFor(step.x) & rowsFor(step.y);
    const auto lastSlice = static_cast<std::size_t>(kLastRow - step.z);
    for (std::size_t z = 0; z < kBrickSamples; ++z) {
      std::uint64_t bits = 0;
      if (z <= lastSlice) {
        const float* here = &padded[kPad + 64 * z];
        const float* there = here + step.x + kBrickSamples * step.y + 64 * step.z;
        for (std::size_t quarter = 0; quarter < 16; ++quarter) {
          Float4 a, b;
          std::memcpy(&a, here + 4 * quarter, sizeof(a));
          std::memcpy(&b, there + 4 * quarter, sizeof(b));
          bits |= std::uint64_t{bitsOf(a + b > reach)} << (4 * quarter);
        }
      }
      links_[s][z] = bits & inBrick;
    }
  }
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
