// Loops are walked from edge to edge; where two begin at one vertex, which is whose is not known, and nothing is
// closed.
#include "scene/hole_caps.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace brickfield {

namespace {

constexpr double kMostArea = 0.02; // of a component's
constexpr std::size_t kMostEdges = 256;
// Twice an ear's area, seen along the loop's normal, over its longest side squared: flatter ones have no sure normal.
constexpr double kLeastRoundness = 1e-4;

using Edges = std::unordered_set<std::uint64_t>;

std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

class LoopCutter {
public:
  LoopCutter(std::span<const RimEdge> rims, const Edges& edges) : rims_(rims), edges_(edges) {}

  /// Adds a loop's caps and their area.
  ///
  /// most  area; a larger one is not begun: no caps have less than what the loop spans, seen along its normal
  bool cut(std::vector<std::uint32_t> loop, double most, std::vector<HoleCap>& caps, double& area) {
    if (loop.size() < 3 || loop.size() > kMostEdges) return false;
    const std::uint32_t primitive = rims_[loop[0]].primitive;
    if (!std::ranges::all_of(loop, [&](std::uint32_t e) { return rims_[e].primitive == primitive; })) return false;
    glm::dvec3 areaNormal(0);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) areaNormal += normalOf({loop[0], loop[i], loop[i + 1]});
    if (!(glm::length(areaNormal) > 0) || area + glm::length(areaNormal) / 2 > most) return false;
    normal_ = glm::normalize(areaNormal);
    for (;;) {
      const std::size_t ear = roundestEar(loop);
      if (ear == loop.size()) return false;
      caps.push_back(earAt(loop, ear));
      area += glm::length(normalOf(caps.back())) / 2;
      if (loop.size() == 3) return true;
      edges_.insert(edgeKey(rims_[caps.back()[0]].from, rims_[caps.back()[2]].from));
      loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(ear));
    }
  }

private:
  static HoleCap earAt(const std::vector<std::uint32_t>& loop, std::size_t i) {
    return {loop[(i + loop.size() - 1) % loop.size()], loop[i], loop[(i + 1) % loop.size()]};
  }
  glm::dvec3 normalOf(const HoleCap& cap) const {
    const glm::dvec3 a = rims_[cap[0]].pointFrom;
    return glm::cross(rims_[cap[1]].pointFrom - a, rims_[cap[2]].pointFrom - a);
  }
  /// loop.size(): none can be cut off. A chord that is an edge already would have too many triangles.
  std::size_t roundestEar(const std::vector<std::uint32_t>& loop) const {
    std::size_t best = loop.size();
    double most = kLeastRoundness;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const HoleCap ear = earAt(loop, i);
      const RimEdge &a = rims_[ear[0]], &b = rims_[ear[1]], &c = rims_[ear[2]];
      if (loop.size() > 3 && edges_.contains(edgeKey(a.from, c.from))) continue;
      const double longest = std::max({glm::distance(a.pointFrom, b.pointFrom), glm::distance(b.pointFrom, c.pointFrom),
                                       glm::distance(c.pointFrom, a.pointFrom)});
      const double roundness = glm::dot(normalOf(ear), normal_) / (longest * longest);
      if (roundness > most) best = i, most = roundness;
    }
    return best;
  }

  std::span<const RimEdge> rims_;
  Edges edges_;
  glm::dvec3 normal_{0};
};

/// Of one component; empty where they cannot be told apart.
std::vector<std::vector<std::uint32_t>> loopsOf(std::span<const RimEdge> rims,
                                                const std::vector<std::uint32_t>& edges) {
  std::map<std::uint32_t, std::uint32_t> edgeFrom;
  for (const std::uint32_t e : edges)
    if (!edgeFrom.emplace(rims[e].from, e).second) return {};
  std::vector<std::vector<std::uint32_t>> loops;
  while (!edgeFrom.empty()) {
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    for (auto at = edgeFrom.begin(); at != edgeFrom.end(); at = edgeFrom.find(rims[loop.back()].to)) {
      loop.push_back(at->second);
      edgeFrom.erase(at);
    }
    if (rims[loop.back()].to != rims[loop.front()].from) return {};
  }
  return loops;
}

} // namespace

std::vector<HoleCap> capSmallHoles(std::span<const RimEdge> rims, std::span<const double> areas,
                                   std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> edgesOfComponent;
  std::unordered_set<std::uint32_t> rimVertices;
  for (std::uint32_t e = 0; e < rims.size(); ++e) {
    edgesOfComponent[rims[e].component].push_back(e);
    rimVertices.insert(rims[e].from);
  }
  Edges edges;
  for (const auto& triangle : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (rimVertices.contains(triangle[k]) && rimVertices.contains(triangle[(k + 1) % 3]))
        edges.insert(edgeKey(triangle[k], triangle[(k + 1) % 3]));
  LoopCutter cutter(rims, edges);
  std::vector<HoleCap> all;
  for (const auto& [component, ofComponent] : edgesOfComponent) {
    std::vector<HoleCap> caps;
    double area = 0;
    const double most = kMostArea * areas[component];
    const auto loops = loopsOf(rims, ofComponent);
    const bool isClosed =
        std::ranges::all_of(loops, [&](const auto& loop) { return cutter.cut(loop, most, caps, area); });
    if (isClosed && area <= most) all.insert(all.end(), caps.begin(), caps.end());
  }
  std::ranges::stable_sort(all, {}, [&](const HoleCap& cap) { return rims[cap[0]].primitive; });
  return all;
}

} // namespace brickfield
