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

/// Four doubles to a member of four frames; gives them back as rounded.
template <typename Member>
WIDE_INLINE Double4 put(BlockFrame* frames, const Member& member, Double4 v) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto rounded = static_cast<float>(v[i]);
    member(frames[i]) = rounded;
    v[i] = static_cast<double>(rounded);
  }
  return v;
}
template <typename Member>
WIDE_INLINE Vector4d put3(BlockFrame* frames, const Member& member, const Vector4d& v) {
  const auto axis = [&](std::size_t k) {
    return [&member, k](BlockFrame& frame) -> float& { return member(frame)[k]; };
  };
  return {put(frames, axis(0), v.x), put(frames, axis(1), v.y), put(frames, axis(2), v.z)};
}

/// Frames of four triangles from place `at` on. The rounding of a direction turns it about its anchor, which is why
/// offsets are taken along the rounded ones.
void setFrames(BlockFrame* frames, std::size_t at, const BlockRequest& request) {
  Vector4d corners[3];
  for (std::size_t i = 0; i < 4; ++i) {
    const auto points = request.soup->corners(request.triangles[std::min(at + i, request.triangles.size() - 1)]);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 p = (points[k] - request.block.center) / request.block.voxelSize;
      corners[k].x[i] = p.x, corners[k].y[i] = p.y, corners[k].z[i] = p.z;
    }
  }
  frames += at;
  const Double4 one = {1, 1, 1, 1}, zero = {0, 0, 0, 0};
  const Vector4d areaNormal = crossOf(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
  const Vector4d normal = times(one / rootOf(dotOf(areaNormal, areaNormal)), areaNormal);
  const Vector4d rounded = put3(frames, [](BlockFrame& f) -> auto& { return f.normal; }, normal);
  const Vector4d foot = times(dotOf(corners[0], normal), normal);
  put(frames, [](BlockFrame& f) -> float& { return f.height; }, dotOf(foot, rounded));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector4d edge = minus(corners[(k + 1) % 3], corners[k]);
    const Double4 length = rootOf(dotOf(edge, edge));
    const Vector4d along = times(one / length, edge), inward = crossOf(normal, along);
    Double4 anchor = zero - dotOf(corners[k], along);
    anchor = anchor < zero ? zero : anchor;
    anchor = anchor > length ? length : anchor;
    const Vector4d anchored = plus(corners[k], times(anchor, along));
    const Vector4d roundedAlong = put3(frames, [k](BlockFrame& f) -> auto& { return f.edges[k].along; }, along);
    const Vector4d roundedInward = put3(frames, [k](BlockFrame& f) -> auto& { return f.edges[k].inward; }, inward);
    put(frames, [k](BlockFrame& f) -> float& { return f.edges[k].alongOffset; }, dotOf(anchored, roundedAlong));
    put(frames, [k](BlockFrame& f) -> float& { return f.edges[k].inwardOffset; }, dotOf(anchored, roundedInward));
    put(frames, [k](BlockFrame& f) -> float& { return f.edges[k].from; }, zero - anchor);
    put(frames, [k](BlockFrame& f) -> float& { return f.edges[k].to; }, length - anchor);
  }
}

WIDE_INLINE Wide alongOf(const Wide3& point, const std::array<float, 3>& direction, float offset) {
  return point.x * wide(direction[0]) + point.y * wide(direction[1]) + point.z * wide(direction[2]) - wide(offset);
}

/// Squared distances of eight points to a triangle.
WIDE_INLINE Wide frameDistancesSquared(const BlockFrame& frame, const Wide3& points) {
  const Wide zero = wide(0.0f), height = alongOf(points, frame.normal, frame.height);
  Wide within = wide(HUGE_VALF), leastInward = wide(HUGE_VALF);
  for (const BlockFrame::Edge& edge : frame.edges) {
    const Wide t = alongOf(points, edge.along, edge.alongOffset), s = alongOf(points, edge.inward, edge.inwardOffset);
    const Wide beyond = most(most(wide(edge.from) - t, t - wide(edge.to)), zero);
    within = least(within, s * s + beyond * beyond);
    leastInward = least(leastInward, s);
  }
  return height * height + (leastInward >= zero ? zero : within);
}

/// Corners of a cube of two samples' side, or centres that are so far apart.
WIDE_INLINE Wide3 eightFrom(glm::vec3 first, float step) {
  return {wide(first.x) + wide(step) * Wide{0, 1, 0, 1, 0, 1, 0, 1}, wide(first.y) + wide(step) * Wide{0, 0, 1, 1, 0, 0, 1, 1},
          wide(first.z) + wide(step) * Wide{0, 0, 0, 0, 1, 1, 1, 1}};
}

/// Eight cubes: of the eighths of a brick, or of the eights of an eighth.
struct EightCubes {
  glm::vec3 first;    ///< the lowest corner of the first cube
  float apart, side;  ///< from one to the next, and along each
};

/// The frames of a list that may be closest to a point of each cube, and no farther than `most_`. No point of a cube is
/// farther from its closest triangle than the farthest corner from any one, as the distance to a triangle is convex:
/// from the one that is closest to the cube's centre.
///
/// count, placeOf(i)  the list, ascending
template <typename PlaceOf>
WIDE_INLINE void pick(const BlockFrame* frames, std::size_t count, const PlaceOf& placeOf, const EightCubes& cubes,
                      float most_, EightPicks& picks) {
  Wide squares[kMostBlockTriangles];
  Wide nearest = wide(HUGE_VALF);
  WideMask nearestAt{};
  const Wide3 centers = eightFrom(cubes.first + 0.5f * cubes.side, cubes.apart);
  for (std::size_t i = 0; i < count; ++i) {
    squares[i] = frameDistancesSquared(frames[placeOf(i)], centers);
    const auto at = static_cast<std::int32_t>(i);
    nearestAt = squares[i] < nearest ? WideMask{at, at, at, at, at, at, at, at} : nearestAt;
    nearest = least(nearest, squares[i]);
  }
  Wide farthestCorners{};
  for (int lane = 0; lane < 8 && count > 0; ++lane) {
    const glm::vec3 corner = cubes.first + cubes.apart * glm::vec3(lane & 1, lane >> 1 & 1, lane >> 2);
    const Wide ofCorners = frameDistancesSquared(frames[placeOf(static_cast<std::size_t>(nearestAt[lane]))],
                                                 eightFrom(corner, cubes.side));
    float farthest = ofCorners[0];
    for (int i = 1; i < 8; ++i) farthest = std::max(farthest, ofCorners[i]);
    farthestCorners[lane] = farthest;
  }
  const float radius = kHalfDiagonal * cubes.side;
  const Wide reach = least(rootOf(farthestCorners), wide(most_)) + wide(radius + kPickSlackVoxels);
  const Wide reachSquared = reach * reach;
  picks.counts.fill(0);
  for (std::size_t i = 0; i < count; ++i)
    for (unsigned within = bitsOf(squares[i] <= reachSquared); within != 0; within &= within - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(within));
      picks.places[lane][picks.counts[lane]++] = static_cast<std::uint16_t>(placeOf(i));
    }
}

/// The 2^3 samples from a sample on.
WIDE_INLINE void measureEight(const BlockRequest& request, const BlockFrame* frames, std::span<const std::uint16_t> picked,
                              glm::ivec3 first, float* distances, std::uint32_t* nearest) {
  const Wide3 points = eightFrom(glm::vec3(first) - kHalfBrick, 1.0f);
  Wide best = wide(request.most * request.most);
  WideMask bestPlace{-1, -1, -1, -1, -1, -1, -1, -1};
  for (const std::uint16_t place : picked) {
    const Wide squared = frameDistancesSquared(frames[place], points);
    const WideMask isNearer = squared < best;
    const std::int32_t p = place;
    best = least(squared, best);
    bestPlace = isNearer ? WideMask{p, p, p, p, p, p, p, p} : bestPlace;
  }
  best = rootOf(best);
  float roots[8];
  std::int32_t places[8];
  std::memcpy(roots, &best, sizeof(roots));
  std::memcpy(places, &bestPlace, sizeof(places));
  const std::size_t at = sampleIndex(first);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::size_t to = at + (i & 1) + kBrickSamples * (i >> 1 & 1) + kBrickSamples * kBrickSamples * (i >> 2);
    distances[to] = places[i] < 0 ? HUGE_VALF : roots[i];
    nearest[to] = places[i] < 0 ? kNoTriangle : request.triangles[static_cast<std::size_t>(places[i])];
  }
}

bool isAnyWanted(const BlockRequest& request, glm::ivec3 first) {
  for (int k = 0; k < 4; ++k)
    if (request.rows[static_cast<std::size_t>(first.y + (k & 1) + kBrickSamples * (first.z + (k >> 1)))] >> first.x & 3)
      return true;
  return false;
}

void measureBlock(const BlockRequest& request, BlockFrame* frames, float* distances, std::uint32_t* nearest) {
  const std::size_t count = request.triangles.size();
  for (std::size_t i = 0; i < count; i += 4) setFrames(frames, i, request);
  EightPicks ofEighths, ofEights;
  const auto itself = [](std::size_t i) { return i; };
  pick(frames, count, itself, {glm::vec3(-kHalfBrick), 4.0f, 3.0f}, request.most, ofEighths);
  for (std::size_t eighth = 0; eighth < 8; ++eighth) {
    const auto e = static_cast<int>(eighth);
    const glm::ivec3 origin = 4 * glm::ivec3(e & 1, e >> 1 & 1, e >> 2);
    const std::span<const std::uint16_t> here = ofEighths.of(eighth);
    pick(frames, here.size(), [here](std::size_t i) { return here[i]; },
         {glm::vec3(origin) - kHalfBrick, 2.0f, 1.0f}, request.most, ofEights);
    for (std::size_t eight = 0; eight < 8; ++eight) {
      const auto s = static_cast<int>(eight);
      const glm::ivec3 first = origin + 2 * glm::ivec3(s & 1, s >> 1 & 1, s >> 2);
      if (isAnyWanted(request, first)) measureEight(request, frames, ofEights.of(eight), first, distances, nearest);
    }
  }
}

#undef WIDE_INLINE
