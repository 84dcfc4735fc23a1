// Gathering and welding. Vertices are welded where all bits of their positions agree (-0 taken as 0): exporters split
// vertices for normals and texture coordinates, but copy positions.
#include "bakers/triangle_soup.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "bakers/stable_deal.h"
#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr double kLeastHeightOverEdge = 1e-12; // four decimal digits above the rounding of a double cross product

/// The vertices of all primitives in one numbering.
class AllVertices {
public:
  explicit AllVertices(const BakeInput& input) {
    for (const std::vector<glm::vec3>& positions : input.positionsObject) {
      first_.push_back(static_cast<std::uint32_t>(positions_.size()));
      positions_.insert(positions_.end(), positions.begin(), positions.end());
    }
    for (glm::vec3& position : positions_) position += glm::vec3(0.0f); // -0 becomes 0
  }

  std::uint32_t count() const { return static_cast<std::uint32_t>(positions_.size()); }
  std::uint32_t first(std::size_t primitive) const { return first_[primitive]; }
  glm::vec3 at(std::uint32_t vertex) const { return positions_[vertex]; }

private:
  std::vector<std::uint32_t> first_; ///< a primitive
  LargeVector<glm::vec3> positions_;
};

/// For each vertex the first one at its position. Vertices are dealt out by their hash, in their order, and each share
/// is looked through by an open-addressed table of its own, which fits the cache: far faster than one for all, and on
/// all threads.
class PositionWelder {
public:
  explicit PositionWelder(const AllVertices& vertices)
      : vertices_(vertices),
        firstAt_(vertices.count()),
        shareCount_(std::min(kMostShares, std::bit_ceil(std::size_t{vertices.count()} / kVerticesAShare + 1))) {
    deal();
    tbb::parallel_for(std::size_t{0}, shareCount_, [&](std::size_t share) { weld(share); });
  }

  std::uint32_t firstAt(std::uint32_t vertex) const { return firstAt_[vertex]; }

private:
  static constexpr std::size_t kMostShares = 256, kVerticesAShare = 4096;

  static std::uint64_t hash(glm::vec3 p) {
    std::uint64_t h = std::bit_cast<std::uint32_t>(p.x);
    h = h * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint32_t>(p.y); // 2^64 / golden ratio: Fibonacci hashing
    h = h * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint32_t>(p.z);
    return h * 0x9e3779b97f4a7c15u;
  }
  std::size_t shareOf(std::uint64_t hash) const { return hash >> 56 & (shareCount_ - 1); }

  /// By share, each in the order of the vertices.
  void deal() {
    dealt_.resize(firstAt_.size());
    begin_ = dealStably(
        firstAt_.size(), shareCount_,
        [&](std::size_t v) { return shareOf(hash(vertices_.at(static_cast<std::uint32_t>(v)))); },
        [&](std::size_t v, std::uint32_t place) { dealt_[place] = static_cast<std::uint32_t>(v); });
  }
  void weld(std::size_t share) {
    const std::span<const std::uint32_t> own(dealt_.data() + begin_[share], begin_[share + 1] - begin_[share]);
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * own.size() + 2), kNone);
    for (const std::uint32_t vertex : own) {
      const glm::vec3 position = vertices_.at(vertex);
      const std::uint64_t h = hash(position);
      std::size_t slot = (h ^ (h >> 32)) & (slots.size() - 1);
      while (slots[slot] != kNone && vertices_.at(slots[slot]) != position) slot = (slot + 1) & (slots.size() - 1);
      if (slots[slot] == kNone) slots[slot] = vertex;
      firstAt_[vertex] = slots[slot];
    }
  }

  const AllVertices& vertices_;
  LargeVector<std::uint32_t> firstAt_;
  std::size_t shareCount_; ///< a power of two
  LargeVector<std::uint32_t> dealt_;
  std::vector<std::uint32_t> begin_; ///< a share: of dealt_
};

void checkPrimitive(const BakeInput& input, std::size_t primitiveIndex) {
  const Primitive& primitive = *input.primitives[primitiveIndex];
  const std::vector<glm::vec3>& positions = input.positionsObject[primitiveIndex];
  const std::string element = fmt::format("primitive {}", primitiveIndex);
  if (positions.size() != primitive.positions.size())
    throw BadInput(input.label, element,
                   fmt::format("has {} posed positions for {} vertices", positions.size(), primitive.positions.size()));
  for (const std::uint32_t index : primitive.indices)
    if (index >= positions.size())
      throw BadInput(input.label, element, fmt::format("index {} of {} vertices", index, positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!isFinite(positions[i])) throw BadInput(input.label, element, fmt::format("position {} is not finite", i));
}

bool hasArea(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
  const double longestSquared = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  return glm::length(glm::cross(ab, ac)) > kLeastHeightOverEdge * longestSquared;
}

/// What is found of a block of triangles.
struct TriangleBlock {
  std::uint32_t kept = 0; ///< of positive area; later where they begin in the soup
  std::size_t degenerate = 0;
  std::vector<TriangleVertices> slivers;
  Box bounds;
};

/// All triangles by their welded vertices, which are numbered in the order of their first use; positions are those.
LargeVector<TriangleVertices> weldTriangles(const BakeInput& input, std::size_t triangleCount,
                                            LargeVector<glm::vec3>& positions) {
  const AllVertices vertices(input);
  const PositionWelder welder(vertices);
  LargeVector<std::uint32_t> numberOf(vertices.count());
  std::fill(numberOf.begin(), numberOf.end(), kNone);
  LargeVector<TriangleVertices> triangles(triangleCount);
  positions.reserve(vertices.count());
  std::size_t t = 0;
  for (std::size_t i = 0; i < input.primitives.size(); ++i) {
    const std::vector<std::uint32_t>& indices = input.primitives[i]->indices;
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3, ++t)
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t vertex = welder.firstAt(vertices.first(i) + indices[k + corner]);
        if (numberOf[vertex] == kNone) {
          numberOf[vertex] = static_cast<std::uint32_t>(positions.size());
          positions.push_back(vertices.at(vertex));
        }
        triangles[t][corner] = numberOf[vertex];
      }
  }
  return triangles;
}

/// Puts those of positive area into the soup, in their order.
class TriangleSieve {
public:
  TriangleSieve(const BakeInput& input, const LargeVector<TriangleVertices>& triangles,
                const LargeVector<glm::vec3>& positions)
      : input_(input),
        triangles_(triangles),
        positions_(positions),
        blocks_((triangles.size() + kTrianglesAtATime - 1) / kTrianglesAtATime) {}

  void run(TriangleSoup& soup) {
    tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) { look(b); });
    std::uint32_t kept = 0;
    for (TriangleBlock& block : blocks_) {
      kept += std::exchange(block.kept, kept);
      soup.degenerateCount += block.degenerate;
      soup.slivers.insert(soup.slivers.end(), block.slivers.begin(), block.slivers.end());
      soup.boundsObject.extend(block.bounds);
    }
    soup.triangles.resize(kept);
    soup.primitiveIndices.resize(kept);
    soup.triangleIndices.resize(kept);
    tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t b) { put(b, soup); });
  }

private:
  static constexpr std::size_t kTrianglesAtATime = 8192;

  bool isKept(std::size_t t) const {
    const TriangleVertices& v = triangles_[t];
    return hasArea(positions_[v[0]], positions_[v[1]], positions_[v[2]]);
  }
  std::size_t endOf(std::size_t b) const { return std::min(triangles_.size(), (b + 1) * kTrianglesAtATime); }
  void look(std::size_t b) {
    TriangleBlock& block = blocks_[b];
    for (std::size_t t = b * kTrianglesAtATime; t < endOf(b); ++t) {
      const TriangleVertices& v = triangles_[t];
      if (isKept(t)) {
        ++block.kept;
        for (const std::uint32_t vertex : v) block.bounds.extend(positions_[vertex]);
        continue;
      }
      ++block.degenerate;
      if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) block.slivers.push_back(v);
    }
  }
  void put(std::size_t b, TriangleSoup& soup) const {
    std::size_t primitive = 0, first = 0; // of the primitive
    const auto countOf = [&] { return input_.primitives[primitive]->indices.size() / 3; };
    std::size_t to = blocks_[b].kept;
    const bool isWhole = blocks_[b].degenerate == 0;
    for (std::size_t t = b * kTrianglesAtATime; t < endOf(b); ++t) {
      while (t >= first + countOf()) first += countOf(), ++primitive;
      if (!isWhole && !isKept(t)) continue;
      soup.triangles[to] = triangles_[t];
      soup.primitiveIndices[to] = static_cast<std::uint32_t>(primitive);
      soup.triangleIndices[to] = static_cast<std::uint32_t>(t - first);
      ++to;
    }
  }

  const BakeInput& input_;
  const LargeVector<TriangleVertices>& triangles_;
  const LargeVector<glm::vec3>& positions_;
  std::vector<TriangleBlock> blocks_;
};

} // namespace

TriangleSoup gatherTriangles(const BakeInput& input) {
  if (!input.scene || input.primitives.size() != input.positionsObject.size())
    throw BadInput(input.label, "", "has no scene, or not one array of positions a primitive");
  std::size_t triangleCount = 0;
  for (std::size_t i = 0; i < input.primitives.size(); ++i) {
    checkPrimitive(input, i);
    triangleCount += input.primitives[i]->indices.size() / 3;
  }
  TriangleSoup soup;
  LargeVector<glm::vec3> positions;
  const LargeVector<TriangleVertices> triangles = weldTriangles(input, triangleCount, positions);
  TriangleSieve(input, triangles, positions).run(soup);
  if (soup.triangles.empty())
    throw BadInput(input.label, "", fmt::format("has no triangle of positive area ({} without)", soup.degenerateCount));

  const double halfDiagonal = 0.5 * glm::length(glm::dvec3(soup.boundsObject.max) - glm::dvec3(soup.boundsObject.min));
  soup.centerObject = glm::dvec3(soup.boundsObject.center());
  soup.unitsPerMetre = std::ldexp(1.0, -std::ilogb(halfDiagonal));
  soup.reach = halfDiagonal * soup.unitsPerMetre * (1.0 + 1e-6); // 1e-6: the centre is rounded to float
  soup.positions.resize(positions.size());
  tbb::parallel_for(std::size_t{0}, positions.size(),
                    [&](std::size_t v) { soup.positions[v] = soup.soupFromObject(positions[v]); });
  return soup;
}

} // namespace brickfield
