#include "core/base/numeric/simd_level.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace dmise {

#if defined(__x86_64__)
namespace {

SimdLevel find_level() {
  SimdLevel best = SimdLevel::sse2;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) best = SimdLevel::avx2;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    best = SimdLevel::avx512;
  const char* wish = std::getenv("DMISE_SIMD");
  for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2})
    if (wish && std::string_view(wish) == name(level)) best = std::min(best, level);
  return best;
}

}  // namespace

SimdLevel best_simd_level() {
  static const SimdLevel level = find_level();
  return level;
}

const char* name(SimdLevel level) {
  constexpr const char* names[] = {"sse2", "avx2", "avx512"};
  return names[static_cast<int>(level)];
}
#else
SimdLevel best_simd_level() { return SimdLevel::generic; }

const char* name(SimdLevel) { return "generic"; }
#endif

}  // namespace dmise
