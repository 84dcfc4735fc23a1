#include "bakers/simd_level.h"

#include <algorithm>
#include <atomic>

namespace brickfield {

namespace {

SimdLevel bestOfProcessor() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") ? SimdLevel::Avx2 : SimdLevel::Portable;
#else
  return SimdLevel::Portable;
#endif
}

std::atomic<SimdLevel>& limit() {
  static std::atomic<SimdLevel> most = bestOfProcessor();
  return most;
}

} // namespace

SimdLevel activeSimd() { return limit().load(std::memory_order_relaxed); }

void limitSimd(SimdLevel most) { limit() = std::min(most, bestOfProcessor()); }

} // namespace brickfield
