// Sums over rim edges, four at a time. No header: rims.cpp includes it once for each set of instructions. Operations
// are single and rounded, so all sets give the same.

using Quad = double __attribute__((vector_size(32)));

#define QUAD_INLINE [[gnu::always_inline]] inline

struct Quad3 {
  Quad x, y, z;
};
using QuadMask = std::int64_t __attribute__((vector_size(32)));

/// The end of an edge: its distance, how much of that is along the ray, and where it is beside it.
struct StripEnd {
  Quad length, ahead, column, row;
};

constexpr std::size_t kUnscaled = 6; // factors: each is at most four times the product of three lengths

QUAD_INLINE Quad quad(double v) { return Quad{v, v, v, v}; }
QUAD_INLINE Quad quad(const float* lanes) {
  Float4 floats;
  std::memcpy(&floats, lanes, sizeof(floats));
  return __builtin_convertvector(floats, Quad);
}
/// A point as edges are looked at from it.
struct RimView {
  Quad3 center, point;
  Quad unitsPerMetre;
};
QUAD_INLINE RimView viewFrom(const Rims::Frame& frame, glm::dvec3 point) {
  return {{quad(frame.centerObject.x), quad(frame.centerObject.y), quad(frame.centerObject.z)},
          {quad(point.x), quad(point.y), quad(point.z)},
          quad(frame.unitsPerMetre)};
}
/// Where four edges begin, or end: from one place in their points on.
QUAD_INLINE Quad3 from(const RimView& view, const Rims::EdgeQuad& edges, std::size_t first) {
  return {(quad(&edges.points[0][first]) - view.center.x) * view.unitsPerMetre - view.point.x,
          (quad(&edges.points[1][first]) - view.center.y) * view.unitsPerMetre - view.point.y,
          (quad(&edges.points[2][first]) - view.center.z) * view.unitsPerMetre - view.point.z};
}
QUAD_INLINE Quad dotOf(const Quad3& a, const Quad3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
QUAD_INLINE Quad3 crossOf(const Quad3& a, const Quad3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
QUAD_INLINE Quad3 times(Quad s, const Quad3& a) { return {s * a.x, s * a.y, s * a.z}; }
QUAD_INLINE Quad rootOf(Quad v) {
#if defined(BRICKFIELD_AVX)
  return __builtin_ia32_sqrtpd256(v);
#else
  return Quad{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}
/// 1 / |a|; large where there is no length.
QUAD_INLINE Quad oneOverLength(const Quad3& a) {
  const Quad squared = dotOf(a, a);
  return quad(1.0) / rootOf(squared > quad(1e-200) ? squared : quad(1e-200));
}
QUAD_INLINE double sumOf(Quad v) { return ((v[0] + v[1]) + v[2]) + v[3]; }

/// Multiplies the numbers whose arguments are half the solid angles of the triangles from the apex to the edges; with
/// kWithSlope also adds up the edges' parts of the slope.
template <bool kWithSlope>
inline void multiplyFan(std::span<const Rims::EdgeQuad> edges, const Rims::Frame& frame, glm::dvec3 apex, glm::dvec3 point,
                        FanSums& sums) {
  const RimView view = viewFrom(frame, point);
  const glm::dvec3 toApex = apex - point;
  const Quad3 c{quad(toApex.x), quad(toApex.y), quad(toApex.z)};
  const Quad lengthC = quad(glm::length(toApex));
  Quad real = quad(1.0), imaginary = quad(0.0);
  Quad3 slope{quad(0.0), quad(0.0), quad(0.0)};
  std::size_t count = 0;
  for (const Rims::EdgeQuad& edge : edges) {
    const Quad3 a = from(view, edge, 0), b = from(view, edge, 1);
    const Quad lengthA = rootOf(dotOf(a, a)), lengthB = rootOf(dotOf(b, b));
    const Quad lengths = lengthA * lengthB, straight = lengths + dotOf(a, b);
    const Quad3 turn = crossOf(a, b);
    const Quad x = straight * lengthC + dotOf(b, c) * lengthA + dotOf(c, a) * lengthB;
    const Quad y = dotOf(c, turn);
    const Quad product = real * x - imaginary * y;
    imaginary = real * y + imaginary * x;
    real = product;
    if constexpr (kWithSlope) {
      const Quad divisor = lengths * straight;
      const Quad weight = (lengthA + lengthB) / (divisor > quad(1e-200) ? divisor : quad(1e-200));
      slope.x += weight * turn.x, slope.y += weight * turn.y, slope.z += weight * turn.z;
    }
    if (++count % kUnscaled != 0) continue;
    const Quad lengthSquared = real * real + imaginary * imaginary;
    const Quad scale = quad(1.0) / rootOf(lengthSquared > quad(1e-200) ? lengthSquared : quad(1e-200));
    real *= scale, imaginary *= scale;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const double scale = 1.0 / std::max(std::sqrt(real[i] * real[i] + imaginary[i] * imaginary[i]), 1e-200);
    sums.real[i] = scale * real[i], sums.imaginary[i] = scale * imaginary[i];
  }
  if constexpr (kWithSlope) sums.slope = glm::dvec3(sumOf(slope.x), sumOf(slope.y), sumOf(slope.z));
}

/// Multiplies the numbers whose arguments are half the solid angles of the strips from the edges on, against a ray's
/// direction and without end. Left and right of the ray are told as crossings are (ray_winding.cpp), to the same bits.
inline StripSums multiplyStrips(std::span<const Rims::EdgeQuad> edges, const Rims::Frame& frame,
                                const RayWinding::Ray& ray) {
  const RimView view = viewFrom(frame, ray.origin);
  const auto along = [&](const Quad3& v) { return ray.along == 0 ? v.x : ray.along == 1 ? v.y : v.z; };
  const auto column = [&](const Quad3& v) { return ray.along == 0 ? v.y : ray.along == 1 ? v.z : v.x; };
  const auto row = [&](const Quad3& v) { return ray.along == 0 ? v.z : ray.along == 1 ? v.x : v.y; };
  const Quad columnShear = quad(double{RayWinding::kColumnShear}), rowShear = quad(double{RayWinding::kRowShear});
  const Quad zero = quad(0.0), one = quad(1.0);
  const double length = glm::length(glm::dvec3(1.0, double{RayWinding::kColumnShear}, double{RayWinding::kRowShear}));
  const Quad oneOverLength = quad(1.0 / length), towardsLeft = quad((ray.isBackwards ? 1.0 : -1.0) / length);
  Quad real = one, imaginary = zero;
  QuadMask turns{};
  std::size_t count = 0;
  const auto seen = [&](const Quad3& v) {
    const Quad height = ray.isBackwards ? zero - along(v) : along(v);
    const Quad c = column(v), r = row(v);
    return StripEnd{rootOf(dotOf(v, v)), (height + columnShear * c + rowShear * r) * oneOverLength,
                    c - columnShear * height, r - rowShear * height};
  };
  for (const Rims::EdgeQuad& edge : edges) {
    const Quad3 a = from(view, edge, 0), b = from(view, edge, 1);
    const StripEnd ofA = seen(a), ofB = seen(b);
    Quad x = ofA.length * ofB.length + dotOf(a, b) - ofA.ahead * ofB.length - ofB.ahead * ofA.length;
    const Quad y = towardsLeft * (ofA.column * ofB.row - ofB.column * ofA.row);
    x = (x == zero) & (y == zero) ? one : x; // straight ahead
    const Quad product = real * x - imaginary * y, was = imaginary;
    imaginary = real * y + imaginary * x;
    real = product;
    turns -= (was >= zero) & (y >= zero) & (imaginary < zero);
    turns += (was < zero) & (y < zero) & (imaginary >= zero);
    if (++count % kUnscaled != 0) continue;
    const Quad lengthSquared = real * real + imaginary * imaginary;
    const Quad scale = one / rootOf(lengthSquared > quad(1e-200) ? lengthSquared : quad(1e-200));
    real *= scale, imaginary *= scale;
  }
  StripSums sums;
  for (std::size_t i = 0; i < 4; ++i) {
    const double scale = 1.0 / std::max(std::sqrt(real[i] * real[i] + imaginary[i] * imaginary[i]), 1e-200);
    sums.real[i] = scale * real[i], sums.imaginary[i] = scale * imaginary[i];
    sums.turns[i] = static_cast<int>(turns[i]);
  }
  return sums;
}

QUAD_INLINE Quad lanesOf(const double* lanes) {
  Quad v;
  std::memcpy(&v, lanes, sizeof(v));
  return v;
}

/// Loops off the ray that are so many of their radii away.
inline void sumFarLoops(std::span<const Rims::LoopQuad> loops, const RayWinding::Ray& ray, double farRadii,
                        FarLoops& far) {
  const glm::dvec3 way = ray.direction();
  const Quad zero = quad(0.0), one = quad(1.0);
  Quad flux = zero, spread = zero;
  std::size_t number = 0;
  for (const Rims::LoopQuad& loop : loops) {
    const Quad3 toCenter{lanesOf(loop.center[0]) - quad(ray.origin.x), lanesOf(loop.center[1]) - quad(ray.origin.y),
                         lanesOf(loop.center[2]) - quad(ray.origin.z)};
    const Quad radius = lanesOf(loop.radius), squared = dotOf(toCenter, toCenter), distance = rootOf(squared);
    const Quad away = distance - radius;
    const Quad ahead = dotOf(toCenter, {quad(way.x), quad(way.y), quad(way.z)});
    const QuadMask isOnRay = (ahead > zero - radius) & (squared - ahead * ahead < radius * radius);
    const QuadMask isFar = (away > quad(farRadii - 1) * radius) & ~isOnRay;
    const Quad area = dotOf({lanesOf(loop.areaVector[0]), lanesOf(loop.areaVector[1]), lanesOf(loop.areaVector[2])}, toCenter);
    const Quad oneOverDistance = one / distance, oneOverAway = one / away;
    flux += isFar ? area * oneOverDistance * oneOverDistance * oneOverDistance : zero;
    spread += isFar ? lanesOf(loop.area) * radius * oneOverAway * oneOverAway * oneOverAway : zero;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      far.near[far.nearCount] = static_cast<std::uint16_t>(number++);
      far.nearCount += isFar[lane] == 0;
    }
  }
  far.flux = sumOf(flux), far.spread = sumOf(spread);
}

/// returns false where an edge comes into the ball
inline bool addField(std::span<const Rims::EdgeQuad> edges, const Rims::Frame& frame, glm::dvec3 point, double radius,
                     FieldSums& sums) {
  const RimView view = viewFrom(frame, point);
  const Quad zero = quad(0.0), one = quad(1.0);
  Quad3 slope{zero, zero, zero};
  Quad squares = zero, cubes = zero;
  for (const Rims::EdgeQuad& edge : edges) {
    const Quad3 a = from(view, edge, 0), b = from(view, edge, 1);
    const Quad3 along{b.x - a.x, b.y - a.y, b.z - a.z};
    const Quad lengthSquared = dotOf(along, along);
    Quad t = (zero - dotOf(a, along)) / (lengthSquared > quad(1e-200) ? lengthSquared : quad(1e-200));
    t = t < zero ? zero : t;
    t = t > one ? one : t;
    const Quad3 nearest{a.x + t * along.x, a.y + t * along.y, a.z + t * along.z};
    const Quad away = rootOf(dotOf(nearest, nearest)) - quad(radius);
    if (away[0] <= 0 || away[1] <= 0 || away[2] <= 0 || away[3] <= 0) return false;
    const Quad oneOverAway = one / away, length = rootOf(lengthSquared);
    // Of an edge in one point or of an endless one, whichever is less.
    const Quad most = length * oneOverAway < quad(2.0) ? length * oneOverAway : quad(2.0);
    squares += most * oneOverAway;
    cubes += most * oneOverAway * oneOverAway;
    const Quad oneOverA = oneOverLength(a), oneOverB = oneOverLength(b), inverse = oneOverA * oneOverB;
    const Quad straight = one + dotOf(a, b) * inverse;
    const Quad weight = (oneOverA + oneOverB) * inverse / (straight > quad(1e-200) ? straight : quad(1e-200));
    const Quad3 turn = crossOf(a, b);
    slope.x += weight * turn.x, slope.y += weight * turn.y, slope.z += weight * turn.z;
  }
  sums.slope += glm::dvec3(sumOf(slope.x), sumOf(slope.y), sumOf(slope.z));
  sums.inverseSquares += sumOf(squares), sums.inverseCubes += sumOf(cubes);
  return true;
}

#undef QUAD_INLINE
