#pragma once

namespace dmise {

/// Instruction sets that kernels are compiled for. All give the same bytes: they are the same
/// operations, each rounded as IEEE 754 says, on more or fewer lanes.
enum class SimdLevel { sse2, avx2, avx512 };

/// The best that this processor runs; `DMISE_SIMD=sse2|avx2|avx512` in the environment lowers it.
SimdLevel best_simd_level();

const char* name(SimdLevel level);

}  // namespace dmise
