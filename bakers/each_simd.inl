// Compiles a file for each set of vector instructions (simd_level.h), in the namespaces portable, avx2 and avx512. No
// header: sources include it inside a namespace, with BRICKFIELD_SIMD_FILE naming the file in quotes, and call
//
//   BRICKFIELD_BEST_SIMD(sum(...))
//
// Elsewhere than on x86 all are the same.

namespace portable {
#include BRICKFIELD_SIMD_FILE
}
#if defined(__x86_64__)
#pragma GCC push_options
#pragma GCC target("avx2")
#define BRICKFIELD_AVX // g++ 12 lets the pragma define no macro
namespace avx2 {
#include BRICKFIELD_SIMD_FILE
}
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx2,avx512f,avx512vl,avx512dq,avx512bw")
namespace avx512 {
#include BRICKFIELD_SIMD_FILE
}
#undef BRICKFIELD_AVX
#pragma GCC pop_options
#else
namespace avx2 = portable;
namespace avx512 = portable;
#endif
#undef BRICKFIELD_SIMD_FILE

/// A call in the best of the namespaces that this processor has and that limitSimd allows.
#undef BRICKFIELD_BEST_SIMD
#define BRICKFIELD_BEST_SIMD(...)                           \
  (activeSimd() == SimdLevel::Avx512 ? avx512::__VA_ARGS__  \
   : activeSimd() == SimdLevel::Avx2 ? avx2::__VA_ARGS__    \
                                     : portable::__VA_ARGS__)
