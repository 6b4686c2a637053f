#pragma once

namespace dmise {

/// Instruction sets that kernels are compiled for. Kernels of pixels give the same bytes on all of
/// them: they are the same operations, each rounded as IEEE 754 says, on more or fewer lanes. Those
/// of orbits take fused multiply-adds where there are any, and say how far apart they are.
enum class SimdLevel { sse2, avx2, avx512 };

/// The best that this processor runs (avx2: with FMA); `DMISE_SIMD=sse2|avx2|avx512` in the
/// environment lowers it.
SimdLevel best_simd_level();

const char* name(SimdLevel level);

}  // namespace dmise
