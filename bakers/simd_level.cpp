#include "bakers/simd_level.h"

#include <algorithm>
#include <atomic>

namespace brickfield {

namespace {

SimdLevel bestOfProcessor() {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2")) return SimdLevel::Portable;
  const bool hasMasks = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  return hasMasks ? SimdLevel::Avx512 : SimdLevel::Avx2;
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
