#include "core/detection/pixels/filter_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/detection/pixels/filtered_frame.h"
#include "tests/detection/filtered_step.h"

namespace dmise {
namespace {

constexpr std::size_t count = 1003;  // no whole number of lanes

struct Level {
  decltype(&sse2::steps_of) steps_of;
  decltype(&sse2::flatten_steps) flatten_steps;
};

std::vector<Level> levels() {
  std::vector<Level> out{{sse2::steps_of, sse2::flatten_steps}};
  if (best_simd_level() >= SimdLevel::avx2) out.push_back({avx2::steps_of, avx2::flatten_steps});
  if (best_simd_level() >= SimdLevel::avx512)
    out.push_back({avx512::steps_of, avx512::flatten_steps});
  return out;
}

TEST(FilterKernels, GiveTheStepsOfTheFrameOnEveryInstructionSet) {
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal;
  std::vector<float> value, noise;
  for (std::size_t i = 0; i < count; ++i) {
    value.push_back(i % 7 == 0 ? 0.0f : 4 * normal(random));
    noise.push_back(0.5f + std::abs(normal(random)));
  }
  for (const bool odd : {false, true})
    for (const Level& level : levels()) {
      std::vector<std::int8_t> steps(count);
      level.steps_of(value.data(), noise.data(), 0.7f, count, odd, steps.data());
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(steps[i],
                  test::step_of(value[i] / (0.7f * noise[i]), (i + (odd ? 1 : 0)) % 2 != 0))
            << i;
    }
}

TEST(FilterKernels, FlattenWhatIsNotHiddenAlikeOnEveryInstructionSet) {
  std::mt19937_64 random(2);
  std::vector<std::int8_t> steps;
  for (std::size_t i = 0; i < count; ++i) steps.push_back(std::int8_t(int(random() % 63) - 31));
  const float middle[2] = {2.0f, 0.003f}, scale[2] = {0.8f, 0.0002f};
  std::vector<std::int8_t> first;
  for (const Level& level : levels()) {
    std::vector<std::int8_t> flat = steps;
    level.flatten_steps(flat.data(), count, true, 0, middle, scale);
    if (first.empty()) first = flat;
    EXPECT_EQ(flat, first);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double at = double(i);
    const double exact = (steps[i] - (2.0 + 0.003 * at)) * (0.8 + 0.0002 * at);
    if (steps[i] == 0)
      EXPECT_EQ(first[i], 0) << i;
    else
      EXPECT_NEAR(first[i], std::clamp(exact, -31.0, 31.0), 2.001) << i;
  }
}

// Whole steps less a third of one round back to themselves, but not on average.
TEST(FilterKernels, FlattenByLessThanAStepOnAverage) {
  std::mt19937_64 random(3);
  std::normal_distribution<float> normal;
  std::vector<std::int8_t> steps;
  for (int i = 0; i < 20000; ++i) {
    const int step = int(std::lround(5 * normal(random)));
    steps.push_back(std::int8_t(step != 0 ? step : i % 2 == 0 ? 1 : -1));
  }
  const float middle[2] = {-0.3f, 0.0f}, scale[2] = {1.0f, 0.0f};
  for (const Level& level : levels()) {
    std::vector<std::int8_t> flat = steps;
    level.flatten_steps(flat.data(), flat.size(), false, 12345, middle, scale);
    double moved = 0.0;
    for (std::size_t i = 0; i < flat.size(); ++i) moved += double(flat[i] - steps[i]);
    EXPECT_NEAR(moved / double(flat.size()), 0.3, 0.03);
  }
}

}  // namespace
}  // namespace dmise
