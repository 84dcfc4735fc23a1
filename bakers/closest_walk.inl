// The walk to the closest triangle. No header: mesh_distance.cpp includes it once for each set of instructions.
//
// Nodes are opened nearest first. Floats find the triangles that may be the closest: a bound shrinks to the least float
// distance plus a slack over rounding. What is within that bound at the end is measured in double.
//
// Slack. Coordinates are at most R + |p| in magnitude; a float coordinate or difference of theirs is off by less than
// 2^-23 (R + |p|), and the longest chain of such roundings in a box or triangle test stays below 16 of them. So a float
// distance differs from the true one by less than 2e-6 (R + |p|), and what lies further behind the best by twice that is
// no rival.

#include "bakers/wide.inl"

/// Squared distances from a point to the eight boxes of a node; 0 inside.
WIDE_INLINE Wide boxDistancesSquared(const HierarchyNode& node, const Wide3& point) {
  const Wide3 below = minus(wide(node.min), point), above = minus(point, wide(node.max));
  const Wide zero = wide(0.0f);
  const Wide x = most(most(below.x, above.x), zero), y = most(most(below.y, above.y), zero),
             z = most(most(below.z, above.z), zero);
  return x * x + y * y + z * z;
}

/// Squared distance within the plane from an edge's start + (x, y) to the edge; and whether that lies inside of it.
struct EdgeDistance {
  Wide squared, inward;
};
WIDE_INLINE EdgeDistance edgeDistance(Wide along, Wide inward, Wide length) {
  const Wide beyond = most(most(wide(0.0f) - along, along - length), wide(0.0f));
  return {inward * inward + beyond * beyond, inward};
}

/// Squared distances from a point to the eight triangles of a leaf: to the plane where the foot lies inside, else to
/// the nearest edge.
WIDE_INLINE Wide triangleDistancesSquared(const HierarchyLeaf& leaf, const Wide3& point) {
  const Wide3 alongAb = wide(leaf.alongAb), normal = wide(leaf.normal);
  const Wide3 ap = minus(point, wide(leaf.a));
  const Wide x = dotOf(ap, alongAb), y = dotOf(ap, crossOf(normal, alongAb)), height = dotOf(ap, normal);
  const Wide lengthAb = wide(leaf.lengthAb), acX = wide(leaf.acX), acY = wide(leaf.acY);
  const Wide bcX = wide(leaf.bcX), bcY = wide(leaf.bcY), fromB = x - lengthAb;
  const EdgeDistance ab = edgeDistance(x, y, lengthAb);
  const EdgeDistance ac = edgeDistance(x * acX + y * acY, x * acY - y * acX, wide(leaf.lengthAc));
  const EdgeDistance bc = edgeDistance(fromB * bcX + y * bcY, y * bcX - fromB * bcY, wide(leaf.lengthBc));
  const Wide edges = least(least(ab.squared, ac.squared), bc.squared);
  const Wide inward = least(least(ab.inward, ac.inward), bc.inward);
  return height * height + (inward >= wide(0.0f) ? wide(0.0f) : edges);
}

struct LeafCorners {
  Wide3 a, b, c;
};
WIDE_INLINE LeafCorners cornersOf(const HierarchyLeaf& leaf) {
  const Wide3 a = wide(leaf.a), alongAb = wide(leaf.alongAb), up = crossOf(wide(leaf.normal), alongAb);
  const Wide toB = wide(leaf.lengthAb), x = wide(leaf.lengthAc) * wide(leaf.acX), y = wide(leaf.lengthAc) * wide(leaf.acY);
  return {a,
          {a.x + toB * alongAb.x, a.y + toB * alongAb.y, a.z + toB * alongAb.z},
          {a.x + x * alongAb.x + y * up.x, a.y + x * alongAb.y + y * up.y, a.z + x * alongAb.z + y * up.z}};
}

class ClosestWalk {
public:
  /// roots      between them they hold all triangles within maxDistance
  /// startLeaf  is looked at first: where the answer probably lies; kNoLeaf: none
  WIDE_INLINE ClosestWalk(const MeshHierarchy& hierarchy, std::span<const HierarchyNode> roots, glm::dvec3 point,
                          double maxDistance, std::uint32_t startLeaf)
      : roots_(roots), startLeaf_(startLeaf), hierarchy_(hierarchy), point_(point), slack_(kFloatSlack * (hierarchy.soup().reach + lengthOf(point))) {
    best_.distance = maxDistance;
    bound_ = squareOf(maxDistance);
  }

  WIDE_INLINE NearestTriangle run() {
    const Wide3 point = wide(glm::vec3(point_));
    if (startLeaf_ == kNoLeaf)
      walkNearestFirst(point);
    else
      walkWithin(point);
    measureRivals();
    if (best_.triangle == kNoTriangle) best_.distance = std::numeric_limits<double>::infinity();
    return best_;
  }

private:
  struct Entry {
    float distanceSquared;
    std::uint32_t childBits; ///< of a HierarchyChild: that would be cleared before each walk
  };
  struct Rival {
    float distanceSquared;
    std::uint32_t triangle, leaf;
  };

  /// With nothing known, good bounds come from what is nearest.
  WIDE_INLINE void walkNearestFirst(const Wide3& point) {
    std::size_t size = 0;
    for (const HierarchyNode& root : roots_) size = openNearestFirst(root, point, size);
    while (size > 0) {
      const Entry top = stack_[--size];
      if (top.distanceSquared > bound_) continue;
      const HierarchyChild child{top.childBits};
      if (child.isLeaf())
        visitLeaf(child.index(), point);
      else
        size = openNearestFirst(hierarchy_.nodes()[child.index()], point, size);
    }
  }

  /// The start leaf's bound is so good that sorting costs more than it saves.
  WIDE_INLINE void walkWithin(const Wide3& point) {
    visitLeaf(startLeaf_, point);
    std::size_t size = 0;
    const auto open = [&](const HierarchyNode& node) __attribute__((always_inline)) {
      const Wide distances = boxDistancesSquared(node, point);
      for (unsigned within = bitsOf(distances <= wide(bound_)); within != 0; within &= within - 1) {
        const HierarchyChild child = node.children[static_cast<std::size_t>(std::countr_zero(within))];
        if (!child.isLeaf())
          stack_[size++].childBits = child.bits;
        else if (child.index() != startLeaf_)
          visitLeaf(child.index(), point);
      }
    };
    for (const HierarchyNode& root : roots_) open(root);
    while (size > 0) open(hierarchy_.nodes()[stack_[--size].childBits]);
  }

  WIDE_INLINE static double lengthOf(glm::dvec3 v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

  /// Of the float distances that a distance does not rule out. 1e-6: rounding of the squares.
  WIDE_INLINE float squareOf(double distance) const {
    const double reachable = distance + slack_;
    return static_cast<float>(reachable * reachable * (1.0 + 1e-6));
  }

  WIDE_INLINE void visitLeaf(std::uint32_t index, const Wide3& point) {
    const HierarchyLeaf& leaf = hierarchy_.leaves()[index];
    const Wide distances = triangleDistancesSquared(leaf, point);
    unsigned within = bitsOf(distances <= wide(bound_));
    if (within == 0) return;
    float lanes[kHierarchyWidth];
    std::memcpy(lanes, &distances, sizeof(lanes));
    float nearest = lanes[std::countr_zero(within)];
    for (unsigned rest = within & (within - 1); rest != 0; rest &= rest - 1)
      nearest = std::min(nearest, lanes[std::countr_zero(rest)]);
    // The true distance is at most a slack above the float's, and rivals may be a slack below theirs.
    bound_ = std::min(bound_, squareOf(static_cast<double>(std::sqrt(nearest)) + slack_));
    if (rivalCount_ + kHierarchyWidth > kMostRivals) measureRivals();
    for (; within != 0; within &= within - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(within));
      if (lanes[lane] <= bound_) rivals_[rivalCount_++] = {lanes[lane], leaf.triangles[lane], index};
    }
  }

  /// Pushes the children within reach, the nearest last.
  WIDE_INLINE std::size_t openNearestFirst(const HierarchyNode& node, const Wide3& point, std::size_t size) {
    const Wide distances = boxDistancesSquared(node, point);
    float lanes[kHierarchyWidth];
    std::memcpy(lanes, &distances, sizeof(lanes));
    const std::size_t bottom = size;
    for (unsigned within = bitsOf(distances <= wide(bound_)); within != 0; within &= within - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(within));
      if (node.children[lane].isNone()) break; // an infinite bound takes the absent ones in, which come last
      std::size_t slot = size++;
      for (; slot > bottom && stack_[slot - 1].distanceSquared < lanes[lane]; --slot) stack_[slot] = stack_[slot - 1];
      stack_[slot] = {lanes[lane], node.children[lane].bits};
    }
    return size;
  }

  void measureRivals() {
    for (std::size_t i = 0; i < rivalCount_; ++i) {
      const auto [distanceSquared, triangle, leaf] = rivals_[i];
      if (distanceSquared > bound_ || triangle == best_.triangle) continue;
      const double distance = distanceToTriangle(point_, hierarchy_.soup().corners(triangle));
      if (distance > best_.distance || (distance == best_.distance && triangle > best_.triangle)) continue;
      best_ = {distance, triangle, leaf};
      bound_ = std::min(bound_, squareOf(distance));
    }
    rivalCount_ = 0;
  }

  static constexpr std::size_t kMostRivals = 64;

  std::span<const HierarchyNode> roots_;
  std::uint32_t startLeaf_;
  const MeshHierarchy& hierarchy_;
  glm::dvec3 point_;
  double slack_;
  float bound_ = 0;
  NearestTriangle best_;
  std::size_t rivalCount_ = 0;
  std::array<Rival, kMostRivals> rivals_;
  std::array<Entry, 64 * kHierarchyWidth> stack_; // depth of the hierarchy times what a level leaves behind
};

/// Lower bound of the squared distances between the box around a point and eight others; 0 where they meet.
WIDE_INLINE Wide boxGapsSquared(const Wide3& min, const Wide3& max, const Wide3& center, Wide halfEdge) {
  const Wide3 below = minus(min, center), above = minus(center, max);
  const Wide zero = wide(0.0f);
  const Wide x = most(most(below.x, above.x) - halfEdge, zero), y = most(most(below.y, above.y) - halfEdge, zero),
             z = most(most(below.z, above.z) - halfEdge, zero);
  return x * x + y * y + z * z;
}

std::size_t walkAround(const MeshHierarchy& hierarchy, const CubeAround& cube, std::span<std::uint32_t> found) {
  const double slack = kFloatSlack * (hierarchy.soup().reach + glm::length(cube.center));
  const auto squareOf = [&](double distance) {
    return static_cast<float>((distance + slack) * (distance + slack) * (1.0 + 1e-6));
  };
  const Wide gapBound = wide(squareOf(cube.reach));
  const Wide centerBound = wide(squareOf(cube.reach + std::sqrt(3.0) * cube.halfEdge));
  const Wide3 center = wide(glm::vec3(cube.center));
  const Wide halfEdge = wide(static_cast<float>(cube.halfEdge));
  std::array<HierarchyChild, 64 * kHierarchyWidth> stack;
  std::size_t size = 0, count = 0;
  stack[size++] = hierarchy.root();
  while (size > 0) {
    const HierarchyChild top = stack[--size];
    if (!top.isLeaf()) {
      const HierarchyNode& node = hierarchy.nodes()[top.index()];
      unsigned within = bitsOf(boxGapsSquared(wide(node.min), wide(node.max), center, halfEdge) <= gapBound);
      for (; within != 0; within &= within - 1)
        stack[size++] = node.children[static_cast<std::size_t>(std::countr_zero(within))];
      continue;
    }
    const HierarchyLeaf& leaf = hierarchy.leaves()[top.index()];
    const auto [a, b, c] = cornersOf(leaf);
    const Wide3 min{least(a.x, least(b.x, c.x)), least(a.y, least(b.y, c.y)), least(a.z, least(b.z, c.z))};
    const Wide3 max{most(a.x, most(b.x, c.x)), most(a.y, most(b.y, c.y)), most(a.z, most(b.z, c.z))};
    unsigned within = bitsOf((boxGapsSquared(min, max, center, halfEdge) <= gapBound) &
                             (triangleDistancesSquared(leaf, center) <= centerBound));
    for (; within != 0; within &= within - 1) {
      const std::uint32_t triangle = leaf.triangles[static_cast<std::size_t>(std::countr_zero(within))];
      if (count > 0 && found[count - 1] == triangle) continue; // a lane that repeats the last one
      if (count == found.size()) return found.size() + 1;
      found[count++] = triangle;
    }
  }
  return count;
}

NearestTriangle walkToNearest(const MeshHierarchy& hierarchy, std::span<const HierarchyNode> roots, glm::dvec3 point,
                              double maxDistance, std::uint32_t startLeaf) {
  return ClosestWalk(hierarchy, roots, point, maxDistance, startLeaf).run();
}

/// Replaces nodes by those of their children that come within reach, level by level, as long as they fit.
void walkToRoots(const MeshHierarchy& hierarchy, const CubeAround& cube, LocalRoots& roots) {
  const double slack = kFloatSlack * (hierarchy.soup().reach + glm::length(cube.center));
  const Wide bound = wide(static_cast<float>((cube.reach + slack) * (cube.reach + slack) * (1.0 + 1e-6)));
  const Wide3 center = wide(glm::vec3(cube.center));
  const Wide halfEdge = wide(static_cast<float>(cube.halfEdge));
  roots.nodes[0] = hierarchy.nodes()[hierarchy.root().index()];
  roots.count = 1;
  for (bool wasOpened = true; wasOpened;) {
    wasOpened = false;
    LocalRoots next;
    std::size_t lanes = 0;
    const auto add = [&](const HierarchyNode& from, std::size_t lane) {
      HierarchyNode& to = next.nodes[lanes / kHierarchyWidth];
      const std::size_t at = lanes++ % kHierarchyWidth;
      to.min.setLane(at, from.min.lane(lane));
      to.max.setLane(at, from.max.lane(lane));
      to.children[at] = from.children[lane];
    };
    for (std::size_t i = 0; i < roots.count; ++i) {
      const HierarchyNode& root = roots.nodes[i];
      unsigned within = bitsOf(boxGapsSquared(wide(root.min), wide(root.max), center, halfEdge) <= bound);
      for (; within != 0; within &= within - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(within));
        const HierarchyChild child = root.children[lane];
        if (child.isLeaf()) {
          if (lanes == LocalRoots::kMostChildren) return;
          add(root, lane);
          continue;
        }
        const HierarchyNode& node = hierarchy.nodes()[child.index()];
        wasOpened = true;
        unsigned inner = bitsOf(boxGapsSquared(wide(node.min), wide(node.max), center, halfEdge) <= bound);
        for (; inner != 0; inner &= inner - 1) {
          if (lanes == LocalRoots::kMostChildren) return;
          add(node, static_cast<std::size_t>(std::countr_zero(inner)));
        }
      }
    }
    next.close(lanes);
    roots = next;
  }
}

#undef WIDE_INLINE
