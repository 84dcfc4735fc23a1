// Edges are sorted, not hashed: the same order on any number of threads. Triangles that coincide share their edges.
#include "bakers/mesh_topology.h"

#include <algorithm>
#include <span>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "bakers/disjoint_sets.h"

namespace brickfield {

namespace {

constexpr std::size_t kVerticesAtATime = 4096;

struct DirectedEdge {
  std::uint32_t small = 0, large = 0; ///< its vertices
  std::uint32_t triangle = 0;         ///< slivers follow the triangles
  std::uint32_t opposite = 0;         ///< the triangle's third vertex
  std::uint8_t corner = 0;            ///< edge from this corner to the next
  bool forward = false;               ///< from the smaller to the larger vertex
};

/// By smaller, then larger vertex, then triangle, then corner: counted into a bucket for each smaller vertex, in the
/// order of the triangles, and then each bucket, of some six edges, sorted by the larger one.
LargeVector<DirectedEdge> sortedEdges(const TriangleSoup& soup) {
  LargeVector<std::uint32_t> firstOf(soup.positions.size() + 1, 0);
  const auto forEach = [&](const auto& visit) {
    const auto visitAll = [&](const auto& triangles, std::size_t firstNumber) {
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::uint8_t k = 0; k < 3; ++k) {
          const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1u) % 3u];
          visit(DirectedEdge{std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(firstNumber + t),
                             triangles[t][(k + 2u) % 3u], k, from < to});
        }
    };
    visitAll(soup.triangles, 0);
    visitAll(soup.slivers, soup.triangles.size());
  };
  forEach([&](const DirectedEdge& edge) { ++firstOf[edge.small + 1]; });
  for (std::size_t v = 1; v < firstOf.size(); ++v) firstOf[v] += firstOf[v - 1];
  LargeVector<DirectedEdge> edges(firstOf.back());
  LargeVector<std::uint32_t> place(firstOf.begin(), firstOf.end() - 1);
  forEach([&](const DirectedEdge& edge) { edges[place[edge.small]++] = edge; });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, place.size(), kVerticesAtATime), [&](const auto& block) {
    for (std::size_t v = block.begin(); v < block.end(); ++v)
      std::sort(edges.begin() + firstOf[v], edges.begin() + firstOf[v + 1],
                [](const DirectedEdge& a, const DirectedEdge& b) {
                  if (a.large != b.large) return a.large < b.large;
                  return a.triangle != b.triangle ? a.triangle < b.triangle : a.corner < b.corner;
                });
  });
  return edges;
}

/// Calls `visit` with the run of entries of each edge.
template <typename Visit>
void forEachEdge(const LargeVector<DirectedEdge>& edges, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].small == edges[begin].small && edges[end].large == edges[begin].large)
      ++end;
    visit(std::span(edges).subspan(begin, end - begin));
  }
}

int netDirection(std::span<const DirectedEdge> uses) {
  int net = 0;
  for (const DirectedEdge& use : uses) net += use.forward ? 1 : -1;
  return net;
}

/// Adds the triangles on an edge that may coincide with another one: all of them where there are many.
void addTwins(std::span<const DirectedEdge> uses, std::size_t triangleCount, std::vector<std::uint32_t>& twins) {
  constexpr std::size_t kMany = 16;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    bool mayCoincide = uses.size() > kMany;
    for (std::size_t j = 0; j < uses.size() && !mayCoincide; ++j)
      mayCoincide = j != i && uses[j].opposite == uses[i].opposite;
    if (mayCoincide && uses[i].triangle < triangleCount) twins.push_back(uses[i].triangle);
  }
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

/// twins  triangles that another one may coincide with, some of them more than once
void findFlatPairs(const TriangleSoup& soup, std::vector<std::uint32_t> twins, MeshTopology& topology) {
  std::sort(twins.begin(), twins.end());
  twins.erase(std::unique(twins.begin(), twins.end()), twins.end());
  std::vector<SortedTriangle> sorted;
  for (const std::uint32_t t : twins) sorted.push_back(sortTriangle(soup.triangles[t], t));
  std::sort(sorted.begin(), sorted.end(), [](const SortedTriangle& a, const SortedTriangle& b) {
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
  const LargeVector<DirectedEdge> edges = sortedEdges(soup);
  DisjointSets components(count + soup.slivers.size());
  std::vector<std::uint32_t> unbalanced, twisted, twins;
  forEachEdge(edges, [&](std::span<const DirectedEdge> uses) {
    for (const DirectedEdge& use : uses) components.unite(uses.front().triangle, use.triangle);
    addTwins(uses, count, twins);
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
  findFlatPairs(soup, std::move(twins), topology);
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
