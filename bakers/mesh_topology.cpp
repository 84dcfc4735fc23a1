// Edges are sorted, not hashed: the same order on any number of threads. Triangles that coincide share their edges.
#include "bakers/mesh_topology.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include <tbb/parallel_for.h>

#include "bakers/disjoint_sets.h"

namespace brickfield {

namespace {

struct DirectedEdge {
  std::uint32_t small = 0, large = 0; ///< its vertices
  std::uint32_t triangle = 0;         ///< slivers follow the triangles
  std::uint32_t opposite = 0;         ///< the triangle's third vertex
  std::uint8_t corner = 0;            ///< edge from this corner to the next
  bool forward = false;               ///< from the smaller to the larger vertex
};

/// By smaller, then larger vertex, then triangle, then corner. Edges are dealt out by blocks of smaller vertices, on
/// all threads; each block counts its own into a bucket for each vertex, and sorts each bucket, of some six edges.
class SortedEdges {
public:
  explicit SortedEdges(const TriangleSoup& soup)
      : soup_(soup),
        edges_(3 * (soup.triangles.size() + soup.slivers.size())),
        begin_(soup.positions.size() / kVerticesAtATime + 2) {
    const LargeVector<std::uint32_t> dealt = deal();
    tbb::parallel_for(std::size_t{0}, blockCount(), [&](std::size_t block) {
      sortBlock(block, std::span(dealt).subspan(begin_[block], begin_[block + 1] - begin_[block]));
    });
  }

  std::span<const DirectedEdge> all() const { return edges_; }
  /// All edges of a smaller vertex are in one block.
  std::size_t blockCount() const { return begin_.size() - 1; }
  std::span<const DirectedEdge> ofBlock(std::size_t block) const {
    return all().subspan(begin_[block], begin_[block + 1] - begin_[block]);
  }

private:
  static constexpr std::size_t kVerticesAtATime = 4096, kTrianglesAtATime = 16384;

  const TriangleVertices& verticesOf(std::size_t triangle) const {
    const std::size_t count = soup_.triangles.size();
    return triangle < count ? soup_.triangles[triangle] : soup_.slivers[triangle - count];
  }
  /// number  of the triangle, three times, and its corner
  DirectedEdge edge(std::uint32_t number) const {
    const std::size_t t = number / 3, k = number % 3;
    const TriangleVertices& v = verticesOf(t);
    const std::uint32_t from = v[k], to = v[(k + 1) % 3];
    return {std::min(from, to), std::max(from, to),           static_cast<std::uint32_t>(t),
            v[(k + 2) % 3],     static_cast<std::uint8_t>(k), from < to};
  }
  /// Numbers of edges by block, ascending in each.
  LargeVector<std::uint32_t> deal() {
    const std::size_t parts = (edges_.size() + 3 * kTrianglesAtATime - 1) / (3 * kTrianglesAtATime);
    const std::size_t triangleCount = edges_.size() / 3;
    const auto forEachOf = [&](std::size_t part, const auto& visit) {
      const std::size_t end = std::min(triangleCount, (part + 1) * kTrianglesAtATime);
      for (std::size_t t = part * kTrianglesAtATime; t < end; ++t) {
        const TriangleVertices& v = verticesOf(t);
        for (std::size_t k = 0; k < 3; ++k)
          visit(static_cast<std::uint32_t>(3 * t + k), std::min(v[k], v[(k + 1) % 3]) / kVerticesAtATime);
      }
    };
    std::vector<std::vector<std::uint32_t>> places(parts, std::vector<std::uint32_t>(blockCount(), 0));
    tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
      forEachOf(part, [&](std::uint32_t, std::size_t block) { ++places[part][block]; });
    });
    std::uint32_t next = 0;
    for (std::size_t block = 0; block < blockCount(); ++block) {
      begin_[block] = next;
      for (std::vector<std::uint32_t>& ofPart : places) next += std::exchange(ofPart[block], next);
    }
    begin_.back() = next;
    LargeVector<std::uint32_t> dealt(edges_.size());
    tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t part) {
      forEachOf(part, [&](std::uint32_t number, std::size_t block) { dealt[places[part][block]++] = number; });
    });
    return dealt;
  }
  void sortBlock(std::size_t block, std::span<const std::uint32_t> numbers) {
    const std::size_t firstVertex = block * kVerticesAtATime;
    const std::size_t count = std::min(kVerticesAtATime, soup_.positions.size() - firstVertex);
    std::vector<std::uint32_t> place(count + 1, 0);
    LargeVector<DirectedEdge> unsorted(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      unsorted[i] = edge(numbers[i]);
      ++place[unsorted[i].small - firstVertex + 1];
    }
    std::partial_sum(place.begin(), place.end(), place.begin());
    const std::span<DirectedEdge> edges = std::span(edges_).subspan(begin_[block], numbers.size());
    for (const DirectedEdge& here : unsorted) edges[place[here.small - firstVertex]++] = here;
    std::uint32_t begin = 0; // each place is where the next bucket begins by now
    for (std::size_t v = 0; v < count; begin = place[v++])
      std::sort(edges.begin() + begin, edges.begin() + place[v], [](const DirectedEdge& a, const DirectedEdge& b) {
        if (a.large != b.large) return a.large < b.large;
        return a.triangle != b.triangle ? a.triangle < b.triangle : a.corner < b.corner;
      });
  }

  const TriangleSoup& soup_;
  LargeVector<DirectedEdge> edges_;
  std::vector<std::uint32_t> begin_; ///< a block
};

/// Calls `visit` with the run of entries of each edge.
template <typename Visit>
void forEachEdge(std::span<const DirectedEdge> edges, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].small == edges[begin].small && edges[end].large == edges[begin].large)
      ++end;
    visit(edges.subspan(begin, end - begin));
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

/// What some edges tell.
struct EdgeFindings {
  std::size_t openEdges = 0, nonManifoldEdges = 0;
  std::vector<std::uint32_t> unbalanced, twisted; ///< an edge: its first triangle
  std::vector<std::uint32_t> twins;

  void add(std::span<const DirectedEdge> uses, std::size_t triangleCount) {
    addTwins(uses, triangleCount, twins);
    const int net = netDirection(uses);
    openEdges += uses.size() == 1;
    nonManifoldEdges += uses.size() > 2 || (uses.size() == 2 && net != 0);
    if (net != 0) unbalanced.push_back(uses.front().triangle);
    if (net != 0 && uses.size() == 2) twisted.push_back(uses.front().triangle);
  }
};

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
  const SortedEdges edges(soup);
  SharedSets components(count + soup.slivers.size());
  std::vector<EdgeFindings> findings(edges.blockCount());
  tbb::parallel_for(std::size_t{0}, findings.size(), [&](std::size_t block) {
    forEachEdge(edges.ofBlock(block), [&](std::span<const DirectedEdge> uses) {
      for (const DirectedEdge& use : uses.subspan(1)) components.unite(uses.front().triangle, use.triangle);
      findings[block].add(uses, count);
    });
  });
  std::vector<std::uint32_t> twins;
  for (const EdgeFindings& found : findings) {
    topology.openEdges += found.openEdges;
    topology.nonManifoldEdges += found.nonManifoldEdges;
    topology.unbalancedEdges += found.unbalanced.size();
    twins.insert(twins.end(), found.twins.begin(), found.twins.end());
  }
  std::vector<bool> isOpen(count + soup.slivers.size(), false), hasTwist = isOpen;
  for (const EdgeFindings& found : findings) {
    for (const std::uint32_t triangle : found.unbalanced) isOpen[components.rootOf(triangle)] = true;
    for (const std::uint32_t triangle : found.twisted) hasTwist[components.rootOf(triangle)] = true;
  }
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
  forEachEdge(SortedEdges(soup).all(), [&](std::span<const DirectedEdge> uses) {
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
