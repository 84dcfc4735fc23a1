// Twin of shaders/lib/triangle_distance.glsl, operation by operation, in any precision.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace brickfield::test {

template <typename Float>
struct TriangleHit {
  Float squared;
  glm::vec<3, Float> closest;
  std::uint32_t feature; ///< 0 face, 1 to 3 corners, 4 to 6 edges
};

template <typename Float>
Float shareAlong(const glm::vec<3, Float>& edge, const glm::vec<3, Float>& fromStart) {
  return glm::clamp(glm::dot(edge, fromStart) / glm::max(glm::dot(edge, edge), Float(1e-37f)), Float(0), Float(1));
}

template <typename Float>
TriangleHit<Float> closestOnTriangle(const glm::vec<3, Float>& p, const glm::vec<3, Float>& a,
                                     const glm::vec<3, Float>& b, const glm::vec<3, Float>& c) {
  using Vector = glm::vec<3, Float>;
  const Vector edges[3] = {b - a, c - b, a - c};
  const Vector starts[3] = {p - a, p - b, p - c};
  TriangleHit<Float> hit{};
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Float share = shareAlong(edges[k], starts[k]);
    const Vector offset = starts[k] - share * edges[k];
    const Float squared = glm::dot(offset, offset);
    if (k > 0 && !(squared < hit.squared)) continue;
    hit = {squared, p - offset, share <= 0 ? 1 + k : share >= 1 ? 1 + (k + 1) % 3 : 4 + k};
  }
  const Vector ac = c - a, n = glm::cross(edges[0], ac);
  const Float n2 = glm::dot(n, n);
  const Float v = glm::dot(glm::cross(starts[0], ac), n), w = glm::dot(glm::cross(edges[0], starts[0]), n);
  if (!(glm::min(v, w) > 0 && v + w < n2 && n2 > Float(1e-12f) * glm::dot(edges[0], edges[0]) * glm::dot(ac, ac)))
    return hit;
  const Vector offset = starts[0] - (v / n2) * edges[0] - (w / n2) * ac;
  if (glm::dot(offset, offset) <= hit.squared) hit = {glm::dot(offset, offset), p - offset, 0};
  return hit;
}

} // namespace brickfield::test
