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

constexpr float kSegmentSlackVoxels = 1e-5f; // over the errors of two distances, 2e-6 each

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
  // Nearer ones are alone even over a plane along the grid: the balls around them and what is above them do not meet.
  BRICKFIELD_BEST_SIMD(markAbove(distances, 0.5f * kSegmentSlackVoxels, mask));
  return mask;
}

SampleMask samplesBelow(const float* values, float limit) {
  SampleMask mask;
  BRICKFIELD_BEST_SIMD(markBelow(values, limit, mask));
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

/// Links whose projections along z lie on one line, from samples that are `way` apart, against an edge above them.
struct SampleLinks::Crossing {
  glm::ivec2 first, way; ///< the sample where the line comes into the brick
  float from = 0, to = 0,
        top = 0; ///< where on the line the edge may be, in ways from the first sample; its height there
};

void SampleLinks::cutBelow(glm::vec3 from, glm::vec3 to) {
  constexpr float kSlack = 1e-3f; // voxels; over all rounding of places in a brick
  const glm::vec3 low = glm::min(from, to), high = glm::max(from, to);
  const auto last = static_cast<float>(kBrickCells);
  if (high.x < -kSlack || high.y < -kSlack || high.z < -kSlack || low.x > last + kSlack || low.y > last + kSlack)
    return;
  // Lines along rows, along columns and along both diagonals: of each family the samples that lie on one have the same
  // product with `across`.
  struct Family {
    glm::ivec2 way, across;
    int lowest, highest;
  };
  constexpr int kLast = kBrickCells;
  static constexpr std::array<Family, 4> kFamilies = {{{{1, 0}, {0, 1}, 0, kLast},
                                                       {{0, 1}, {1, 0}, 0, kLast},
                                                       {{1, 1}, {-1, 1}, -kLast, kLast},
                                                       {{1, -1}, {1, 1}, 0, 2 * kLast}}};
  for (const Family& family : kFamilies) {
    const auto acrossOf = [&](glm::vec3 p) {
      return p.x * static_cast<float>(family.across.x) + p.y * static_cast<float>(family.across.y);
    };
    const float acrossFrom = acrossOf(from), acrossTo = acrossOf(to), way = acrossTo - acrossFrom;
    const int begin = std::max(family.lowest, static_cast<int>(std::ceil(std::min(acrossFrom, acrossTo) - kSlack)));
    const int end = std::min(family.highest, static_cast<int>(std::floor(std::max(acrossFrom, acrossTo) + kSlack)));
    for (int line = begin; line <= end; ++line) {
      // The part of the edge that is as near to the line as the slack.
      float partFrom = 0, partTo = 1;
      if (std::abs(way) > kSlack) {
        const float a = (static_cast<float>(line) - kSlack - acrossFrom) / way;
        const float b = (static_cast<float>(line) + kSlack - acrossFrom) / way;
        partFrom = std::clamp(std::min(a, b), 0.0f, 1.0f), partTo = std::clamp(std::max(a, b), 0.0f, 1.0f);
      }
      const glm::vec3 p = from + partFrom * (to - from), q = from + partTo * (to - from);
      Crossing crossing;
      crossing.way = family.way;
      crossing.first = family.way.y == 0   ? glm::ivec2(0, line)
                       : family.way.x == 0 ? glm::ivec2(line, 0)
                       : family.way.y > 0  ? glm::ivec2(std::max(0, -line), std::max(0, line))
                                           : glm::ivec2(std::max(0, line - kLast), std::min(line, kLast));
      const auto along = [&](glm::vec3 place) {
        return family.way.x != 0 ? place.x - static_cast<float>(crossing.first.x)
                                 : place.y - static_cast<float>(crossing.first.y);
      };
      crossing.from = std::min(along(p), along(q)) - kSlack, crossing.to = std::max(along(p), along(q)) + kSlack;
      crossing.top = std::max(p.z, q.z) + kSlack;
      cutCrossing(crossing);
    }
  }
}

void SampleLinks::cutCrossing(const Crossing& crossing) {
  const glm::ivec2 lastSample(kBrickCells);
  const int begin = std::max(0, static_cast<int>(std::floor(crossing.from)));
  const int end = std::min(kBrickCells - 1, static_cast<int>(std::floor(crossing.to)));
  for (int i = begin; i <= end; ++i) {
    const glm::ivec2 here = crossing.first + i * crossing.way, there = here + crossing.way;
    if (glm::any(glm::lessThan(there, glm::ivec2(0))) || glm::any(glm::greaterThan(there, lastSample))) return;
    const float from = std::clamp(crossing.from - static_cast<float>(i), 0.0f, 1.0f);
    const float to = std::clamp(crossing.to - static_cast<float>(i), 0.0f, 1.0f);
    for (std::size_t step = 0; step < kLaterNeighbours.size(); ++step) {
      const Step& link = kLaterNeighbours[step];
      const bool isAhead = link.x == crossing.way.x && link.y == crossing.way.y;
      if (!isAhead && (link.x != -crossing.way.x || link.y != -crossing.way.y)) continue;
      const glm::ivec2 start = isAhead ? here : there;
      // Where the link meets the edge's plane it has risen by so much at least.
      const float risen = static_cast<float>(link.z) * (isAhead ? from : 1.0f - to);
      const std::uint64_t others = ~(std::uint64_t{1} << (start.x + kBrickSamples * start.y));
      for (std::size_t z = 0; z < links_[step].size() && static_cast<float>(z) + risen < crossing.top; ++z)
        links_[step][z] &= others;
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
