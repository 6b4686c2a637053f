#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/orbit/sgp4_batch.h"

namespace dmise::test {

/// Instruction sets that this machine has.
inline std::vector<Simd> simd_here() {
  std::vector<Simd> sets;
  for (Simd s : {Simd::sse2, Simd::avx2, Simd::avx512})
    if (s <= best_simd()) sets.push_back(s);
  return sets;
}
inline std::string simd_name(const testing::TestParamInfo<Simd>& info) {
  return std::string(name(info.param));
}

}  // namespace dmise::test
