#include "core/detector/photon_noise.h"

#include <algorithm>
#include <cmath>

#include "core/detector/noise/detector_kernels.h"
#include "core/detector/noise/poisson.h"
#include "core/effects/plan_facts.h"

namespace dmise {

void PhotonNoise::apply(const ExposureFacts& exposed, Piece& piece) const {
  float* e = piece.electrons.data();
  const auto first = std::uint32_t(piece.first);
  if (!is_gaussian) {
    poisson(exposed.key, first, e, piece.electrons.size(), e, exposed.level);
    return;
  }
  const auto kernel = kernel_of(exposed.level, sse2::add_normal_of_light, avx2::add_normal_of_light,
                                avx512::add_normal_of_light);
  kernel(exposed.key, first, float(drawn_dark_e_per_s * exposed.exposure.exposure_s),
         float(drawn_read_noise_e * drawn_read_noise_e), e, piece.electrons.size());
  if (drawn_read_noise_e > 0.0) return;
  for (float& charge : piece.electrons) charge = std::max(charge, 0.0f);
}

ErrorBound PhotonNoise::error(int level, const PlanFacts& f) {
  if (level == 0) return {.noise = 1.0};
  const double read_e2 = f.read_noise_e * f.read_noise_e;
  // Skewness N / (N + r^2)^(3/2) of N electrons is largest at N = 2 r^2.
  const auto skewness = [&](double light_e) {
    const double n = std::max(std::max(light_e, 2.0 * read_e2), 1e-3);
    return n / std::pow(n + read_e2, 1.5);
  };
  double most = 0.0;
  for (const auto& s : f.sky) most = std::max(most, skewness(s.sky_e + f.dark_e));
  if (f.sees_horizon) most = std::max(most, skewness(f.dark_e));  // pixels that it cuts
  const double seen = 1.0 - std::min(1.0, f.hidden_sky_px);       // behind a dark object
  for (const auto& s : f.sky) most = std::max(most, skewness(seen * s.sky_e + f.dark_e));
  ErrorBound error{.noise = 4.0 / 9.0 * most};
  double min_e = f.sees_horizon ? f.dark_e : unbounded;
  for (const auto& s : f.sky) min_e = std::min(min_e, s.sky_e + f.dark_e);
  constexpr double never_negative_e = 16.0;
  if (min_e > never_negative_e || (read_e2 > 0.0 && !f.read_later)) return error;
  // Charge is held at 0: its mean rises by up to 0.102 e- and its variance falls by up to 0.27.
  error.background_sigma = 0.102 / std::sqrt(min_e + read_e2 + 1e-6);
  error.noise += 0.5 * 0.27 / (0.4 + read_e2);
  return error;
}

double PhotonNoise::cost_s(int level, const PlanFacts& f) {
  constexpr double gaussian_s = 3.2e-9, large_s = 3.6e-9, small_s = 9e-9, min_s = 2.6e-9,
                   dark_s = 1.5e-9, read_s = 2.3e-9;
  double light_e = unbounded;
  for (const auto& s : f.sky) light_e = std::min(light_e, s.sky_e);
  // Inversion below 24 electrons, by as many steps.
  const double poisson_s = light_e < 24.0 ? min_s + light_e / 24.0 * (small_s - min_s) : large_s;
  const double others_s = (f.dark_e > 0.0 ? dark_s : 0.0) + (f.read_noise_e > 0.0 ? read_s : 0.0);
  return f.pixels() * (level == 0          ? others_s
                       : level == gaussian ? gaussian_s
                                           : poisson_s + others_s);
}

}  // namespace dmise
