// The sum of solid angles over a hierarchy. No header: winding_number.cpp includes it once for each set of instructions.

#include "bakers/wide.inl"

/// The angle of (x, y), to 3e-7: the arc tangent by Abramowitz and Stegun, Handbook of Mathematical Functions, 1964,
/// 4.4.49.
WIDE_INLINE Wide angleOf(Wide y, Wide x) {
  const Wide zero = wide(0.0f), absX = most(x, zero - x), absY = most(y, zero - y);
  const Wide a = least(absX, absY) / most(most(absX, absY), wide(1e-37f)), s = a * a;
  Wide series = wide(0.0028662257f);
  for (const float coefficient : {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f, -0.1420889944f,
                                  0.1999355085f, -0.3333314528f, 1.0f})
    series = series * s + wide(coefficient);
  Wide angle = a * series;
  angle = absY > absX ? wide(1.57079633f) - angle : angle;
  angle = x < zero ? wide(3.14159265f) - angle : angle;
  return y < zero ? zero - angle : angle;
}

/// Half the solid angles of eight triangles.
WIDE_INLINE Wide halfSolidAngles(const HierarchyLeaf& leaf, const Wide3& p) {
  const Wide3 alongAb = wide(leaf.alongAb), normal = wide(leaf.normal), up = crossOf(normal, alongAb);
  const Wide lengthAb = wide(leaf.lengthAb), x = wide(leaf.lengthAc) * wide(leaf.acX),
             y = wide(leaf.lengthAc) * wide(leaf.acY);
  const Wide3 a = minus(wide(leaf.a), p);
  const Wide3 b{a.x + lengthAb * alongAb.x, a.y + lengthAb * alongAb.y, a.z + lengthAb * alongAb.z};
  const Wide3 c{a.x + x * alongAb.x + y * up.x, a.y + x * alongAb.y + y * up.y, a.z + x * alongAb.z + y * up.z};
  const Wide lengthA = rootOf(dotOf(a, a)), lengthB = rootOf(dotOf(b, b)), lengthC = rootOf(dotOf(c, c));
  // The triple product a.(b x c) as height times area: close to the plane it keeps its sign that way.
  const Wide numerator = dotOf(a, normal) * (lengthAb * y);
  const Wide denominator =
      lengthA * lengthB * lengthC + dotOf(a, b) * lengthC + dotOf(b, c) * lengthA + dotOf(c, a) * lengthB;
  return angleOf(numerator, denominator);
}

WIDE_INLINE Wide farSolidAngles(const WindingMoments& moments, const Wide3& r, Wide rSquared) {
  const Wide3 spread = wide(moments.spread), shear = wide(moments.shear);
  const Wide xx = r.x * r.x, yy = r.y * r.y, zz = r.z * r.z;
  const Wide quadratic = dotOf(spread, {xx, yy, zz}) + dotOf(shear, {r.x * r.y, r.y * r.z, r.z * r.x});
  const auto c = [&](std::size_t i) __attribute__((always_inline)) { return wide(moments.cubics[i]); };
  // In the order of kMonomials.
  const Wide cubic = r.x * (c(0) * xx + c(3) * yy + c(5) * zz + r.y * (c(1) * r.x + c(4) * r.z) + c(2) * r.x * r.z) +
                     r.y * (c(6) * yy + c(8) * zz + c(7) * r.y * r.z) + c(9) * zz * r.z;
  const Wide oneOverRSquared = wide(1.0f) / rSquared, oneOverR = rootOf(oneOverRSquared);
  const Wide third = wide(7.5f) * cubic * oneOverRSquared - wide(1.5f) * dotOf(wide(moments.cubicTrace), r);
  const Wide second = spread.x + spread.y + spread.z + (third - wide(3.0f) * quadratic) * oneOverRSquared;
  return (dotOf(wide(moments.areaNormal), r) + second) * (oneOverRSquared * oneOverR);
}

/// Sum of the lanes whose bits are set, in their order.
WIDE_INLINE double sumOf(Wide values, unsigned bits) {
  float lanes[8];
  std::memcpy(lanes, &values, sizeof(lanes));
  double sum = 0;
  for (; bits != 0; bits &= bits - 1) sum += static_cast<double>(lanes[std::countr_zero(bits)]);
  return sum;
}

double solidAngle(const MeshHierarchy& hierarchy, const WindingMoments* moments, glm::vec3 point, float farRadii) {
  const Wide3 p = wide(point);
  const Wide nearness = wide(farRadii * farRadii);
  std::array<std::uint32_t, 64 * kHierarchyWidth> stack;
  std::size_t size = 0;
  stack[size++] = hierarchy.root().bits;
  double sum = 0;
  while (size > 0) {
    const HierarchyChild top{stack[--size]};
    if (top.isLeaf()) {
      const HierarchyLeaf& leaf = hierarchy.leaves()[top.index()];
      sum += 2.0 * sumOf(halfSolidAngles(leaf, p), (1u << leaf.count()) - 1);
      continue;
    }
    const WindingMoments& node = moments[top.index()];
    const Wide3 r = minus(wide(node.center), p);
    const Wide rSquared = dotOf(r, r);
    const unsigned far = bitsOf(rSquared > nearness * wide(node.radiusSquared));
    if (far != 0) sum += sumOf(farSolidAngles(node, r, rSquared), far);
    const HierarchyNode& children = hierarchy.nodes()[top.index()];
    for (unsigned near = ~far & 0xffu; near != 0; near &= near - 1) {
      const HierarchyChild child = children.children[static_cast<std::size_t>(std::countr_zero(near))];
      if (!child.isNone()) stack[size++] = child.bits;
    }
  }
  return sum;
}

#undef WIDE_INLINE
