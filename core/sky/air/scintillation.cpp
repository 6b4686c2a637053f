#include "core/sky/air/scintillation.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/rng_at.h"
#include "core/base/numeric/table_place.h"
#include "core/base/numeric/vector_math.h"
#include "core/effects/plan_facts.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/kept_tables.h"

namespace dmise {
namespace {

constexpr double pattern_m_per_s = 20.0;  // shadows cross the aperture so fast

}  // namespace

ErrorBound MovingScintillation::error(int, const PlanFacts& f) {
  return f.dimmed_by(1.086 * 4.0 * f.scintillation);
}

double MovingScintillation::cost_s(int level, const PlanFacts& f) {
  return level * 60e-9 * (f.stars + double(f.objects));
}

ErrorBound Scintillation::error(int, const PlanFacts& f) {
  return f.dimmed_by(1.086 * 4.0 * f.scintillation);
}

double Scintillation::cost_s(int level, const PlanFacts& f) {
  return level * 181e-9 * (f.stars + double(f.objects));
}

double scintillation_sigma(double aperture_m, double exposure_s, double airmass,
                           double site_height_m) {
  if (!(aperture_m > 0)) throw Error("scintillation: aperture must be > 0");
  if (!(exposure_s >= 0)) throw Error("scintillation: exposure must be >= 0");
  constexpr double scale_height_m = 8000.0;
  const double exposure = std::max(exposure_s, aperture_m / pattern_m_per_s);
  return std::sqrt(10e-6 * std::pow(aperture_m, -4.0 / 3.0) / exposure * airmass * airmass *
                   airmass * std::exp(-2.0 * site_height_m / scale_height_m));
}

namespace {

// Rate x airmass of the nodes: even in its logarithm.
constexpr double min_rate = 1e-6, greatest_rate = 1.0;
constexpr int rates = 121;

}  // namespace

MotionAveraging::MotionAveraging(const BlownTurbulence& turbulence) {
  BlownTurbulence moving = turbulence;
  moving.wind.slew_rad_per_s = 0.0;
  const double still = scintillation_time_m_s(moving);
  for (int i = 0; i < rates; ++i) {
    moving.wind.slew_rad_per_s =
        min_rate * std::pow(greatest_rate / min_rate, double(i) / (rates - 1));
    log_ratio_.push_back(
        still > 0.0 ? std::min(0.0, std::log(scintillation_time_m_s(moving) / still)) : 0.0);
  }
}

double MotionAveraging::operator()(double rate_rad_per_s, double airmass) const {
  const double rate = rate_rad_per_s * airmass;
  if (!(rate > min_rate)) return 1.0;
  static const double per_node = (rates - 1) / std::log(greatest_rate / min_rate);
  const TablePlace at = table_place(std::log(rate / min_rate) * per_node, rates);
  return std::exp(std::lerp(log_ratio_[at.node], log_ratio_[at.node + 1], at.part));
}

Scintillation::Scintillation(const AirExposure& exposure)
    : key_(rng_key(exposure.seed, exposure.sensor, exposure.frame, facts.name)),
      up_(exposure.up),
      sigma_at_zenith_(scintillation_sigma(exposure.aperture_m, exposure.exposure_s, 1.0,
                                           exposure.site_height_m)),
      exposure_s_(exposure.exposure_s),
      shortest_s_(exposure.aperture_m / pattern_m_per_s) {
  if (!exposure.turbulence) return;
  static KeptTables<BlownTurbulence, MotionAveraging> tables;
  averaging_ =
      tables.of(*exposure.turbulence, [&] { return MotionAveraging(*exposure.turbulence); });
}

double Scintillation::sigma(double x, double rate_rad_per_s) const {
  // A longer exposure averages as much; a short one averages nothing however fast the source is.
  const double by_motion =
      averaging_ ? std::sqrt(std::max(exposure_s_, shortest_s_) /
                             std::max(exposure_s_ / (*averaging_)(rate_rad_per_s, x), shortest_s_))
                 : 1.0;
  return std::min(1.0, sigma_at_zenith_ * x * std::sqrt(x) * by_motion);
}

double Scintillation::apply(const SightLine& line) const {
  const double deviation = sigma(airmass_along(up_, line), line.rate_rad_per_s);
  const double log_variance = std::log1p(deviation * deviation);
  const double z =
      normal_of(rng_word(key_, line.number, line.source == SightLine::Source::star ? 0 : 1));
  return std::exp(std::sqrt(log_variance) * z - 0.5 * log_variance);
}

void Scintillation::apply(const SightLines& lines, std::span<double> factors) const {
  const std::size_t n = lines.size();
  std::vector<double> factor(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double deviation = sigma(lines.airmass[i], lines.rate_rad_per_s[i]);
    factor[i] = deviation * deviation;
  }
  log1p_of(factor, factor);
  std::vector<std::uint32_t> word(n);
  rng_words_at(key_, lines.number, 0, word);
  std::vector<float> z(n);
  normals_of(word.data(), n, z.data());
  for (std::size_t i = 0; i < n; ++i) factor[i] = std::sqrt(factor[i]) * z[i] - 0.5 * factor[i];
  exp_of(factor, factor);
  for (std::size_t i = 0; i < n; ++i) factors[i] *= factor[i];
}

}  // namespace dmise
