#include "core/orbit/debris/debris_flux.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double year_s = 365.25 * 86400.0;
constexpr int places = 256;  // on a quarter of the spacecraft's orbit
constexpr int steps_of_degree = 8;

/// Circular orbits of two inclinations, averaged over where they meet.
double encounters(double a_rad, double b_rad) {
  const double sin_a = std::sin(a_rad), sin_b = std::sin(b_rad);
  const double cos_product = std::cos(a_rad) * std::cos(b_rad);
  const double inner = std::min(sin_a, sin_b), outer = std::max(sin_a, sin_b);
  double sum = 0.0;
  for (int k = 0; k < places; ++k) {
    const double x = inner * std::sin((k + 0.5) * pi / 2 / places);  // sine of the latitude
    const double cos2 = 1.0 - x * x;
    const double north = std::sqrt((sin_a - x) * (sin_a + x) * (sin_b - x) * (sin_b + x));
    const double along = cos_product / cos2, across = north / cos2;
    const double speed = 0.5 * (std::sqrt(std::max(0.0, 2.0 - 2.0 * (along + across))) +
                                std::sqrt(std::max(0.0, 2.0 - 2.0 * (along - across))));
    sum += speed / std::sqrt((outer - x) * (outer + x));
  }
  return 2.0 / pi * sum / places;
}

}  // namespace

double debris_flux_by_size(double diameter_m, double year) {
  const double d = 100.0 * diameter_m;  // the model's centimetres
  const double peak = (std::log10(d) - 0.78) / 0.637;
  const double h = std::pow(10.0, 0.5 * std::exp(-peak * peak));
  const double small = 1.22e-5 * std::pow(d, -2.5), large = 8.1e10 * std::pow(d + 700.0, -6.0);
  const double since = year - 1988.0;
  const double growth =
      year < 2011.0 ? std::pow(1.02, since) : std::pow(1.02, 23.0) * std::pow(1.04, since - 23.0);
  return h * (small * growth + large * (1.0 + 0.05 * since)) / year_s;
}

double debris_flux_by_height(double height_m, double solar_flux_sfu) {
  const double phi = std::pow(10.0, height_m / 200e3 - solar_flux_sfu / 140.0 - 1.5);
  return phi / (phi + 1.0);
}

double encounter_factor(const InclinationCounts& objects, double inclination_rad) {
  double sum = 0.0, count = 0.0;
  for (std::size_t degree = 0; degree < objects.size(); ++degree) {
    if (objects[degree] == 0) continue;
    double of_degree = 0.0;
    for (int k = 0; k < steps_of_degree; ++k)
      of_degree +=
          encounters((double(degree) + (k + 0.5) / steps_of_degree) * deg, inclination_rad);
    sum += objects[degree] * of_degree / steps_of_degree;
    count += objects[degree];
  }
  return sum / count;
}

}  // namespace dmise
