// Four floats at once, through the compiler's vector type: SSE on x86, NEON on ARM, and the same results on both.
// Structs of the hierarchy hold these members themselves, so that nothing is cast.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <glm/glm.hpp>

namespace brickfield {

using Float4 = float __attribute__((vector_size(16)));

/// A bit a lane that is set.
inline unsigned bitsOf(decltype(Float4{} < Float4{}) mask) {
#if defined(__SSE__)
  return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Float4>(mask)));
#else
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}

/// Eight lanes, one a child or a triangle.
struct Float8 {
  std::array<Float4, 2> halves{};
  float lane(std::size_t i) const { return halves[i / 4][i % 4]; }
  void setLane(std::size_t i, float value) { halves[i / 4][i % 4] = value; }
  void fill(float value) { halves = {Float4{value, value, value, value}, Float4{value, value, value, value}}; }
};

inline Float4 broadcast(float value) { return Float4{value, value, value, value}; }
inline Float4 minimum(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 maximum(Float4 a, Float4 b) { return a > b ? a : b; }
/// The least of some numbers, as many as a multiple of sixteen; several at once, which no compiler may do by itself.
///
/// of  what is made of four of them before
template <typename Of>
float leastOf(const float* numbers, std::size_t count, const Of& of) {
  std::array<Float4, 4> least;
  least.fill(broadcast(std::numeric_limits<float>::infinity()));
  for (std::size_t i = 0; i < count; i += 16)
    for (std::size_t k = 0; k < 4; ++k) {
      Float4 four;
      std::memcpy(&four, numbers + i + 4 * k, sizeof(four));
      least[k] = minimum(least[k], of(four));
    }
  const Float4 four = minimum(minimum(least[0], least[1]), minimum(least[2], least[3]));
  return std::min(std::min(four[0], four[1]), std::min(four[2], four[3]));
}
inline Float4 clampUnit(Float4 a) { return minimum(maximum(a, broadcast(0.0f)), broadcast(1.0f)); }

/// Three coordinates of four points.
struct Vector4 {
  Float4 x, y, z;
};
inline Vector4 operator-(const Vector4& a, const Vector4& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector4 operator*(Float4 s, const Vector4& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Float4 dot(const Vector4& a, const Vector4& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector4 cross(const Vector4& a, const Vector4& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector4 broadcast(glm::vec3 v) { return {broadcast(v.x), broadcast(v.y), broadcast(v.z)}; }

/// Three coordinates of eight points.
struct Vector8 {
  Float8 x, y, z;
  Vector4 half(std::size_t i) const { return {x.halves[i], y.halves[i], z.halves[i]}; }
  glm::vec3 lane(std::size_t i) const { return {x.lane(i), y.lane(i), z.lane(i)}; }
  void setLane(std::size_t i, glm::vec3 v) { x.setLane(i, v.x), y.setLane(i, v.y), z.setLane(i, v.z); }
};

} // namespace brickfield
