// Compiles a file for each set of vector instructions (simd_level.h), in the namespaces portable and avx2. No header:
// sources include it inside a namespace, with BRICKFIELD_SIMD_FILE naming the file in quotes, and call
//
//   activeSimd() == SimdLevel::Avx2 ? avx2::sum(...) : portable::sum(...)
//
// Elsewhere than on x86 both are the same.

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
#undef BRICKFIELD_AVX
#pragma GCC pop_options
#else
namespace avx2 = portable;
#endif
#undef BRICKFIELD_SIMD_FILE
