#pragma once
#include "core/base/numeric/simd_sets.h"

namespace dmise {

/// Instruction sets that kernels are compiled for. Pixel kernels give the same bytes on all of
/// them: the same IEEE 754 operations on more or fewer lanes. Orbit kernels use fused multiply-adds
/// where available and state how much their results differ.
enum class SimdLevel {
#if defined(__x86_64__)
  sse2,
  avx2,
  avx512
#else
  generic,
  sse2 = generic,
  avx2 = generic,
  avx512 = generic
#endif
};

/// Returns the best level that this processor supports (avx2 includes FMA); on x86 the environment
/// variable `DMISE_SIMD=sse2|avx2|avx512` lowers it.
SimdLevel best_simd_level();

const char* name(SimdLevel level);

/// Returns the function for `level`: `kernel_of(level, sse2::f, avx2::f, avx512::f)`.
template <class Function>
Function* kernel_of(SimdLevel level, Function* sse2, Function* avx2, Function* avx512) {
  return level == SimdLevel::avx512 ? avx512 : level == SimdLevel::avx2 ? avx2 : sse2;
}

}  // namespace dmise
