// Welding by sorted hashes with an exact comparison behind them, edges by sorting, components and fans by union-find.
#include "scene/surface_topology.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include "core/hash.h"
#include "scene/hole_caps.h"

namespace brickfield {

namespace {

/// Sets that only grow together; the least member stands for its set.
class UnionFind {
public:
  explicit UnionFind(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }
  std::uint32_t find(std::uint32_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::uint32_t> parents_;
};

/// What two corners must share to stay together: everything that decides where a vertex goes.
class VertexKeys {
public:
  explicit VertexKeys(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
      firstVertices_.push_back(static_cast<std::uint32_t>(primitiveOf_.size()));
      primitiveOf_.resize(primitiveOf_.size() + mesh.primitives[p].positions.size(), static_cast<std::uint32_t>(p));
    }
  }

  std::size_t vertexCount() const { return primitiveOf_.size(); }
  std::uint32_t firstVertex(std::size_t primitive) const { return firstVertices_[primitive]; }
  std::uint32_t primitiveOf(std::uint32_t vertex) const { return primitiveOf_[vertex]; }

  void keyOf(std::uint32_t vertex, std::vector<std::uint32_t>& key) const {
    const std::uint32_t p = primitiveOf_[vertex];
    const Primitive& primitive = mesh_.primitives[p];
    const std::size_t v = vertex - firstVertices_[p];
    key.clear();
    append(primitive.positions[v], key);
    appendInfluences(primitive, v, key);
    for (const MorphTarget& target : primitive.morphTargets)
      append(target.positions.empty() ? glm::vec3(0) : target.positions[v], key);
  }

private:
  static void append(glm::vec3 value, std::vector<std::uint32_t>& key) {
    for (int axis = 0; axis < 3; ++axis) key.push_back(std::bit_cast<std::uint32_t>(value[axis] + 0.0f)); // no -0
  }

  static void appendInfluences(const Primitive& primitive, std::size_t v, std::vector<std::uint32_t>& key) {
    const auto influences = static_cast<std::size_t>(primitive.influencesPerVertex);
    if (influences == 0) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::size_t i = v * influences; i < (v + 1) * influences; ++i)
      if (primitive.jointWeights[i] != 0.0f)
        pairs.emplace_back(primitive.joints[i], std::bit_cast<std::uint32_t>(primitive.jointWeights[i]));
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [joint, weight] : pairs) key.push_back(joint), key.push_back(weight);
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> firstVertices_, primitiveOf_;
};

/// For each vertex of the mesh the first one with the same key.
std::vector<std::uint32_t> weld(const VertexKeys& keys) {
  struct Hashed {
    std::uint64_t hash;
    std::uint32_t vertex;
    bool operator<(const Hashed& other) const { return hash != other.hash ? hash < other.hash : vertex < other.vertex; }
  };
  std::vector<Hashed> order(keys.vertexCount());
  std::vector<std::uint32_t> key, other;
  for (std::uint32_t v = 0; v < order.size(); ++v) {
    keys.keyOf(v, key);
    order[v] = {hash64(std::as_bytes(std::span(key))), v};
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> first(order.size());
  std::vector<std::uint32_t> known; // the different keys of one hash, in truth always one
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || order[i].hash != order[i - 1].hash) known.clear();
    keys.keyOf(order[i].vertex, key);
    const auto same = std::find_if(known.begin(), known.end(), [&](std::uint32_t candidate) {
      keys.keyOf(candidate, other);
      return key == other;
    });
    first[order[i].vertex] = same == known.end() ? order[i].vertex : *same;
    if (same == known.end()) known.push_back(order[i].vertex);
  }
  return first;
}

struct EdgeUse {
  std::uint64_t ends; ///< lower vertex in the high half
  std::uint32_t triangle;
  std::uint8_t edge;
  bool upwards; ///< walked from the lower to the higher vertex
  bool operator<(const EdgeUse& other) const {
    return ends != other.ends ? ends < other.ends : triangle < other.triangle;
  }
};

std::vector<EdgeUse> sortedEdges(const SurfaceTopology& topology, std::size_t vertexCount) {
  const auto forEachUse = [&](auto take) {
    for (std::uint32_t t = 0; t < topology.triangleCount(); ++t)
      for (std::uint8_t k = 0; k < 3 && !topology.isDegenerate[t]; ++k)
        take(t, k, topology.vertices[t][k], topology.vertices[t][(k + 1u) % 3u]);
  };
  // By the lower vertex first, which is counting; what is left to sort are the few edges of one vertex.
  std::vector<std::uint32_t> starts(vertexCount + 1, 0);
  forEachUse(
      [&](std::uint32_t, std::uint8_t, std::uint32_t from, std::uint32_t to) { ++starts[std::min(from, to) + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<EdgeUse> uses(starts.back());
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  forEachUse([&](std::uint32_t t, std::uint8_t k, std::uint32_t from, std::uint32_t to) {
    uses[next[std::min(from, to)]++] = {std::uint64_t{std::min(from, to)} << 32 | std::max(from, to), t, k, from < to};
  });
  for (std::size_t v = 0; v < vertexCount; ++v) std::sort(uses.begin() + starts[v], uses.begin() + starts[v + 1]);
  return uses;
}

struct OddEdge {
  EdgeUse use;
  bool isRim; ///< nobody else uses it
};

/// Connects the triangles and the corners that edges connect; returns the uses of edges that are not fine.
std::vector<OddEdge> walkEdges(SurfaceTopology& topology, std::size_t vertexCount, UnionFind& components,
                               UnionFind& corners) {
  std::vector<OddEdge> odd;
  const std::vector<EdgeUse> uses = sortedEdges(topology, vertexCount);
  // The corner of a use at the edge's lower or higher end.
  const auto cornerAt = [](const EdgeUse& use, bool lower) {
    return 3u * use.triangle + (use.upwards == lower ? use.edge : (use.edge + 1u) % 3u);
  };
  for (std::size_t begin = 0, end; begin < uses.size(); begin = end) {
    for (end = begin + 1; end < uses.size() && uses[end].ends == uses[begin].ends;) ++end;
    const EdgeUse &first = uses[begin], &last = uses[end - 1];
    for (std::size_t i = begin + 1; i < end; ++i) {
      components.join(first.triangle, uses[i].triangle);
      for (const bool lower : {false, true}) corners.join(cornerAt(first, lower), cornerAt(uses[i], lower));
    }
    if (end - begin == 2 && first.upwards != last.upwards) {
      topology.neighbours[first.triangle][first.edge] = last.triangle;
      topology.neighbours[last.triangle][last.edge] = first.triangle;
    } else {
      for (std::size_t i = begin; i < end; ++i) odd.push_back({uses[i], end - begin == 1});
    }
  }
  return odd;
}

/// Numbers vertices by the fans of corners, in the order of their first corners, and lists the fans.
void makeFans(SurfaceTopology& topology, UnionFind& corners) {
  const auto cornerCount = static_cast<std::uint32_t>(3 * topology.triangleCount());
  std::vector<std::uint32_t> numbers(cornerCount);
  topology.vertexCount = 0;
  topology.fanStarts.assign(1, 0);
  for (std::uint32_t c = 0; c < cornerCount; ++c) {
    const std::uint32_t root = corners.find(c); // the least, so it has its number already
    numbers[c] = root == c ? topology.vertexCount++ : numbers[root];
    if (root == c) topology.fanStarts.push_back(0);
    topology.vertices[c / 3][c % 3] = numbers[c];
    if (!topology.isDegenerate[c / 3]) ++topology.fanStarts[numbers[c] + 1];
  }
  std::partial_sum(topology.fanStarts.begin(), topology.fanStarts.end(), topology.fanStarts.begin());
  topology.fanCorners.resize(topology.fanStarts.back());
  std::vector<std::uint32_t> next(topology.fanStarts.begin(), topology.fanStarts.end() - 1);
  for (std::uint32_t c = 0; c < cornerCount; ++c)
    if (!topology.isDegenerate[c / 3]) topology.fanCorners[next[numbers[c]]++] = 4 * (c / 3) + c % 3;
}

/// Volume, area and size of a component, to tell solids from sheets whose two sides are one.
struct Measure {
  static constexpr double kLeastSolid = 1e-6, kMostThin = 0.02;

  bool isFine = true, isCappable = true;
  glm::dvec3 origin{0};
  double volume = 0, area = 0, size = 0;
  bool isStarted = false;

  void add(const std::array<glm::dvec3, 3>& p) {
    if (!isStarted) origin = p[0], isStarted = true;
    const glm::dvec3 areaNormal = glm::cross(p[1] - p[0], p[2] - p[0]);
    volume += glm::dot(p[0] - origin, areaNormal) / 6;
    area += glm::length(areaNormal) / 2;
    for (const glm::dvec3& point : p) size = std::max(size, glm::distance(point, origin));
  }
  // Of tubes whose ends are a fiftieth of them 2 V / A is a fiftieth of their length, and of bent ones twice as much of
  // their size; rooms are about as wide as they are long. Holes hardly count in the volume, which is positive outwards.
  bool isThin() const { return volume > kLeastSolid * size * area && volume < kMostThin * size * area; }
  // A millionth of the size: ten times what rounding to float leaves of the thickness of a flat sheet.
  bool isSolid() const { return isFine && std::abs(volume) > kLeastSolid * size * area; }
};

/// What the triangles of a mesh are made of, and how they hang together.
struct Analysis {
  explicit Analysis(const Mesh& ofMesh) : mesh(ofMesh), keys(ofMesh) { listTriangles(); }

  void listTriangles();
  void addTriangle(const std::array<std::uint32_t, 3>& welded, const std::array<glm::dvec3, 3>& points);
  void connect();
  bool closeHoles();

  const Mesh& mesh;
  VertexKeys keys;
  SurfaceTopology topology;
  std::vector<std::array<glm::dvec3, 3>> positions;  ///< a triangle
  std::vector<std::array<std::uint32_t, 3>> corners; ///< a triangle of the mesh: vertices, not welded
  UnionFind cornerSets{0};
  std::vector<OddEdge> odd;
  std::vector<Measure> measures; ///< a component
};

void Analysis::addTriangle(const std::array<std::uint32_t, 3>& welded, const std::array<glm::dvec3, 3>& points) {
  topology.vertices.push_back(welded);
  topology.isDegenerate.push_back(welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]);
  positions.push_back(points);
}

void Analysis::listTriangles() {
  const std::vector<std::uint32_t> welded = weld(keys);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const Primitive& primitive = mesh.primitives[p];
    const std::uint32_t first = keys.firstVertex(p);
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
      const std::uint32_t* index = &primitive.indices[i];
      corners.push_back({first + index[0], first + index[1], first + index[2]});
      const auto& v = corners.back();
      addTriangle({welded[v[0]], welded[v[1]], welded[v[2]]},
                  {primitive.positions[index[0]], primitive.positions[index[1]], primitive.positions[index[2]]});
    }
  }
}

void Analysis::connect() {
  const std::size_t count = topology.triangleCount();
  topology.neighbours.assign(count, {SurfaceTopology::kNone, SurfaceTopology::kNone, SurfaceTopology::kNone});
  topology.componentOf.assign(count, SurfaceTopology::kNone);
  UnionFind components(count);
  cornerSets = UnionFind(3 * count);
  odd = walkEdges(topology, keys.vertexCount(), components, cornerSets);
  measures.clear();
  for (std::uint32_t t = 0; t < count; ++t) {
    if (topology.isDegenerate[t]) continue;
    const std::uint32_t root = components.find(t);
    if (root == t) topology.componentOf[t] = static_cast<std::uint32_t>(measures.size()), measures.emplace_back();
    measures[topology.componentOf[t] = topology.componentOf[root]].add(positions[t]);
  }
  for (const OddEdge& edge : odd) {
    Measure& measure = measures[topology.componentOf[edge.use.triangle]];
    measure.isFine = false;
    measure.isCappable = measure.isCappable && edge.isRim;
  }
}

/// returns  whether there are caps now, which are not connected yet
bool Analysis::closeHoles() {
  std::vector<RimEdge> rims;
  for (const OddEdge& edge : odd) {
    const std::uint32_t t = edge.use.triangle, component = topology.componentOf[t];
    if (!measures[component].isCappable || !measures[component].isThin()) continue;
    const std::size_t k = edge.use.edge, next = (k + 1) % 3;
    const std::uint32_t vertex = corners[t][next], primitive = keys.primitiveOf(vertex);
    rims.push_back({component, topology.vertices[t][next], topology.vertices[t][k], primitive,
                    vertex - keys.firstVertex(primitive), positions[t][next]});
  }
  if (rims.empty()) return false;
  std::vector<double> areas;
  for (const Measure& measure : measures) areas.push_back(measure.area);
  for (const HoleCap& cap : capSmallHoles(rims, areas, topology.vertices)) {
    std::array<std::uint32_t, 3> welded{}, vertices{};
    std::array<glm::dvec3, 3> points{};
    for (std::size_t k = 0; k < 3; ++k) {
      const RimEdge& rim = rims[cap[k]];
      welded[k] = rim.from, points[k] = rim.pointFrom;
      vertices[k] = rim.vertexFrom;
    }
    topology.caps.push_back({rims[cap[0]].primitive, vertices});
    addTriangle(welded, points);
  }
  return !topology.caps.empty();
}

} // namespace

SurfaceTopology analyseSurface(const Mesh& mesh, SmallHoles holes) {
  Analysis analysis(mesh);
  analysis.connect();
  if (holes == SmallHoles::Closed && analysis.closeHoles()) analysis.connect();
  SurfaceTopology& topology = analysis.topology;
  for (const Measure& measure : analysis.measures) topology.isClosedComponent.push_back(measure.isSolid());
  makeFans(topology, analysis.cornerSets);
  return std::move(topology);
}

} // namespace brickfield
