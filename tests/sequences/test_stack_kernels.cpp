#include "core/sequences/stack_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/numeric/simd_level.h"

namespace dmise {
namespace {

constexpr std::size_t columns = 64, frames = 7;

struct Best {
  std::array<float, columns> snr2{};
  std::array<std::uint32_t, columns> rate{};
  bool operator==(const Best&) const = default;
};

Best best_by(decltype(&sse2::stack_rows) kernel) {
  std::mt19937 random(3);
  Best best;
  for (std::uint32_t rate = 0; rate < 20; ++rate) {
    std::vector<float> values(2 * frames * columns);
    for (float& v : values) v = float(random() % 2001) / 1000 - 1;
    std::vector<const float*> light, weight2;
    for (std::size_t i = 0; i < frames; ++i) {
      light.push_back(values.data() + i * columns);
      weight2.push_back(values.data() + (frames + i) * columns);
    }
    for (std::size_t i = frames * columns; i < values.size(); ++i) values[i] *= values[i];
    kernel({light.data(), weight2.data(), frames}, columns, rate,
           {best.snr2.data(), best.rate.data()});
    for (std::size_t x = 0; x < columns; ++x) {
      float sum = 0, sum2 = 0;
      for (std::size_t i = 0; i < frames; ++i) {
        sum += light[i][x];
        sum2 += weight2[i][x];
      }
      EXPECT_GE(best.snr2[x], sum > 0 ? sum * sum / sum2 * 0.99999F : 0);
    }
  }
  return best;
}

TEST(StackKernels, AreTheSameOnEveryInstructionSet) {
  const Best plain = best_by(sse2::stack_rows);
  if (best_simd_level() >= SimdLevel::avx2) {
    EXPECT_EQ(best_by(avx2::stack_rows), plain);
  }
  if (best_simd_level() >= SimdLevel::avx512) {
    EXPECT_EQ(best_by(avx512::stack_rows), plain);
  }
}

}  // namespace
}  // namespace dmise
