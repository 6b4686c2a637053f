#include "core/detector/noise/poisson.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/detector/noise/detector_kernels.h"

namespace dmise {
namespace {

bool is_mean(float m) { return m >= 0.0f && m <= poisson_largest_mean; }

[[noreturn]] void refuse(std::uint32_t pixel, float mean) {
  throw Error("poisson: pixel " + std::to_string(pixel) +
              ": expected electrons must be in 0..1e12, got " + std::to_string(mean));
}

}  // namespace

void poisson(const RngKey& key, std::uint32_t first, const float* mean, std::size_t count,
             float* out, SimdLevel level) {
  const auto kernel = kernel_of(level, sse2::poisson, avx2::poisson, avx512::poisson);
  const auto run = [&](std::uint32_t at, const float* means, std::size_t n, float* deviates) {
    const std::size_t done = kernel(key, at, means, n, deviates);
    if (done == n) return;
    const float* bad = std::find_if_not(means + done, means + n, is_mean);
    refuse(at + std::uint32_t(bad - means), *bad);
  };
  // Pixels before the first whole group: computed as the end of a group.
  const std::size_t skipped = first % rng_group;
  const std::size_t head = skipped ? std::min<std::size_t>(count, rng_group - skipped) : 0;
  if (head) {
    float means[rng_group] = {}, deviates[rng_group];
    std::copy_n(mean, head, means + skipped);
    run(first - std::uint32_t(skipped), means, rng_group, deviates);
    std::copy_n(deviates + skipped, head, out);
  }
  run(first + std::uint32_t(head), mean + head, count - head, out + head);
}

ConstantPoisson::ConstantPoisson(float mean) : mean_(mean) {
  if (!is_mean(mean)) refuse(0, mean);
  if (!(mean < poisson_switch_mean)) return;
  double cumulative[poisson_most_steps];
  steps_ = sse2::poisson_cumulative(mean, cumulative);
  for (int k = 0; k < steps_; ++k)
    thresholds_[k] = std::uint32_t(std::min(std::floor(cumulative[k] * 0x1p32), 0x1p32 - 1));
}

void ConstantPoisson::add(const RngKey& key, std::uint32_t first, float* sum, std::size_t count,
                          SimdLevel level) const {
  const auto exceeded =
      kernel_of(level, sse2::add_exceeded, avx2::add_exceeded, avx512::add_exceeded);
  constexpr std::size_t piece = 1024;
  float means[piece], deviates[piece];
  std::fill_n(means, piece, mean_);
  for (std::size_t i = 0; i < count;) {
    const std::uint32_t at = first + std::uint32_t(i);
    const std::size_t n = std::min(count - i, piece - at % piece);
    bool whole = steps_ > 0 && at % rng_group == 0;
    if (whole) {
      std::fill_n(deviates, n, 0.0f);
      // If the 32 bits equal a threshold (probability 2^-32 per threshold), the general method
      // decides.
      whole = !exceeded(key, at, thresholds_, steps_, deviates, n);
    }
    if (!whole) poisson(key, at, means, n, deviates, level);
    for (std::size_t j = 0; j < n; ++j) sum[i + j] += deviates[j];
    i += n;
  }
}

}  // namespace dmise
