#pragma once
#include <cstddef>
#include <cstdint>

#include "core/base/numeric/rng.h"
#include "core/base/numeric/simd_level.h"

// Poisson deviates by inversion: the quantile function of one uniform number per pixel. A deviate
// increases monotonically with its mean, and every mean uses the same one number.
//
// mean < 24:  the distribution function summed upwards in double precision against 52 random bits.
// mean >= 24: N = floor(x) with Q(x, mean) = u for the regularised incomplete gamma function, by
//             its uniform expansion in s = w / sqrt(mean), w = normal quantile of u (Temme 1979,
//             SIAM J. Math. Anal. 10, 757; Giles 2016, ACM TOMS 42, 7): x = mean + sqrt(mean) w +
//             w^2 B(s) + C0(s) + C1(s) / mean with B, C0, C1 fitted as polynomials, in single
//             precision with 32 random bits. Against exact Poisson deviates, the non-centrality of
//             a chi-square over n draws is below 4e-11 n at 24 and decreases from there.
namespace dmise {

inline constexpr float poisson_switch_mean = 24.0f;
inline constexpr int poisson_most_steps = 128;  // terms of the sum upwards
inline constexpr float poisson_largest_mean = 1e12f;

/// out[i] = deviate of mean[i] for pixel first + i; in place when `out` is `mean`. Deviates are
/// whole numbers (above 2^24 rounded to single precision). Throws `Error` naming the pixel when a
/// mean is NaN, negative or above poisson_largest_mean.
void poisson(const RngKey& key, std::uint32_t first, const float* mean, std::size_t count,
             float* out, SimdLevel level = best_simd_level());

/// Adds to sum[i] the deviate that `poisson` gives for one and the same mean in every pixel,
/// faster.
class ConstantPoisson {
 public:
  /// Throws `Error` when the mean is NaN, negative or above poisson_largest_mean.
  explicit ConstantPoisson(float mean);
  void add(const RngKey& key, std::uint32_t first, float* sum, std::size_t count,
           SimdLevel level = best_simd_level()) const;

 private:
  float mean_;
  int steps_ = 0;                                 // 0: by the general method
  std::uint32_t thresholds_[poisson_most_steps];  // floor(2^32 P(N <= k))
};

}  // namespace dmise
