#pragma once
#include <cstddef>

// The loops of vector_math.cpp, compiled once per instruction set.
#define DMISE_VECTOR_MATH_KERNELS(level)                          \
  namespace dmise::level {                                        \
  void exp_of(const double* x, std::size_t count, double* out);   \
  void log1p_of(const double* x, std::size_t count, double* out); \
  }
DMISE_VECTOR_MATH_KERNELS(sse2)
DMISE_VECTOR_MATH_KERNELS(avx2)
DMISE_VECTOR_MATH_KERNELS(avx512)
#undef DMISE_VECTOR_MATH_KERNELS
