// Eight samples of a row against the eight beside them.
#include "bakers/sample_links.h"

#include <algorithm>
#include <cstring>

#include "bakers/float4.h"

namespace brickfield {

namespace {
constexpr float kSegmentSlackVoxels = 1e-4f; // over the rounding of distances to float
} // namespace

SampleLinks::SampleLinks(const float* distances) {
  std::copy_n(distances, kBrickSampleCount, padded_.begin() + 1);
  for (std::size_t s = 0; s < kLaterNeighbours.size(); ++s)
    for (int row = 0; row < kRows; ++row) links_[s][static_cast<std::size_t>(row)] = linkBits(kLaterNeighbours[s], row);
}

std::uint8_t SampleLinks::linkBits(const Step& step, int row) const {
  const int other = rowAt(row, step.y, step.z);
  if (other < 0) return 0;
  const Float4 reach = broadcast(step.length + kSegmentSlackVoxels);
  unsigned bits = 0;
  for (int half = 0; half < 2; ++half) {
    Float4 here, there;
    std::memcpy(&here, &padded_[static_cast<std::size_t>(1 + row * kBrickSamples + 4 * half)], sizeof(here));
    std::memcpy(&there, &padded_[static_cast<std::size_t>(1 + other * kBrickSamples + 4 * half + step.x)],
                sizeof(there));
    const auto isLinked = here + there > reach;
    for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(isLinked[i] & 1) << (4 * half + i);
  }
  const unsigned inside = step.x > 0 ? 0x7fu : step.x < 0 ? 0xfeu : 0xffu; // the neighbour lies in its row
  return static_cast<std::uint8_t>(bits & inside);
}

} // namespace brickfield
