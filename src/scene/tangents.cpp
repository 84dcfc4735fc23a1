// Corners that agree in position, normal and uv are one welded vertex. Around it, triangles that share an edge with
// opposite direction and have the same handedness in uv space form a group; a group has one tangent, the sum of its
// triangles' tangents, each projected onto the plane of the normal, made unit and weighted by the corner's angle in
// that plane.
//
// Deviations from the reference implementation, all in cases that the publication leaves open: where more than two
// triangles share an edge, all that match are joined instead of the first two found, so that the order of triangles
// does not matter; triangles without area in space or in uv join no group and copy a tangent of their vertex at the
// end.
#include "scene/tangents.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

namespace brickfield {

namespace {

struct WeldKey {
  std::array<float, 8> numbers;
  bool operator==(const WeldKey&) const = default;
};

struct WeldHash {
  std::size_t operator()(const WeldKey& key) const {
    // FNV-1a over the bits; the constants are those of its authors for 64 bits.
    std::uint64_t hash = 14695981039346656037ull;
    for (const float number : key.numbers) {
      std::uint32_t bits;
      std::memcpy(&bits, &number, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ull;
    }
    return static_cast<std::size_t>(hash ^ hash >> 32);
  }
};

struct FaceFrame {
  glm::vec3 tangent{0.0f}; // unit, along growing u
  bool isUsable = false;   // has area in space and in uv
  float handedness = 1.0f; // minus the sign of the uv area
};

FaceFrame faceFrame(const std::array<glm::vec3, 3>& p, const std::array<glm::vec2, 3>& uv) {
  const glm::dvec3 d1(p[1] - p[0]), d2(p[2] - p[0]);
  const glm::dvec2 t1(uv[1] - uv[0]), t2(uv[2] - uv[0]);
  const double areaUv = t1.x * t2.y - t1.y * t2.x;
  FaceFrame frame;
  // MikkTSpace has v grow upwards, as the green channel of glTF's normal maps does; glTF's v grows downwards.
  frame.handedness = areaUv < 0.0 ? 1.0f : -1.0f;
  const glm::dvec3 direction = (areaUv < 0.0 ? -1.0 : 1.0) * (t2.y * d1 - t1.y * d2);
  const double length = glm::length(direction);
  const glm::dvec3 across = glm::cross(d1, d2);
  frame.isUsable = areaUv != 0.0 && length > 0.0 && std::isfinite(length) && glm::dot(across, across) > 0.0;
  if (frame.isUsable) frame.tangent = glm::vec3(direction / length);
  return frame;
}

glm::vec3 projected(glm::vec3 v, glm::vec3 normal) { return v - normal * glm::dot(normal, v); }

glm::vec3 unitOrZero(glm::vec3 v) {
  const float length = glm::length(v);
  return length > 0.0f && std::isfinite(length) ? v / length : glm::vec3(0.0f);
}

// Disjoint sets over corners, path halving.
class CornerSets {
public:
  explicit CornerSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
  std::uint32_t find(std::uint32_t corner) {
    while (parents_[corner] != corner) corner = parents_[corner] = parents_[parents_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a != b) parents_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::uint32_t> parents_;
};

std::uint32_t nextCorner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
std::uint32_t previousCorner(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

struct Mesh3 {
  std::span<const std::uint32_t> indices;
  std::span<const glm::vec3> positions;
  std::span<const glm::vec3> normals;
  std::span<const glm::vec2> uvs;
};

std::vector<std::uint32_t> weldCorners(const Mesh3& mesh) {
  std::vector<std::uint32_t> weldOfVertex(mesh.positions.size());
  std::unordered_map<WeldKey, std::uint32_t, WeldHash> welds;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 p = mesh.positions[v], n = mesh.normals[v];
    const glm::vec2 uv = mesh.uvs[v];
    WeldKey key{{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y}};
    for (float& number : key.numbers) number += 0.0f; // -0 and +0 are one place
    weldOfVertex[v] = welds.try_emplace(key, static_cast<std::uint32_t>(v)).first->second;
  }
  std::vector<std::uint32_t> welded(mesh.indices.size());
  for (std::size_t c = 0; c < welded.size(); ++c) welded[c] = weldOfVertex[mesh.indices[c]];
  return welded;
}

// Joins the corners of one welded vertex whose triangles share an edge through it and have the same handedness.
void joinAround(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> welded,
                std::span<const FaceFrame> frames, CornerSets& sets) {
  struct Outgoing {
    std::uint32_t other;
    float handedness;
    std::uint32_t corner;
    bool operator<(const Outgoing& o) const { return other != o.other ? other < o.other : handedness < o.handedness; }
  };
  std::vector<Outgoing> outgoing;
  for (const std::uint32_t corner : corners)
    if (const FaceFrame& frame = frames[corner / 3]; frame.isUsable)
      outgoing.push_back({welded[nextCorner(corner)], frame.handedness, corner});
  std::sort(outgoing.begin(), outgoing.end());
  std::vector<bool> isJoined(outgoing.size(), false); // by first of a run: a run is joined once, else fans go quadratic
  for (const std::uint32_t corner : corners) {
    const FaceFrame& frame = frames[corner / 3];
    if (!frame.isUsable) continue;
    const auto [first, last] = std::equal_range(outgoing.begin(), outgoing.end(),
                                                Outgoing{welded[previousCorner(corner)], frame.handedness, 0});
    if (first == last) continue;
    sets.join(corner, first->corner);
    const auto run = static_cast<std::size_t>(first - outgoing.begin());
    if (isJoined[run]) continue;
    isJoined[run] = true;
    for (auto it = first; it != last; ++it) sets.join(corner, it->corner);
  }
}

// What a triangle adds to its group's tangent at one corner.
glm::vec3 contribution(const Mesh3& mesh, std::uint32_t corner, const FaceFrame& frame) {
  const std::uint32_t vertex = mesh.indices[corner];
  const glm::vec3 n = mesh.normals[vertex], p = mesh.positions[vertex];
  const glm::vec3 toNext = unitOrZero(projected(mesh.positions[mesh.indices[nextCorner(corner)]] - p, n));
  const glm::vec3 toPrevious = unitOrZero(projected(mesh.positions[mesh.indices[previousCorner(corner)]] - p, n));
  // acos would give 0 for corners below 0.0003 and drop thin triangles.
  const float angle = std::atan2(glm::length(glm::cross(toNext, toPrevious)), glm::dot(toNext, toPrevious));
  return angle * unitOrZero(projected(frame.tangent, n));
}

} // namespace

glm::vec3 anyPerpendicular(glm::vec3 normal) {
  // Crossing with the axis that the normal has least of is furthest from degenerate: the product is at least 0.81 long.
  const glm::vec3 size = glm::abs(normal);
  glm::vec3 axis(1.0f, 0.0f, 0.0f);
  if (size.y < size.x && size.y <= size.z)
    axis = {0.0f, 1.0f, 0.0f};
  else if (size.z < size.x)
    axis = {0.0f, 0.0f, 1.0f};
  return glm::normalize(glm::cross(normal, axis));
}

std::vector<glm::vec4> cornerTangents(std::span<const std::uint32_t> indices, std::span<const glm::vec3> positions,
                                      std::span<const glm::vec3> normals, std::span<const glm::vec2> uvs) {
  const Mesh3 mesh{indices, positions, normals, uvs};
  const std::size_t cornerCount = indices.size();
  const std::vector<std::uint32_t> welded = weldCorners(mesh);
  std::vector<FaceFrame> frames(cornerCount / 3);
  for (std::size_t face = 0; face < frames.size(); ++face) {
    std::array<glm::vec3, 3> p;
    std::array<glm::vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) p[k] = positions[indices[3 * face + k]], uv[k] = uvs[indices[3 * face + k]];
    frames[face] = faceFrame(p, uv);
  }

  std::vector<std::uint32_t> byWeld(cornerCount);
  std::iota(byWeld.begin(), byWeld.end(), 0u);
  std::sort(byWeld.begin(), byWeld.end(),
            [&](std::uint32_t a, std::uint32_t b) { return welded[a] != welded[b] ? welded[a] < welded[b] : a < b; });
  CornerSets sets(cornerCount);
  std::vector<glm::vec3> sums(cornerCount, glm::vec3(0.0f)); // at the group's representative
  std::vector<glm::vec4> tangents(cornerCount, glm::vec4(0.0f));
  for (std::size_t begin = 0, end = 0; begin < cornerCount; begin = end) {
    while (end < cornerCount && welded[byWeld[end]] == welded[byWeld[begin]]) ++end;
    const std::span<const std::uint32_t> corners(byWeld.data() + begin, end - begin);
    joinAround(corners, welded, frames, sets);
    for (const std::uint32_t corner : corners)
      if (frames[corner / 3].isUsable) sums[sets.find(corner)] += contribution(mesh, corner, frames[corner / 3]);
    glm::vec4 found(anyPerpendicular(normals[indices[corners[0]]]), 1.0f);
    bool isFound = false;
    for (const std::uint32_t corner : corners) {
      if (!frames[corner / 3].isUsable) continue;
      const glm::vec3 normal = normals[indices[corner]];
      glm::vec3 tangent = unitOrZero(sums[sets.find(corner)]);
      if (tangent == glm::vec3(0.0f)) tangent = anyPerpendicular(normal);
      tangents[corner] = glm::vec4(tangent, frames[corner / 3].handedness);
      if (!isFound) found = tangents[corner], isFound = true;
    }
    for (const std::uint32_t corner : corners)
      if (!frames[corner / 3].isUsable) tangents[corner] = found;
  }
  return tangents;
}

} // namespace brickfield
