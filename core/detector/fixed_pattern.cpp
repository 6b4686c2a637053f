#include "core/detector/fixed_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/detector/detector_kernels.h"
#include "core/detector/poisson.h"

namespace dmise {

RngKey fixed_key(std::uint64_t seed, std::string_view sensor, std::string_view effect) {
  return rng_key(seed, sensor, 0, effect);
}

void response_non_uniformity(double rms, const RngKey& fixed, std::uint32_t first,
                             std::span<float> light_e, SimdLevel level) {
  const auto add_normal = kernel_of(level, sse2::add_normal, avx2::add_normal, avx512::add_normal);
  constexpr std::size_t piece = 1024;
  float response[piece];
  for (std::size_t i = 0; i < light_e.size(); i += piece) {
    const std::size_t n = std::min(piece, light_e.size() - i);
    std::fill_n(response, n, 1.0f);
    add_normal(fixed, first + std::uint32_t(i), float(rms), response, n);
    for (std::size_t j = 0; j < n; ++j) light_e[i + j] *= std::max(0.0f, response[j]);
  }
}

std::vector<HotPixel> hot_pixels(double fraction, double mean_e_per_s, std::size_t pixels,
                                 const RngKey& fixed) {
  std::vector<HotPixel> hot;
  // From one to the next: the distance is geometrically distributed.
  const double step = std::log1p(-std::min(fraction, 1.0 - 1e-9));
  if (!(step < 0.0)) return hot;
  double at = -1.0;
  for (std::uint32_t i = 0;; ++i) {
    at += 1.0 + std::floor(std::log(uniform_of(rng_word(fixed, i, 0))) / step);
    if (at >= double(pixels)) return hot;
    const double rate = -mean_e_per_s * std::log(uniform_of(rng_word(fixed, i, 1)));
    hot.push_back({std::uint32_t(at), float(rate)});
  }
}

void add_hot_pixels(std::span<const HotPixel> hot, double exposure_s, const RngKey& key,
                    std::uint32_t first, std::span<float> electrons) {
  auto it = std::lower_bound(hot.begin(), hot.end(), first,
                             [](const HotPixel& h, std::uint32_t p) { return h.pixel < p; });
  for (; it != hot.end() && it->pixel - first < electrons.size(); ++it) {
    const auto mean = float(it->dark_e_per_s * exposure_s);
    float deviate;
    poisson(key, it->pixel, &mean, 1, &deviate);
    electrons[it->pixel - first] += deviate;
  }
}

}  // namespace dmise
