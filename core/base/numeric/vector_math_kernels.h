#pragma once
#include <cstddef>

#include "core/base/numeric/simd_sets.h"

// The loops of vector_math.cpp, compiled once per instruction set.
#define DMISE_VECTOR_MATH_KERNELS(level)                          \
  namespace dmise::level {                                        \
  void exp_of(const double* x, std::size_t count, double* out);   \
  void log1p_of(const double* x, std::size_t count, double* out); \
  }
DMISE_EACH_SIMD_SET(DMISE_VECTOR_MATH_KERNELS)
#undef DMISE_VECTOR_MATH_KERNELS
