// Sums over rim edges, eight at a time. No header: near_rims.cpp includes it once for each set of instructions.
// Operations are single and rounded, so all sets give the same.
//
// Rounding. In radii of the ball, offsets from a point p of the ball to an end a are off by 2^-23 (|a - p| + 1) or less.
// So far the ends are elsewhere, which changes the winding number by that times the slope that the edge makes at most.
// And the number whose argument is the angle of an edge's strip is off by 8 roundings of |a - p| |b - p|, which turns it
// by so much over its length.

#include "bakers/wide.inl"

WIDE_INLINE Wide3 pointsFrom(const NearRims::EdgeOct& edges, std::size_t first, const Wide3& origin) {
  Wide3 points;
  std::memcpy(&points.x, &edges.points[0][first], sizeof(Wide));
  std::memcpy(&points.y, &edges.points[1][first], sizeof(Wide));
  std::memcpy(&points.z, &edges.points[2][first], sizeof(Wide));
  return minus(points, origin);
}

/// An edge's strip along a ray as a number of length 1 whose argument is half its solid angle.
struct WideStrip {
  Wide real, imaginary;
  Wide roundings; ///< how often its argument is off by 2^-24, over 8
};

WIDE_INLINE WideStrip stripOf(const Wide3& a, const Wide3& b, Wide lengthA, Wide lengthB, const Wide3& direction) {
  const Wide zero = wide(0.0f), one = wide(1.0f);
  const Wide aheadA = dotOf(a, direction), aheadB = dotOf(b, direction), lengths = lengthA * lengthB;
  const Wide x = lengths + dotOf(a, b) - aheadA * lengthB - aheadB * lengthA;
  const Wide y = zero - dotOf(direction, crossOf(a, b));
  const Wide oneOverLength = one / most(rootOf(x * x + y * y), wide(1e-30f));
  return {x * oneOverLength, y * oneOverLength, lengths * oneOverLength};
}

/// Multiplies strips, lane by lane.
struct WideProduct {
  Wide real = Wide{} + 1.0f, imaginary = Wide{};
  WideMask turns{};

  WIDE_INLINE void multiply(const WideStrip& strip, WideMask isEdge) {
    const Wide zero = wide(0.0f);
    const Wide x = isEdge ? strip.real : wide(1.0f), y = isEdge ? strip.imaginary : zero;
    const Wide product = real * x - imaginary * y, was = imaginary;
    imaginary = real * y + imaginary * x;
    real = product;
    turns -= (was >= zero) & (y >= zero) & (imaginary < zero);
    turns += (was < zero) & (y < zero) & (imaginary >= zero);
  }
  WIDE_INLINE void store(StripProduct& product) const {
    std::memcpy(product.real.data(), &real, sizeof(real));
    std::memcpy(product.imaginary.data(), &imaginary, sizeof(imaginary));
    std::memcpy(product.turns.data(), &turns, sizeof(turns));
  }
};

WIDE_INLINE double sumOf(Wide v) {
  float lanes[8];
  std::memcpy(lanes, &v, sizeof(lanes));
  return static_cast<double>(((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
                             ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7])));
}

/// How far an edge is from the ball around a point, and what it may make of the slope there at most.
struct WideReach {
  Wide away, slope;
};
WIDE_INLINE WideReach reachOf(const Wide3& a, const Wide3& b, Wide length, Wide radius) {
  const Wide zero = wide(0.0f), one = wide(1.0f);
  const Wide3 along = minus(b, a);
  const Wide t = least(most((zero - dotOf(a, along)) / most(length * length, wide(1e-30f)), zero), one);
  const Wide3 nearest{a.x + t * along.x, a.y + t * along.y, a.z + t * along.z};
  const Wide away = rootOf(dotOf(nearest, nearest)) - radius;
  const Wide oneOverAway = one / most(away, wide(1e-15f));
  // Of an edge in one point or of an endless one, whichever is less.
  return {away, least(length * oneOverAway, wide(2.0f)) * oneOverAway};
}

void multiplyStrips(std::span<const NearRims::EdgeOct> edges, glm::vec3 direction_, glm::vec3 point, StripProduct& product) {
  const Wide3 direction = wide(direction_), origin = wide(point);
  const Wide zero = wide(0.0f), one = wide(1.0f);
  WideProduct all;
  Wide roundings = zero, moved = zero;
  WideMask isUnclear{};
  for (const NearRims::EdgeOct& oct : edges) {
    const Wide3 a = pointsFrom(oct, 0, origin), b = pointsFrom(oct, 1, origin);
    const Wide lengthA = rootOf(dotOf(a, a)), lengthB = rootOf(dotOf(b, b));
    Wide length;
    std::memcpy(&length, oct.lengths, sizeof(length));
    const WideMask isEdge = length > zero;
    const WideStrip strip = stripOf(a, b, lengthA, lengthB, direction);
    all.multiply(strip, isEdge);
    const WideReach reach = reachOf(a, b, length, zero);
    const Wide ofMoved = reach.slope * (most(lengthA, lengthB) + one);
    roundings += isEdge ? strip.roundings : zero;
    moved += ofMoved;
    // A strip that the point is on, as far as floats can tell, has no side.
    const Wide error = wide(2 * kRounding) * (wide(8.0f) * strip.roundings + ofMoved);
    isUnclear |= isEdge & (strip.real < zero) & (most(strip.imaginary, zero - strip.imaginary) <= error);
  }
  product.isClear = bitsOf(isUnclear) == 0;
  all.store(product);
  product.roundings = sumOf(roundings), product.moved = sumOf(moved);
}

/// returns  false where an edge comes into the ball
bool sumField(std::span<const NearRims::EdgeOct> edges, glm::vec3 direction_, glm::vec3 point, float radius_,
              StripProduct& product, NearField& field) {
  const Wide3 direction = wide(direction_), origin = wide(point);
  const Wide zero = wide(0.0f), one = wide(1.0f), radius = wide(radius_);
  WideProduct all;
  Wide roundings = zero, moved = zero, squares = zero, cubes = zero, slopeError = zero;
  Wide3 slope{zero, zero, zero};
  for (const NearRims::EdgeOct& oct : edges) {
    const Wide3 a = pointsFrom(oct, 0, origin), b = pointsFrom(oct, 1, origin);
    Wide length;
    std::memcpy(&length, oct.lengths, sizeof(length));
    const WideMask isEdge = length > zero;
    const WideReach reach = reachOf(a, b, length, radius);
    if (bitsOf(isEdge & (reach.away <= wide(kLeastAway))) != 0) return false;
    const Wide lengthA = rootOf(dotOf(a, a)), lengthB = rootOf(dotOf(b, b));
    const WideStrip strip = stripOf(a, b, lengthA, lengthB, direction);
    all.multiply(strip, isEdge);
    roundings += isEdge ? strip.roundings : zero;
    const Wide far = most(lengthA, lengthB) + one, oneOverAway = one / most(reach.away, wide(kLeastAway));
    moved += reach.slope * far;
    squares += reach.slope;
    cubes += reach.slope * oneOverAway;
    const Wide lengths = lengthA * lengthB, straight = lengths + dotOf(a, b);
    const Wide oneOverStraight = one / most(straight, wide(1e-30f));
    const Wide weight = (lengthA + lengthB) * oneOverStraight / most(lengths, wide(1e-30f));
    const Wide3 turn = crossOf(a, b);
    slope.x += weight * turn.x, slope.y += weight * turn.y, slope.z += weight * turn.z;
    slopeError += reach.slope * (lengths * oneOverStraight + far * oneOverAway);
  }
  all.store(product);
  product.roundings = sumOf(roundings), product.moved = sumOf(moved);
  field.slope = {sumOf(slope.x), sumOf(slope.y), sumOf(slope.z)};
  field.squares = sumOf(squares), field.cubes = sumOf(cubes), field.slopeError = sumOf(slopeError);
  return true;
}

#undef WIDE_INLINE
