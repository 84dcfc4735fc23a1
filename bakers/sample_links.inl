// Comparisons of the samples of a brick, eight at a time. No header: sample_links.cpp includes it once for each set of
// instructions.

#include "bakers/wide.inl"

WIDE_INLINE Wide wideAt(const float* lanes) {
  Wide result;
  std::memcpy(&result, lanes, sizeof(result));
  return result;
}

/// Bits of those for which test(eight of them) holds.
template <typename Test>
WIDE_INLINE void mark(const float* samples, SampleMask& mask, const Test& test) {
  for (std::size_t z = 0; z < mask.size(); ++z) {
    std::uint64_t bits = 0;
    for (std::size_t row = 0; row < 8; ++row)
      bits |= std::uint64_t{bitsOf(test(wideAt(samples + 64 * z + 8 * row)))} << (8 * row);
    mask[z] = bits;
  }
}
inline void markAbove(const float* samples, float limit, SampleMask& mask) {
  mark(
      samples, mask, [limit](const Wide& v) __attribute__((always_inline)) { return v > wide(limit); });
}
inline void markBelow(const float* samples, float limit, SampleMask& mask) {
  mark(
      samples, mask, [limit](const Wide& v) __attribute__((always_inline)) { return v < wide(limit); });
}

/// Bits of the samples of which two a step apart are more than its length when summed up.
///
/// samples  readable for as far beside as a step leads within a slice
inline void markLinks(const float* samples, const LinkStep& step, SampleMask& mask) {
  for (std::size_t z = 0; z < step.slices; ++z) {
    const float *here = samples + 64 * z, *there = here + step.places;
    std::uint64_t bits = 0;
    for (std::size_t row = 0; row < 8; ++row)
      bits |= std::uint64_t{bitsOf(wideAt(here + 8 * row) + wideAt(there + 8 * row) > wide(step.reach))} << (8 * row);
    mask[z] = bits & step.inBrick;
  }
  for (std::size_t z = step.slices; z < mask.size(); ++z) mask[z] = 0;
}

inline void markAllLinks(const float* samples, std::span<const LinkStep> steps, SampleMask* masks) {
  for (std::size_t s = 0; s < steps.size(); ++s) markLinks(samples, steps[s], masks[s]);
}

#undef WIDE_INLINE
