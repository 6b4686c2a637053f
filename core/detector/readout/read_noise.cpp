#include "core/detector/readout/read_noise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detector/noise/detector_kernels.h"
#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound ReadNoise::error(int, const PlanFacts& f) {
  return {.noise = f.without_charge(f.read_noise_e * f.read_noise_e).noise};
}

std::span<const ParameterOf<ReadNoise>> ReadNoise::parameters() {
  static constexpr ParameterOf<ReadNoise> table[] = {
      {"read_noise_e", "", "[e-] rms", &ReadNoise::read_noise_e, 0.0, 1e6},
      {"read_noise_spread", "RNSPREAD", "deviation of the logarithm of the pixels' rms",
       &ReadNoise::read_noise_spread, 0.0, 2.0}};
  return table;
}

void ReadNoise::rms_of_pixels(const RngKey& fixed_key, std::size_t first,
                              std::span<float> rms_e) const {
  const double median_e = read_noise_e * std::exp(-read_noise_spread * read_noise_spread);
  rng_normals(fixed_key, std::uint32_t(first), 0, rms_e);
  for (float& e : rms_e) e = float(median_e * std::exp(read_noise_spread * double(e)));
}

void ReadNoise::apply(const ExposureFacts& exposed, Piece& piece) const {
  if (is_spread()) {
    std::array<float, 1024> rms_e, normals;
    const auto e = piece.electrons;
    for (std::size_t i = 0; i < e.size(); i += normals.size()) {
      const std::size_t n = std::min(normals.size(), e.size() - i), first = piece.first + i;
      rms_of_pixels(exposed.fixed_key, first, std::span(rms_e).first(n));
      rng_normals(exposed.key, std::uint32_t(first), 0, std::span(normals).first(n));
      for (std::size_t j = 0; j < n; ++j) e[i + j] += rms_e[j] * normals[j];
    }
    return;
  }
  const auto kernel =
      kernel_of(exposed.level, sse2::add_normal, avx2::add_normal, avx512::add_normal);
  kernel(exposed.key, std::uint32_t(piece.first), float(read_noise_e), piece.electrons.data(),
         piece.electrons.size());
}

}  // namespace dmise
