#include "core/base/numeric/vector_math.h"

#include "core/base/error.h"
#include "core/base/numeric/vector_math_kernels.h"

namespace dmise {
namespace {

void check(std::span<const double> x, std::span<double> out) {
  if (x.size() != out.size()) throw Error("vector math: numbers and results differ in number");
}

}  // namespace

void exp_of(std::span<const double> x, std::span<double> out, SimdLevel level) {
  check(x, out);
  kernel_of(level, sse2::exp_of, avx2::exp_of, avx512::exp_of)(x.data(), x.size(), out.data());
}

void log1p_of(std::span<const double> x, std::span<double> out, SimdLevel level) {
  check(x, out);
  kernel_of(level, sse2::log1p_of, avx2::log1p_of, avx512::log1p_of)(x.data(), x.size(),
                                                                     out.data());
}

}  // namespace dmise
