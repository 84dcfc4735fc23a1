// Each face is walked around once; what enters the inside there is joined to what leaves it.
#include "field/cube_loops.h"

namespace brickfield {

namespace {

constexpr std::uint8_t kNoEdge = 0xff;

int edgeBetween(std::size_t a, std::size_t b) {
  const std::size_t low = a & b, along = a ^ b;
  const int axis = along == 1 ? 0 : along == 2 ? 1 : 2;
  const int u = static_cast<int>(low >> ((axis + 1) % 3) & 1), v = static_cast<int>(low >> ((axis + 2) % 3) & 1);
  return 4 * axis + u + 2 * v;
}

/// Corners of a face, counter-clockwise as seen from outside of the cell. face: axis, and 3 more for the upper side.
std::array<std::size_t, 4> faceCorners(int face) {
  const int axis = face % 3;
  const std::size_t u = std::size_t{1} << ((axis + 1) % 3), v = std::size_t{1} << ((axis + 2) % 3);
  if (face < 3) return {0, v, u | v, u};
  const std::size_t side = std::size_t{1} << axis;
  return {side, side | u, side | u | v, side | v};
}

/// Whether the two corners inside of a face, across from each other, hang together within it.
bool isInsideJoined(const std::array<double, 4>& values) {
  // The bilinear patch has its saddle at (v0 v2 - v1 v3) / (v0 + v2 - v1 - v3). Products do not depend on the order,
  // so both cells at the face find the same to the last bit.
  const double even = values[0] * values[2], odd = values[1] * values[3];
  return isInsideValue(values[0]) ? even > odd : odd > even;
}

/// For each edge where a walk around the face enters the inside, the edge that the loop goes on to across the face:
/// where the walk leaves it.
void joinAcross(int face, const VoxelCorners& corners, std::array<std::uint8_t, kCubeEdges>& next) {
  const std::array<std::size_t, 4> around = faceCorners(face);
  std::array<double, 4> values;
  for (std::size_t i = 0; i < 4; ++i) values[i] = corners[around[i]];
  const auto isInside = [&](std::size_t i) { return isInsideValue(values[i % 4]); };
  std::size_t changes = 0;
  for (std::size_t i = 0; i < 4; ++i) changes += isInside(i) != isInside(i + 1);
  const bool goesOn = changes == 4 && isInsideJoined(values);
  for (std::size_t i = 0; i < 4; ++i) {
    if (!isInside(i) || isInside(i + 1)) continue; // the walk leaves the inside between corners i and i + 1
    // Back to where it came in, or on to where it comes in next.
    std::size_t entry = goesOn ? i + 1 : i + 3;
    while (isInside(entry) || !isInside(entry + 1)) entry += goesOn ? 1 : 3;
    next[static_cast<std::size_t>(edgeBetween(around[entry % 4], around[(entry + 1) % 4]))] =
        static_cast<std::uint8_t>(edgeBetween(around[i], around[(i + 1) % 4]));
  }
}

} // namespace

EdgeCorners cornersOfEdge(int edge) {
  const int axis = edge / 4;
  const std::size_t low = static_cast<std::size_t>(edge & 1) << ((axis + 1) % 3) |
                          static_cast<std::size_t>(edge >> 1 & 1) << ((axis + 2) % 3);
  return {low, low | std::size_t{1} << axis};
}

CubeLoops findCubeLoops(const VoxelCorners& values) {
  std::array<std::uint8_t, kCubeEdges> next;
  next.fill(kNoEdge);
  for (int face = 0; face < 6; ++face) joinAcross(face, values, next);
  CubeLoops loops;
  std::size_t end = 0;
  for (std::size_t first = 0; first < kCubeEdges; ++first) {
    if (next[first] == kNoEdge) continue;
    const std::size_t begin = end;
    for (std::size_t edge = first; next[edge] != kNoEdge;) {
      loops.edges[end++] = static_cast<std::uint8_t>(edge);
      const std::size_t after = next[edge];
      next[edge] = kNoEdge;
      edge = after;
    }
    loops.lengths[loops.count++] = static_cast<std::uint8_t>(end - begin);
  }
  return loops;
}

} // namespace brickfield
