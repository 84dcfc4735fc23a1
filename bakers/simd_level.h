// Which vector instructions the baker's inner loops use: chosen when the program runs, the same results from each.
#pragma once

namespace brickfield {

/// Portable: what every processor of the build has, SSE2 on x86. Avx512: vectors of eight floats all the same, but
/// twice the registers, and masks.
enum class SimdLevel { Portable, Avx2, Avx512 };

/// The best that this processor has and that limitSimd allows.
SimdLevel activeSimd();

/// For tests and measures: nothing above this is used from now on, in the whole process.
void limitSimd(SimdLevel most);

} // namespace brickfield
