// No header: block_distance.cpp includes it once for each set of instructions.
//
// In the frame of an edge (along, inward, normal) a point p has coordinates t, s and the plane's height h. It is
// inside the triangle where s >= 0 for all three edges; else the closest edge is s^2 + e^2 away within the plane, e
// how far t lies beyond the edge's ends.
//
// Of the triangles around a brick those that come into question for its eighths of 4^3 samples are picked by their
// distances to the eighths' centres, and of those the ones for each 2^3 samples, which are measured as the lanes of one
// vector.

#include "bakers/wide.inl"

using Double4 = double __attribute__((vector_size(32)));

struct Vector4d {
  Double4 x, y, z;
};
WIDE_INLINE Vector4d minus(const Vector4d& a, const Vector4d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
WIDE_INLINE Vector4d times(const Double4& s, const Vector4d& a) { return {s * a.x, s * a.y, s * a.z}; }
WIDE_INLINE Vector4d plus(const Vector4d& a, const Vector4d& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
WIDE_INLINE Double4 dotOf(const Vector4d& a, const Vector4d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WIDE_INLINE Vector4d crossOf(const Vector4d& a, const Vector4d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
WIDE_INLINE Double4 rootOf(Double4 v) {
#if defined(BRICKFIELD_AVX)
  return __builtin_ia32_sqrtpd256(v);
#else
  for (std::size_t i = 0; i < 4; ++i) v[i] = std::sqrt(v[i]);
  return v;
#endif
}

/// Four doubles to a lane of four frames; gives them back as rounded.
WIDE_INLINE Double4 put(BlockFrame* frames, BlockFrame::Lanes BlockFrame::*form, std::size_t lane, Double4 v) {
  const Float4 rounded = __builtin_convertvector(v, Float4);
  for (std::size_t i = 0; i < 4; ++i) (frames[i].*form)[lane] = rounded[i];
  return __builtin_convertvector(rounded, Double4);
}
/// A form by its direction and a point where it is zero. The rounding of a direction turns it about that point, which
/// is why the offset is taken along the rounded one.
WIDE_INLINE void putForm(BlockFrame* frames, std::size_t lane, const Vector4d& direction, const Vector4d& zero) {
  const Vector4d rounded{put(frames, &BlockFrame::x, lane, direction.x), put(frames, &BlockFrame::y, lane, direction.y),
                         put(frames, &BlockFrame::z, lane, direction.z)};
  put(frames, &BlockFrame::offset, lane, dotOf(zero, rounded));
}

WIDE_INLINE void setSteps(BlockFrame& frame) {
  for (std::size_t k = 0; k < kForms; ++k) {
    const Wide steps = wide(frame.x[k]) * Wide{0, 1, 0, 1, 0, 1, 0, 1} +
                       wide(frame.y[k]) * Wide{0, 0, 1, 1, 0, 0, 1, 1} +
                       wide(frame.z[k]) * Wide{0, 0, 0, 0, 1, 1, 1, 1};
    std::memcpy(&frame.steps[k], &steps, sizeof(steps));
  }
}

/// Frames of four triangles from place `at` on.
void setFrames(BlockFrame* frames, std::size_t at, const BlockRequest& request) {
  const double oneOverVoxel = 1.0 / request.block.voxelSize;
  const Double4 perVoxel = {oneOverVoxel, oneOverVoxel, oneOverVoxel, oneOverVoxel};
  std::array<std::array<glm::dvec3, 3>, 4> points;
  for (std::size_t i = 0; i < 4; ++i)
    points[i] = request.soup->corners(request.triangles[std::min(at + i, request.triangles.size() - 1)]);
  Vector4d corners[3];
  const glm::dvec3 center = request.block.center;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = points[0][k], &b = points[1][k], &c = points[2][k], &d = points[3][k];
    corners[k] = times(perVoxel, {Double4{a.x, b.x, c.x, d.x} - center.x, Double4{a.y, b.y, c.y, d.y} - center.y,
                                  Double4{a.z, b.z, c.z, d.z} - center.z});
  }
  frames += at;
  const Double4 one = {1, 1, 1, 1}, zero = {0, 0, 0, 0};
  const Vector4d areaNormal = crossOf(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
  const Vector4d normal = times(one / rootOf(dotOf(areaNormal, areaNormal)), areaNormal);
  putForm(frames, kHeight, normal, times(dotOf(corners[0], normal), normal));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector4d edge = minus(corners[(k + 1) % 3], corners[k]);
    const Double4 length = rootOf(dotOf(edge, edge));
    const Vector4d along = times(one / length, edge), inward = crossOf(normal, along);
    Double4 anchor = zero - dotOf(corners[k], along);
    anchor = anchor < zero ? zero : anchor;
    anchor = anchor > length ? length : anchor;
    const Vector4d anchored = plus(corners[k], times(anchor, along));
    putForm(frames, kAlong + k, along, anchored);
    putForm(frames, kInward + k, inward, anchored);
    const Float4 from = __builtin_convertvector(zero - anchor, Float4),
                 to = __builtin_convertvector(length - anchor, Float4);
    for (std::size_t i = 0; i < 4; ++i) frames[i].from[k] = from[i], frames[i].to[k] = to[i];
  }
  for (std::size_t i = 0; i < 4; ++i) setSteps(frames[i]);
}

/// Eight points at the corners of a cube, or the centres of eight cubes.
struct EightPoints {
  glm::vec3 first; ///< the lowest
  float step;
};

/// Of eight points and a triangle: squared distances, heights over its plane, and how far their feet lie within it.
struct FrameDistances {
  Wide squared, height, inward;
};
/// The forms are taken at the first point together, a form a lane.
///
/// kIsUnit  the points are one apart
template <bool kIsUnit = false>
WIDE_INLINE FrameDistances frameDistances(const BlockFrame& frame, const EightPoints& points) {
  const Wide atFirst = wide(points.first.x) * wide(frame.x) + wide(points.first.y) * wide(frame.y) +
                       wide(points.first.z) * wide(frame.z) - wide(frame.offset);
  float firsts[8];
  std::memcpy(firsts, &atFirst, sizeof(firsts));
  asm("" : "+m"(firsts)); // to be read back lane by lane: loads are cheaper than the shuffles that would replace them
  const auto form = [&](std::size_t k) __attribute__((always_inline)) {
    return wide(firsts[k]) + (kIsUnit ? wide(frame.steps[k]) : wide(points.step) * wide(frame.steps[k]));
  };
  const Wide zero = wide(0.0f), height = form(kHeight);
  Wide within = wide(HUGE_VALF), leastInward = wide(HUGE_VALF);
#pragma GCC unroll 3
  for (std::size_t k = 0; k < 3; ++k) {
    const Wide t = form(kAlong + k), s = form(kInward + k);
    const Wide beyond = t - least(most(t, wide(frame.from[k])), wide(frame.to[k]));
    within = least(within, s * s + beyond * beyond);
    leastInward = least(leastInward, s);
  }
  return {height * height + (leastInward >= zero ? zero : within), height, leastInward};
}

WIDE_INLINE float largestOf(Wide v) {
  v = most(v, __builtin_shuffle(v, WideMask{4, 5, 6, 7, 0, 1, 2, 3}));
  v = most(v, __builtin_shuffle(v, WideMask{2, 3, 0, 1, 6, 7, 4, 5}));
  return most(v, __builtin_shuffle(v, WideMask{1, 0, 3, 2, 5, 4, 7, 6}))[0];
}

/// Eight cubes: of the eighths of a brick, or of the eights of an eighth.
struct EightCubes {
  glm::vec3 first;   ///< the lowest corner of the first cube
  float apart, side; ///< from one to the next, and along each
};

/// The frames of a list that may be closest to a point of each cube, and no farther than `farthest`. No point of a cube
/// is farther from its closest triangle than the farthest corner from any one, as the distance to a triangle is convex:
/// from the one that is closest to the cube's centre.
///
/// count, placeOf(i)  the list, ascending
/// ofNearest          if asked for, gets of each cube the squared distances of its corners to what is closest to its
///                    centre, infinite where that is too far; and that is not picked then
template <bool kAsksOfNearest, typename PlaceOf>
WIDE_INLINE void pick(const BlockFrame* frames, std::size_t count, const PlaceOf& placeOf, const EightCubes& cubes,
                      float farthest, EightPicks& picks, Wide* ofNearest) {
  Wide squares[kMostBlockTriangles];
  Wide nearest = wide(HUGE_VALF);
  WideMask nearestAt{};
  const EightPoints centers{cubes.first + 0.5f * cubes.side, cubes.apart};
  for (std::size_t i = 0; i < count; ++i) {
    squares[i] = frameDistances(frames[placeOf(i)], centers).squared;
    const auto at = static_cast<std::int32_t>(i);
    nearestAt = squares[i] < nearest ? WideMask{at, at, at, at, at, at, at, at} : nearestAt;
    nearest = least(nearest, squares[i]);
  }
  const float radius = kHalfDiagonal * cubes.side;
  const Wide mostFromCenter = wide((farthest + radius + kPickSlackVoxels) * (farthest + radius + kPickSlackVoxels));
  Wide farthestCorners{};
  if constexpr (kAsksOfNearest) std::fill_n(ofNearest, 8, wide(HUGE_VALF));
  for (unsigned reached = bitsOf(nearest <= mostFromCenter); reached != 0; reached &= reached - 1) {
    const int lane = std::countr_zero(reached);
    const glm::vec3 corner = cubes.first + cubes.apart * glm::vec3(lane & 1, lane >> 1 & 1, lane >> 2);
    const BlockFrame& nearestFrame = frames[placeOf(static_cast<std::size_t>(nearestAt[lane]))];
    const Wide ofCorners = frameDistances(nearestFrame, {corner, cubes.side}).squared;
    farthestCorners[lane] = largestOf(ofCorners);
    if constexpr (kAsksOfNearest) {
      ofNearest[lane] = ofCorners;
      squares[nearestAt[lane]][lane] = HUGE_VALF;
    }
  }
  const Wide reach = least(rootOf(farthestCorners), wide(farthest)) + wide(radius + kPickSlackVoxels);
  const Wide reachSquared = reach * reach;
  std::array<std::size_t, 8> counts{};
  for (std::size_t i = 0; i < count; ++i) {
    // Written to every list and kept in those that it belongs to: no branch to guess.
    const unsigned within = bitsOf(squares[i] <= reachSquared);
    const auto place = static_cast<std::uint16_t>(placeOf(i));
#pragma GCC unroll 8
    for (std::size_t lane = 0; lane < 8; ++lane) {
      picks.places[lane][counts[lane]] = place;
      counts[lane] += within >> lane & 1;
    }
  }
  picks.counts = counts;
}

/// A lane a sample of 2^3.
WIDE_INLINE std::array<std::size_t, 8> samplesFrom(glm::ivec3 first) {
  std::array<std::size_t, 8> samples;
  for (std::size_t i = 0; i < 8; ++i)
    samples[i] = sampleIndex(first) + (i & 1) + kBrickSamples * (i >> 1 & 1) + kBrickSamples * kBrickSamples * (i >> 2);
  return samples;
}

/// The 2^3 samples from a sample on.
///
/// known  squared distances that they have already
template <BlockTells kTells>
WIDE_INLINE void measureEight(const BlockRequest& request, const BlockFrame* frames,
                              std::span<const std::uint16_t> picked, const Wide& known, glm::ivec3 first,
                              const BlockResults& results) {
  const EightPoints points{glm::vec3(first) - kHalfBrick, 1.0f};
  const Wide farthest = wide(request.most * request.most);
  Wide best = least(known, farthest), height = wide(HUGE_VALF), inward = wide(0.0f);
  WideMask bestPlace{-1, -1, -1, -1, -1, -1, -1, -1};
  for (const std::uint16_t place : picked) {
    const FrameDistances found = frameDistances<true>(frames[place], points);
    if constexpr (kTells != BlockTells::Distances) {
      const WideMask isNearer = found.squared < best;
      const std::int32_t p = place;
      bestPlace = isNearer ? WideMask{p, p, p, p, p, p, p, p} : bestPlace;
      if constexpr (kTells == BlockTells::Heights)
        height = isNearer ? found.height : height, inward = isNearer ? found.inward : inward;
    }
    best = least(found.squared, best);
  }
  best = best < farthest ? rootOf(best) : wide(HUGE_VALF);
  float roots[8], heights[8];
  std::int32_t places[8];
  std::memcpy(roots, &best, sizeof(roots));
  const std::array<std::size_t, 8> samples = samplesFrom(first);
  for (std::size_t i = 0; i < 8; ++i) results.distances[samples[i]] = roots[i];
  if constexpr (kTells == BlockTells::Distances) return;
  std::memcpy(places, &bestPlace, sizeof(places));
  for (std::size_t i = 0; i < 8; ++i)
    results.nearest[samples[i]] = places[i] < 0 ? kNoTriangle : request.triangles[static_cast<std::size_t>(places[i])];
  if constexpr (kTells == BlockTells::Heights) {
    const WideMask isClear = (inward > wide(kClearVoxels)) & (most(height, wide(0.0f) - height) > wide(kClearVoxels));
    height = isClear ? height : wide(HUGE_VALF);
    std::memcpy(heights, &height, sizeof(heights));
    for (std::size_t i = 0; i < 8; ++i) results.heights[samples[i]] = heights[i];
  }
}

bool isAnyWanted(const BlockRequest& request, glm::ivec3 first) {
  for (int k = 0; k < 4; ++k)
    if (request.rows[static_cast<std::size_t>(first.y + (k & 1) + kBrickSamples * (first.z + (k >> 1)))] >> first.x & 3)
      return true;
  return false;
}

/// The eights of an eighth from a sample on, each by its triangles of those around the eighth.
template <BlockTells kTells>
WIDE_INLINE void measureEighth(const BlockRequest& request, const BlockFrame* frames,
                               std::span<const std::uint16_t> here, glm::ivec3 origin, const BlockResults& results) {
  // Where triangles are told, those of the same distance have to be measured in their order.
  constexpr bool kKnowsNearest = kTells == BlockTells::Distances;
  EightPicks picks;
  Wide ofNearest[8];
  pick<kKnowsNearest>(
      frames, here.size(), [here](std::size_t i) { return here[i]; }, {glm::vec3(origin) - kHalfBrick, 2.0f, 1.0f},
      request.most, picks, ofNearest);
  for (std::size_t eight = 0; eight < 8; ++eight) {
    const auto s = static_cast<int>(eight);
    const glm::ivec3 first = origin + 2 * glm::ivec3(s & 1, s >> 1 & 1, s >> 2);
    const std::span<const std::uint16_t> picked = picks.of(eight);
    const Wide known = kKnowsNearest ? ofNearest[eight] : wide(HUGE_VALF);
    const bool isNear = kKnowsNearest ? known[0] < HUGE_VALF : !picked.empty();
    if (isNear && isAnyWanted(request, first)) measureEight<kTells>(request, frames, picked, known, first, results);
  }
}

void measureBlock(const BlockRequest& request, BlockFrame* frames, const BlockResults& results) {
  std::fill_n(results.distances, kBrickSampleCount, HUGE_VALF);
  if (results.nearest) std::fill_n(results.nearest, kBrickSampleCount, kNoTriangle);
  if (results.heights) std::fill_n(results.heights, kBrickSampleCount, HUGE_VALF);
  const std::size_t count = request.triangles.size();
  for (std::size_t i = 0; i < count; i += 4) setFrames(frames, i, request);
  EightPicks ofEighths;
  const auto itself = [](std::size_t i) { return i; };
  pick<false>(frames, count, itself, {glm::vec3(-kHalfBrick), 4.0f, 3.0f}, request.most, ofEighths, nullptr);
  for (std::size_t eighth = 0; eighth < 8; ++eighth) {
    const auto e = static_cast<int>(eighth);
    const glm::ivec3 origin = 4 * glm::ivec3(e & 1, e >> 1 & 1, e >> 2);
    const std::span<const std::uint16_t> here = ofEighths.of(eighth);
    if (here.empty()) continue;
    if (results.heights)
      measureEighth<BlockTells::Heights>(request, frames, here, origin, results);
    else if (results.nearest)
      measureEighth<BlockTells::Triangles>(request, frames, here, origin, results);
    else
      measureEighth<BlockTells::Distances>(request, frames, here, origin, results);
  }
}

#undef WIDE_INLINE
