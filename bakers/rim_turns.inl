// Samples against rim edges, eight at a time: a row of the brick. No header: rim_turns.cpp includes it once for each
// set of instructions. Operations are single and rounded, so all sets give the same.
//
// The curtain of the edge from a to b is seen under twice the angle of the number 1 + a.b - a.z - b.z
// + i (a.y b.x - a.x b.y), a and b unit vectors from the sample (rim_sums.inl). The product of all has the sum for its
// argument, but for whole turns, which are counted.
//
// Rounding. Unit vectors are off by 2^-22 and those numbers by less than 2^-19, which turns one by that over its length
// and 2 pi. Of those as near as that to zero or to the negative axis nothing is known: those samples are on the edge or
// on its curtain.

#include "bakers/wide.inl"

inline constexpr float kRoundedBy = 0x1p-19f;
inline constexpr float kLeastOff = 0x1p-16f; // of a number from the negative axis
inline constexpr float kArcTangentSlack = 1e-5f;
inline constexpr float kSumSlack = 1e-5f; // over the rounding of sums of up to some tens of turns

WIDE_INLINE Wide magnitude(Wide v) { return most(v, wide(0.0f) - v); }

/// Argument of a number in turns, by Abramowitz and Stegun 4.4.47.
WIDE_INLINE Wide turnsOf(Wide real, Wide imaginary) {
  const Wide zero = wide(0.0f), x = magnitude(real), y = magnitude(imaginary);
  const Wide t = least(x, y) / most(most(x, y), wide(1e-30f)), s = t * t;
  const Wide series = wide(0.9998660f) +
                      s * (wide(-0.3302995f) + s * (wide(0.1801410f) + s * (wide(-0.0851330f) + s * wide(0.0208351f))));
  const Wide octant = t * series * wide(0.15915494f);
  const Wide quadrant = y > x ? wide(0.25f) - octant : octant;
  const Wide half = real < zero ? wide(0.5f) - quadrant : quadrant;
  return imaginary < zero ? zero - half : half;
}

WIDE_INLINE Wide3 directionTo(glm::vec3 corner, const Wide3& samples) {
  const Wide3 offset = minus(wide(corner), samples);
  const Wide oneOver = wide(1.0f) / rootOf(most(dotOf(offset, offset), wide(1e-12f)));
  return {offset.x * oneOver, offset.y * oneOver, offset.z * oneOver};
}

struct TurnsSum {
  Wide real = Wide{} + 1.0f, imaginary = Wide{};
  Wide leastOff = Wide{} + 4.0f; ///< square of how far numbers are from the negative axis
  WideMask turns{};
};

WIDE_INLINE void addCurtain(const Wide3& a, const Wide3& b, TurnsSum& sum) {
  const Wide zero = wide(0.0f);
  const Wide x = (wide(1.0f) + dotOf(a, b)) - (a.z + b.z), y = a.y * b.x - a.x * b.y, was = sum.imaginary;
  const Wide ahead = most(x, zero);
  sum.leastOff = least(sum.leastOff, ahead * ahead + y * y);
  sum.imaginary = sum.real * y + was * x;
  sum.real = sum.real * x - was * y;
  sum.turns -= (was >= zero) & (y >= zero) & (sum.imaginary < zero);
  sum.turns += (was < zero) & (y < zero) & (sum.imaginary >= zero);
}

WIDE_INLINE void normalize(TurnsSum& sum) {
  const Wide length = rootOf(sum.real * sum.real + sum.imaginary * sum.imaginary);
  const Wide oneOver = wide(1.0f) / most(length, wide(1e-30f));
  sum.real *= oneOver, sum.imaginary *= oneOver;
}

inline void sumTurns(std::span<const RimTurns::Corner> corners, const FarTurns& far, float* turns, float* slacks) {
  constexpr std::size_t kUnscaled = 6; // numbers of a length up to 4 and down to kLeastOff: 2^-96
  const glm::vec3 slope(far.slope), middle(0.5f * static_cast<float>(kBrickCells));
  const float atFirst = static_cast<float>(far.turns) - glm::dot(slope, middle);
  const Wide farSlack = wide(static_cast<float>(far.slack) + kArcTangentSlack + kSumSlack);
  const Wide edgeSlack = wide(static_cast<float>(corners.size()) * kRoundedBy / 6.2831853f);
  const Wide x{0, 1, 2, 3, 4, 5, 6, 7};
  for (std::size_t row = 0; row < std::size_t{kBrickSamples} * kBrickSamples; ++row) {
    const auto y = static_cast<float>(row % kBrickSamples), z = static_cast<float>(row / kBrickSamples);
    const Wide3 samples{x, wide(y), wide(z)};
    TurnsSum sum;
    std::size_t nextScaled = kUnscaled;
    Wide3 a{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Wide3 b = directionTo(corners[i].point, samples);
      if (i > 0 && !corners[i - 1].isLast) addCurtain(a, b, sum);
      if (i == nextScaled) normalize(sum), nextScaled += kUnscaled;
      a = b;
    }
    normalize(sum);
    const Wide near = turnsOf(sum.real, sum.imaginary) + __builtin_convertvector(sum.turns, Wide);
    const Wide all = near + (wide(slope.x) * x + wide(atFirst + slope.y * y + slope.z * z));
    const WideMask isKnown = sum.leastOff >= wide(kLeastOff * kLeastOff);
    const Wide slack = isKnown ? farSlack + edgeSlack / rootOf(sum.leastOff) : wide(HUGE_VALF);
    std::memcpy(turns + 8 * row, &all, sizeof(Wide));
    std::memcpy(slacks + 8 * row, &slack, sizeof(Wide));
  }
}

#undef WIDE_INLINE
