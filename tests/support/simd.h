#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/numeric/simd_level.h"

namespace dmise::test {

/// Instruction sets that this machine has: on other machines than x86 one.
inline std::vector<SimdLevel> simd_here() {
  std::vector<SimdLevel> sets;
  for (SimdLevel s : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512})
    if (s <= best_simd_level() && (sets.empty() || s != sets.back())) sets.push_back(s);
  return sets;
}
inline std::string simd_name(const testing::TestParamInfo<SimdLevel>& info) {
  return std::string(name(info.param));
}

}  // namespace dmise::test
