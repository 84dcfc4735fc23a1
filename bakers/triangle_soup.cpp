// Gathering and welding. Vertices are welded where all bits of their positions agree (-0 taken as 0): exporters split
// vertices for normals and texture coordinates, but copy positions.
#include "bakers/triangle_soup.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace brickfield {

namespace {

constexpr std::uint32_t kNotWelded = ~0u;
constexpr double kLeastHeightOverEdge = 1e-12; // four decimal digits above the rounding of a double cross product

/// Open-addressed table of positions: far faster than a node-based map for the millions of vertices of a scan.
class PositionWelder {
public:
  explicit PositionWelder(std::size_t vertexCount) : slots_(std::bit_ceil(2 * vertexCount + 2), kFree) {
    points_.reserve(vertexCount);
  }

  std::uint32_t indexOf(glm::vec3 position) {
    position += glm::vec3(0.0f); // -0 becomes 0
    std::size_t slot = hash(position) & (slots_.size() - 1);
    while (slots_[slot] != kFree && points_[slots_[slot]] != position) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == kFree) {
      slots_[slot] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(position);
    }
    return slots_[slot];
  }
  const LargeVector<glm::vec3>& points() const { return points_; }

private:
  static constexpr std::uint32_t kFree = ~0u;
  static std::size_t hash(glm::vec3 p) {
    std::uint64_t h = std::bit_cast<std::uint32_t>(p.x);
    h = h * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint32_t>(p.y); // 2^64 / golden ratio: Fibonacci hashing
    h = h * 0x9e3779b97f4a7c15u + std::bit_cast<std::uint32_t>(p.z);
    h *= 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }

  LargeVector<std::uint32_t> slots_;
  LargeVector<glm::vec3> points_;
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

void gatherPrimitive(TriangleSoup& soup, PositionWelder& welder, const BakeInput& input, std::size_t primitiveIndex) {
  const Primitive& primitive = *input.primitives[primitiveIndex];
  const std::vector<glm::vec3>& positions = input.positionsObject[primitiveIndex];
  LargeVector<std::uint32_t> weldedOf(positions.size(), kNotWelded); // in the order of their first use
  const auto weld = [&](std::uint32_t vertex) {
    if (weldedOf[vertex] == kNotWelded) weldedOf[vertex] = welder.indexOf(positions[vertex]);
    return weldedOf[vertex];
  };
  for (std::size_t t = 0; t < primitive.indices.size() / 3; ++t) {
    TriangleVertices vertices;
    for (std::size_t k = 0; k < 3; ++k) vertices[k] = weld(primitive.indices[3 * t + k]);
    const std::array<glm::vec3, 3> corners = {welder.points()[vertices[0]], welder.points()[vertices[1]],
                                              welder.points()[vertices[2]]};
    if (!hasArea(corners[0], corners[1], corners[2])) {
      ++soup.degenerateCount;
      if (vertices[0] != vertices[1] && vertices[1] != vertices[2] && vertices[2] != vertices[0])
        soup.slivers.push_back(vertices);
      continue;
    }
    soup.triangles.push_back(vertices);
    soup.primitiveIndices.push_back(static_cast<std::uint32_t>(primitiveIndex));
    soup.triangleIndices.push_back(static_cast<std::uint32_t>(t));
    for (const glm::vec3 corner : corners) soup.boundsObject.extend(corner);
  }
}

} // namespace

TriangleSoup gatherTriangles(const BakeInput& input) {
  if (!input.scene || input.primitives.size() != input.positionsObject.size())
    throw BadInput(input.label, "", "has no scene, or not one array of positions a primitive");
  std::size_t vertexCount = 0;
  for (std::size_t i = 0; i < input.primitives.size(); ++i) {
    checkPrimitive(input, i);
    vertexCount += input.positionsObject[i].size();
  }
  TriangleSoup soup;
  std::size_t triangleCount = 0;
  for (const Primitive* primitive : input.primitives) triangleCount += primitive->indices.size() / 3;
  soup.triangles.reserve(triangleCount);
  soup.primitiveIndices.reserve(triangleCount);
  soup.triangleIndices.reserve(triangleCount);
  PositionWelder welder(vertexCount);
  for (std::size_t i = 0; i < input.primitives.size(); ++i) gatherPrimitive(soup, welder, input, i);
  if (soup.triangles.empty())
    throw BadInput(input.label, "", fmt::format("has no triangle of positive area ({} without)", soup.degenerateCount));

  const double halfDiagonal = 0.5 * glm::length(glm::dvec3(soup.boundsObject.max) - glm::dvec3(soup.boundsObject.min));
  soup.centerObject = glm::dvec3(soup.boundsObject.center());
  soup.unitsPerMetre = std::ldexp(1.0, -std::ilogb(halfDiagonal));
  soup.reach = halfDiagonal * soup.unitsPerMetre * (1.0 + 1e-6); // 1e-6: the centre is rounded to float
  soup.positions.reserve(welder.points().size());
  for (const glm::vec3 point : welder.points()) soup.positions.push_back(soup.soupFromObject(point));
  return soup;
}

} // namespace brickfield
