// The walk along a ray. No header: ray_winding.cpp includes it once for each set of instructions.
//
// Sheared by the ray, points have a height along it and a column and a row beside it: it runs where both are zero.
// Floats tell which triangles it crosses and which way, but for those that it passes too closely to an edge, or that
// are as high as its origin: those are looked at in double.

#include "bakers/wide.inl"

struct WideInterval {
  Wide low, high;
};

/// Coordinates beside a ray's origin, its axis the first.
template <int kAlong>
struct RayFrame {
  static constexpr int kColumn = (kAlong + 1) % 3, kRow = (kAlong + 2) % 3;
  Wide3 origin;
  bool isBackwards;

  template <int kAxis>
  WIDE_INLINE static Wide at(const Wide3& v) {
    return kAxis == 0 ? v.x : kAxis == 1 ? v.y : v.z;
  }
  WIDE_INLINE Wide heightOf(const Wide3& offset) const {
    return isBackwards ? wide(0.0f) - at<kAlong>(offset) : at<kAlong>(offset);
  }
};

/// Boxes of a node that the ray may come through.
template <int kAlong>
WIDE_INLINE unsigned boxesOnRay(const RayFrame<kAlong>& ray, const HierarchyNode& node) {
  using Frame = RayFrame<kAlong>;
  const Wide3 low = minus(wide(node.min), ray.origin), high = minus(wide(node.max), ray.origin);
  const Wide zero = wide(0.0f), slack = wide(kRaySlack), columnShear = wide(kColumnShear), rowShear = wide(kRowShear);
  const Wide end = ray.heightOf(ray.isBackwards ? low : high);
  const Wide begin = most(ray.heightOf(ray.isBackwards ? high : low), zero);
  return bitsOf((end >= zero - slack) & (Frame::template at<Frame::kColumn>(low) - columnShear * end <= slack) &
                (Frame::template at<Frame::kColumn>(high) - columnShear * begin >= zero - slack) &
                (Frame::template at<Frame::kRow>(low) - rowShear * end <= slack) &
                (Frame::template at<Frame::kRow>(high) - rowShear * begin >= zero - slack));
}

struct WideSheared {
  Wide height, column, row;
};

/// Of the triangles of a leaf: by how much the crossings change the winding number, as far as floats can tell, and those
/// that they cannot tell of.
struct LeafCrossings {
  int turns;
  unsigned unclear;
};
template <int kAlong>
WIDE_INLINE LeafCrossings crossingsOf(const RayFrame<kAlong>& ray, const HierarchyLeaf& leaf) {
  using Frame = RayFrame<kAlong>;
  const auto shear = [&](const Wide3& offset) __attribute__((always_inline)) {
    const Wide height = ray.heightOf(offset);
    return WideSheared{height, Frame::template at<Frame::kColumn>(offset) - wide(kColumnShear) * height,
                       Frame::template at<Frame::kRow>(offset) - wide(kRowShear) * height};
  };
  const Wide3 alongAb = wide(leaf.alongAb), up = crossOf(wide(leaf.normal), alongAb);
  const Wide toB = wide(leaf.lengthAb), x = wide(leaf.lengthAc) * wide(leaf.acX),
             y = wide(leaf.lengthAc) * wide(leaf.acY);
  const Wide3 toA = minus(wide(leaf.a), ray.origin);
  const WideSheared a = shear(toA);
  const WideSheared b = shear({toA.x + toB * alongAb.x, toA.y + toB * alongAb.y, toA.z + toB * alongAb.z});
  const WideSheared c = shear({toA.x + x * alongAb.x + y * up.x, toA.y + x * alongAb.y + y * up.y,
                               toA.z + x * alongAb.z + y * up.z});
  const Wide zero = wide(0.0f), slack = wide(kRaySlack);
  const auto size = [&](const WideSheared& p) __attribute__((always_inline)) {
    return slack * (most(p.column, zero - p.column) + most(p.row, zero - p.row));
  };
  const Wide sizeA = size(a), sizeB = size(b), sizeC = size(c);
  WideMask areLeft = zero == zero, areRight = zero == zero, isAnyLeft = zero != zero, isAnyRight = zero != zero;
  const auto look = [&](const WideSheared& from, const WideSheared& to, Wide most) __attribute__((always_inline)) {
    const Wide cross = from.column * to.row - to.column * from.row;
    const WideMask isLeft = cross > most, isRight = cross < zero - most;
    areLeft &= isLeft, areRight &= isRight, isAnyLeft |= isLeft, isAnyRight |= isRight;
  };
  look(a, b, sizeA + sizeB), look(b, c, sizeB + sizeC), look(c, a, sizeC + sizeA);
  const WideMask areAhead = least(a.height, least(b.height, c.height)) > slack;
  const WideMask areBehind = most(a.height, most(b.height, c.height)) < zero - slack;
  const unsigned lanes = (1u << leaf.count()) - 1, ahead = bitsOf(areAhead), left = bitsOf(areLeft) & lanes,
                 right = bitsOf(areRight) & lanes;
  const unsigned isClear = bitsOf((isAnyLeft & isAnyRight) | areBehind | (areAhead & (areLeft | areRight)));
  return {std::popcount(left & ahead) - std::popcount(right & ahead), lanes & ~isClear};
}

template <int kAlong>
int crossingsAlong(const MeshHierarchy& hierarchy, const RayWinding::Ray& ray) {
  const RayFrame<kAlong> frame{wide(glm::vec3(ray.origin)), ray.isBackwards};
  std::array<std::uint32_t, 64 * kHierarchyWidth> stack;
  std::size_t size = 0;
  stack[size++] = hierarchy.root().bits;
  int turns = 0;
  while (size > 0) {
    const HierarchyChild top{stack[--size]};
    if (!top.isLeaf()) {
      const HierarchyNode& node = hierarchy.nodes()[top.index()];
      for (unsigned on = boxesOnRay(frame, node); on != 0; on &= on - 1)
        stack[size++] = node.children[static_cast<std::size_t>(std::countr_zero(on))].bits;
      continue;
    }
    const HierarchyLeaf& leaf = hierarchy.leaves()[top.index()];
    const LeafCrossings crossings = crossingsOf(frame, leaf);
    turns += crossings.turns;
    for (unsigned left = crossings.unclear; left != 0; left &= left - 1) {
      const std::uint32_t triangle = leaf.triangles[static_cast<std::size_t>(std::countr_zero(left))];
      turns += crossing(hierarchy.soup(), triangle, ray);
    }
  }
  return ray.isBackwards ? -turns : turns;
}

int crossings(const MeshHierarchy& hierarchy, const RayWinding::Ray& ray) {
  return ray.along == 0   ? crossingsAlong<0>(hierarchy, ray)
         : ray.along == 1 ? crossingsAlong<1>(hierarchy, ray)
                          : crossingsAlong<2>(hierarchy, ray);
}

#undef WIDE_INLINE
