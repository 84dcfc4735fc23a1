// Eight floats at once. No header: it is included inside a namespace, once for each set of instructions, by sources that
// compile the same walk for several (closest_walk.inl). Operations are single and rounded, so all sets give the same.

#define WIDE_INLINE [[gnu::always_inline]] inline

using Wide = float __attribute__((vector_size(32)));
using WideMask = std::int32_t __attribute__((vector_size(32)));

WIDE_INLINE Wide wide(float v) { return Wide{v, v, v, v, v, v, v, v}; }
WIDE_INLINE Wide wide(const Float8& lanes) {
  Wide result;
  std::memcpy(&result, &lanes, sizeof(result));
  return result;
}
WIDE_INLINE Wide wide(const std::array<float, 8>& lanes) {
  Wide result;
  std::memcpy(&result, lanes.data(), sizeof(result));
  return result;
}
WIDE_INLINE Wide least(Wide a, Wide b) {
#if defined(BRICKFIELD_AVX)
  return __builtin_ia32_minps256(a, b); // the same as below, which the compiler does not always see
#else
  return a < b ? a : b;
#endif
}
WIDE_INLINE Wide most(Wide a, Wide b) {
#if defined(BRICKFIELD_AVX)
  return __builtin_ia32_maxps256(a, b);
#else
  return a > b ? a : b;
#endif
}

struct Wide3 {
  Wide x, y, z;
};
WIDE_INLINE Wide3 wide(const Vector8& v) { return {wide(v.x), wide(v.y), wide(v.z)}; }
WIDE_INLINE Wide3 wide(glm::vec3 v) { return {wide(v.x), wide(v.y), wide(v.z)}; }
WIDE_INLINE Wide3 minus(const Wide3& a, const Wide3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
WIDE_INLINE Wide dotOf(const Wide3& a, const Wide3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
WIDE_INLINE Wide3 crossOf(const Wide3& a, const Wide3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

WIDE_INLINE Wide rootOf(Wide v) {
#if defined(BRICKFIELD_AVX)
  return __builtin_ia32_sqrtps256(v);
#else
  float lanes[8];
  std::memcpy(lanes, &v, sizeof(lanes));
  for (float& lane : lanes) lane = std::sqrt(lane);
  std::memcpy(&v, lanes, sizeof(lanes));
  return v;
#endif
}

/// A bit a lane that is set.
WIDE_INLINE unsigned bitsOf(WideMask mask) {
#if defined(BRICKFIELD_AVX)
  return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<Wide>(mask)));
#elif defined(__SSE__)
  Float4 halves[2];
  std::memcpy(halves, &mask, sizeof(halves));
  return static_cast<unsigned>(__builtin_ia32_movmskps(halves[0]) | __builtin_ia32_movmskps(halves[1]) << 4);
#else
  unsigned bits = 0;
  for (unsigned i = 0; i < 8; ++i) bits |= mask[i] < 0 ? 1u << i : 0u;
  return bits;
#endif
}
