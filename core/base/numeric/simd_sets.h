#pragma once

// Instruction sets that kernels are compiled for (cmake/Simd.cmake), each in a namespace of its
// name. DMISE_EACH_SIMD_SET(DECLARE) is DECLARE(set) for each of them.
#if defined(__x86_64__)
#define DMISE_EACH_SIMD_SET(declare) declare(sse2) declare(avx2) declare(avx512)
#else
// Kernels are compiled once, from the compiler's portable vectors, which all levels name.
#define DMISE_EACH_SIMD_SET(declare) declare(generic)
namespace dmise {
namespace generic {}
namespace sse2 = generic;
namespace avx2 = generic;
namespace avx512 = generic;
}  // namespace dmise
#endif
