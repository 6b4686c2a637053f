#include "core/orbit/debris/debris_population.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/formatted.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/frames/geodesy.h"
#include "core/orbit/sgp4/sgp4_terms.h"
#include "core/orbit/sgp4/walker.h"

namespace dmise {
namespace {

constexpr double ground_m = Ellipsoid{}.equatorial_radius_m;
constexpr double sgp4_gm_m3_per_s2 = sgp4::mu_km3_per_s2 * 1e9;
constexpr double height_step_m = 1e3;
constexpr int steps_per_decade = 128;

/// Objects in the shell for a flux by size of 1: the flux on a spacecraft is a quarter of their
/// density times their relative speed.
double count_of_unit_flux_m2_s(const DebrisPopulation& p) {
  const double encounters = encounter_factor(p.inclinations, spacecraft_inclination_deg * deg);
  const int steps = int(std::ceil((p.max_height_m - p.min_height_m) / height_step_m));
  const double step_m = (p.max_height_m - p.min_height_m) / steps;
  double count = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double height_m = p.min_height_m + (k + 0.5) * step_m, r = ground_m + height_m;
    const double flux =
        debris_flux_by_height(height_m, p.solar_flux_sfu) * spacecraft_inclination_factor;
    const double density_m3 = 4.0 * flux / (encounters * std::sqrt(sgp4_gm_m3_per_s2 / r));
    count += density_m3 * 4.0 * pi * r * r * step_m;
  }
  return p.scale * count;
}

/// Diameters by the flux of those that are larger.
class Sizes {
 public:
  explicit Sizes(const DebrisPopulation& p) : min_size_m_(p.min_size_m) {
    const double step = std::log(10.0) / steps_per_decade;
    for (int k = 0; log_size_.size() < 2 || log_size_.back() > std::log(p.min_size_m); ++k) {
      log_size_.push_back(std::log(p.max_size_m) - k * step);
      log_flux_.push_back(std::log(debris_flux_by_size(std::exp(log_size_.back()), p.year)));
    }
  }

  double flux_of_largest() const { return std::exp(log_flux_.front()); }

  double diameter_m(double flux) const {
    const double wanted = std::log(flux);
    const auto next = std::clamp<std::size_t>(
        std::size_t(std::ranges::lower_bound(log_flux_, wanted) - log_flux_.begin()), 1,
        log_flux_.size() - 1);
    const double part = (wanted - log_flux_[next - 1]) / (log_flux_[next] - log_flux_[next - 1]);
    return std::max(min_size_m_, std::exp(std::lerp(log_size_[next - 1], log_size_[next], part)));
  }

 private:
  double min_size_m_;
  std::vector<double> log_size_, log_flux_;
};

/// Density over height: that of the flux, over the speed, times the shell's area, r^2.5 of its
/// height factor. The power is drawn exactly, the factor by rejection.
double draw_axis_m(const DebrisPopulation& p, const RngKey& key, std::uint32_t k) {
  const double low = std::pow(ground_m + p.min_height_m, 3.5);
  const double high = std::pow(ground_m + p.max_height_m, 3.5);
  const double most = debris_flux_by_height(p.max_height_m, p.solar_flux_sfu);
  for (std::uint32_t draw = 4;; draw += 2) {
    const double axis_m =
        std::pow(std::lerp(low, high, uniform_of(rng_word(key, k, draw))), 1.0 / 3.5);
    const double factor = debris_flux_by_height(axis_m - ground_m, p.solar_flux_sfu);
    if (uniform_of(rng_word(key, k, draw + 1)) * most < factor) return axis_m;
  }
}

/// Uniform within a degree.
double inclination_rad(const InclinationCounts& objects, double uniform) {
  double left = uniform * std::accumulate(objects.begin(), objects.end(), 0.0);
  std::size_t degree = 0;
  while (degree + 1 < objects.size() && left >= objects[degree]) left -= objects[degree++];
  return (double(degree) + left / objects[degree]) * deg;
}

MeanElements draw_orbit(const DebrisPopulation& p, const RngKey& key, std::uint32_t k) {
  const auto uniform = [&](std::uint32_t draw) { return uniform_of(rng_word(key, k, draw)); };
  MeanElements e{.epoch_jd1 = p.epoch.jd1, .epoch_jd2 = p.epoch.jd2};
  e.inclination_rad = inclination_rad(p.inclinations, uniform(1));
  e.raan_rad = 2 * pi * uniform(2);
  e.mean_anomaly_rad = 2 * pi * uniform(3);
  e.mean_motion_rad_per_min =
      kozai_mean_motion_rad_per_min(draw_axis_m(p, key, k), e.inclination_rad);
  return e;
}

}  // namespace

double DebrisPopulation::mean_count() const {
  return count_of_unit_flux_m2_s(*this) *
         (debris_flux_by_size(min_size_m, year) - debris_flux_by_size(max_size_m, year));
}

int DebrisPopulation::numbers() const {
  const double mean = mean_count();
  return int(std::ceil(mean + 8.0 * std::sqrt(mean) + 16.0));
}

InclinationCounts inclinations_of(std::span<const MeanElements> elements, double min_height_m,
                                  double max_height_m) {
  InclinationCounts counts{};
  for (const MeanElements& e : elements) {
    const double axis_m =
        std::pow(sgp4::xke / e.mean_motion_rad_per_min, 2.0 / 3.0) * sgp4::earth_radius_m;
    if (axis_m < ground_m + min_height_m || axis_m > ground_m + max_height_m) continue;
    ++counts[std::min(std::size_t(e.inclination_rad / deg), counts.size() - 1)];
  }
  return counts;
}

DrawnDebris draw_debris(const DebrisPopulation& p, std::uint64_t scenario_seed) {
  const RngKey key = rng_key(p.seed.value_or(scenario_seed), p.name, 0, "population");
  const Sizes sizes(p);
  const double count_of_flux = count_of_unit_flux_m2_s(p), mean = p.mean_count();
  const int numbers = p.numbers(), digits = int(std::to_string(numbers).size());
  DrawnDebris drawn;
  double larger = 0.0;  // mean number of objects that are larger
  for (int k = 0; k < numbers; ++k) {
    larger -= std::log(uniform_of(rng_word(key, std::uint32_t(k), 0)));
    if (larger > mean) break;
    drawn.diameters_m.push_back(sizes.diameter_m(sizes.flux_of_largest() + larger / count_of_flux));
    drawn.elements.push_back(draw_orbit(p, key, std::uint32_t(k)));
    drawn.elements.back().catalogue_number = p.first_number + std::uint32_t(k);
    drawn.elements.back().name = p.name + formatted("-%0*d", digits, k + 1);
  }
  return drawn;
}

std::string describe(const DebrisPopulation& population, const DrawnDebris& drawn) {
  const auto& d = drawn.diameters_m;
  std::string text = population.name + ": " + counted(d.size(), "object");
  if (!d.empty())
    text += formatted(" of %.3g m to %.3g m (median %.3g m)", d.back(), d.front(), d[d.size() / 2]);
  return text + formatted(", %.4g by the flux", population.mean_count());
}

}  // namespace dmise
