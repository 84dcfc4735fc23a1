// Maps of edges and unions of vertices: slow, and plainly right.
#include "tests/support/manifold_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <unordered_map>

namespace brickfield::test {

namespace {

class Groups {
public:
  explicit Groups(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
  std::uint32_t rootOf(std::uint32_t at) {
    while (parents_[at] != at) at = parents_[at] = parents_[parents_[at]];
    return at;
  }
  void unite(std::uint32_t a, std::uint32_t b) { parents_[rootOf(a)] = rootOf(b); }

private:
  std::vector<std::uint32_t> parents_;
};

std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

/// The triangles around a vertex lead from one neighbour to the next; a fan leads through all of them and back.
bool isFan(const std::map<std::uint32_t, std::uint32_t>& next, std::size_t triangleCount) {
  if (next.size() != triangleCount) return false;
  std::size_t seen = 0;
  const std::uint32_t first = next.begin()->first;
  for (std::uint32_t at = first;;) {
    const auto step = next.find(at);
    if (step == next.end() || ++seen > next.size()) return false;
    at = step->second;
    if (at == first) return seen == next.size();
  }
}

} // namespace

ManifoldCheck checkManifold(std::span<const std::uint32_t> indices) {
  ManifoldCheck check;
  check.triangles = indices.size() / 3;
  const std::uint32_t count = indices.empty() ? 0 : *std::max_element(indices.begin(), indices.end()) + 1;
  Groups groups(count);
  std::unordered_map<std::uint64_t, std::array<std::size_t, 2>> walks; // of an edge: upwards and downwards by index
  std::vector<std::map<std::uint32_t, std::uint32_t>> around(count);
  std::vector<std::size_t> trianglesOf(count, 0);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3], c = indices[i + (k + 2) % 3];
      ++walks[keyOf(std::min(a, b), std::max(a, b))][a < b ? 0 : 1];
      around[a].emplace(b, c);
      ++trianglesOf[a];
      groups.unite(a, b);
    }
    if (indices[i] == indices[i + 1] || indices[i] == indices[i + 2] || indices[i + 1] == indices[i + 2])
      ++check.flatTriangles;
  }
  check.edges = walks.size();
  for (const auto& [edge, walked] : walks) check.wrongEdges += walked[0] != 1 || walked[1] != 1;
  for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
    if (trianglesOf[vertex] == 0) continue;
    ++check.vertices;
    check.components += groups.rootOf(vertex) == vertex;
    check.wrongVertices += !isFan(around[vertex], trianglesOf[vertex]);
  }
  return check;
}

std::vector<std::uint32_t> weldedIndices(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) {
  std::map<std::array<float, 3>, std::uint32_t> firstAt;
  std::vector<std::uint32_t> first(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i)
    first[i] = firstAt.try_emplace({positions[i].x, positions[i].y, positions[i].z}, i).first->second;
  std::vector<std::uint32_t> welded;
  for (const std::uint32_t index : indices) welded.push_back(first[index]);
  return welded;
}

double enclosedVolume(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) {
  double volume = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::dvec3 a(positions[indices[i]]), b(positions[indices[i + 1]]), c(positions[indices[i + 2]]);
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return volume;
}

double surfaceArea(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices) {
  double area = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::dvec3 a(positions[indices[i]]), b(positions[indices[i + 1]]), c(positions[indices[i + 2]]);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return area;
}

double windingNumberAt(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices, glm::dvec3 point) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const glm::dvec3 a = glm::dvec3(positions[indices[i]]) - point, b = glm::dvec3(positions[indices[i + 1]]) - point,
                     c = glm::dvec3(positions[indices[i + 2]]) - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

} // namespace brickfield::test
