// Edges are sorted, not hashed: the same order on any number of threads.
#include "bakers/mesh_topology.h"

#include <algorithm>
#include <span>

#include <tbb/parallel_sort.h>

#include "bakers/disjoint_sets.h"

namespace brickfield {

namespace {

struct DirectedEdge {
  std::uint64_t key = 0;      ///< smaller vertex, larger vertex
  std::uint32_t triangle = 0; ///< slivers follow the triangles
  std::uint8_t corner = 0;    ///< edge from this corner to the next
  bool forward = false;       ///< from the smaller to the larger vertex
  bool operator<(const DirectedEdge& other) const {
    if (key != other.key) return key < other.key;
    return triangle != other.triangle ? triangle < other.triangle : corner < other.corner;
  }
};

std::vector<DirectedEdge> sortedEdges(const TriangleSoup& soup) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * (soup.triangles.size() + soup.slivers.size()));
  const auto addTriangle = [&](const TriangleVertices& vertices, std::size_t number) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t from = vertices[k], to = vertices[(k + 1u) % 3u];
      const std::uint64_t key = (std::uint64_t{std::min(from, to)} << 32) | std::max(from, to);
      edges.push_back({key, static_cast<std::uint32_t>(number), k, from < to});
    }
  };
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) addTriangle(soup.triangles[t], t);
  for (std::size_t t = 0; t < soup.slivers.size(); ++t) addTriangle(soup.slivers[t], soup.triangles.size() + t);
  tbb::parallel_sort(edges.begin(), edges.end());
  return edges;
}

/// Calls `visit` with the run of entries of each edge.
template <typename Visit>
void forEachEdge(const std::vector<DirectedEdge>& edges, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].key == edges[begin].key) ++end;
    visit(std::span(edges).subspan(begin, end - begin));
  }
}

int netDirection(std::span<const DirectedEdge> uses) {
  int net = 0;
  for (const DirectedEdge& use : uses) net += use.forward ? 1 : -1;
  return net;
}

struct SortedTriangle {
  TriangleVertices vertices; ///< ascending
  std::uint32_t triangle = 0;
  bool even = true; ///< the sorting permutation
};

SortedTriangle sortTriangle(TriangleVertices v, std::uint32_t triangle) {
  SortedTriangle sorted{v, triangle, true};
  const auto order = [&](std::size_t i, std::size_t j) {
    if (sorted.vertices[i] <= sorted.vertices[j]) return;
    std::swap(sorted.vertices[i], sorted.vertices[j]);
    sorted.even = !sorted.even;
  };
  order(0, 1), order(1, 2), order(0, 1);
  return sorted;
}

void findFlatPairs(const TriangleSoup& soup, MeshTopology& topology) {
  std::vector<SortedTriangle> sorted(soup.triangles.size());
  for (std::uint32_t t = 0; t < sorted.size(); ++t) sorted[t] = sortTriangle(soup.triangles[t], t);
  tbb::parallel_sort(sorted.begin(), sorted.end(), [](const SortedTriangle& a, const SortedTriangle& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.triangle < b.triangle;
  });
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    int net = 0;
    for (; end < sorted.size() && sorted[end].vertices == sorted[begin].vertices; ++end)
      net += sorted[end].even ? 1 : -1;
    if (net != 0 || end - begin < 2) continue;
    for (std::size_t i = begin; i < end; ++i) {
      topology.isFlatPair[sorted[i].triangle] = true;
      topology.isFlatPairCopy[sorted[i].triangle] = i > begin;
    }
  }
}

} // namespace

MeshTopology analyseTopology(const TriangleSoup& soup) {
  MeshTopology topology;
  const std::size_t count = soup.triangles.size();
  const std::vector<DirectedEdge> edges = sortedEdges(soup);
  DisjointSets components(count + soup.slivers.size());
  std::vector<std::uint32_t> unbalanced, twisted;
  forEachEdge(edges, [&](std::span<const DirectedEdge> uses) {
    for (const DirectedEdge& use : uses) components.unite(uses.front().triangle, use.triangle);
    const int net = netDirection(uses);
    topology.openEdges += uses.size() == 1;
    topology.nonManifoldEdges += uses.size() > 2 || (uses.size() == 2 && net != 0);
    topology.unbalancedEdges += net != 0;
    if (net != 0) unbalanced.push_back(uses.front().triangle);
    if (net != 0 && uses.size() == 2) twisted.push_back(uses.front().triangle);
  });
  std::vector<bool> isOpen(count + soup.slivers.size(), false), hasTwist = isOpen;
  for (const std::uint32_t triangle : unbalanced) isOpen[components.rootOf(triangle)] = true;
  for (const std::uint32_t triangle : twisted) hasTwist[components.rootOf(triangle)] = true;
  topology.componentOf.resize(count);
  topology.inClosedComponent.resize(count);
  topology.isTwisted.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t component = components.rootOf(t); // the first triangle: slivers follow
    topology.componentOf[t] = component;
    topology.inClosedComponent[t] = !isOpen[component];
    topology.isTwisted[t] = hasTwist[component];
  }
  topology.isFlatPair.assign(count, false);
  topology.isFlatPairCopy.assign(count, false);
  findFlatPairs(soup, topology);
  return topology;
}

std::vector<std::array<std::uint32_t, 3>> closedManifoldNeighbours(const TriangleSoup& soup) {
  if (!soup.slivers.empty()) return {};
  std::vector<std::array<std::uint32_t, 3>> neighbours(soup.triangles.size());
  DisjointSets fans(3 * soup.triangles.size()); // corners that meet at an edge of their vertex
  bool isManifold = true;
  forEachEdge(sortedEdges(soup), [&](std::span<const DirectedEdge> uses) {
    if (uses.size() != 2 || netDirection(uses) != 0) {
      isManifold = false;
      return;
    }
    const DirectedEdge &a = uses[0], &b = uses[1];
    neighbours[a.triangle][a.corner] = b.triangle;
    neighbours[b.triangle][b.corner] = a.triangle;
    fans.unite(3 * a.triangle + a.corner, 3 * b.triangle + (b.corner + 1u) % 3u); // opposite directions
    fans.unite(3 * a.triangle + (a.corner + 1u) % 3u, 3 * b.triangle + b.corner);
  });
  if (!isManifold) return {};
  std::vector<std::uint32_t> fanOfVertex(soup.positions.size(), kNoTriangle);
  for (std::uint32_t corner = 0; corner < 3 * soup.triangles.size(); ++corner) {
    std::uint32_t& fan = fanOfVertex[soup.triangles[corner / 3][corner % 3]];
    if (fan == kNoTriangle) fan = fans.rootOf(corner);
    if (fan != fans.rootOf(corner)) return {};
  }
  return neighbours;
}

} // namespace brickfield
