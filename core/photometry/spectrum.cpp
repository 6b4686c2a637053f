#include "core/photometry/spectrum.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

struct SpectrumSample {
  double wavelength_nm, value;
};
#include "core/photometry/reference_spectra_tables.inc"

Spectrum from_samples(std::span<const SpectrumSample> samples, double unit_w_per_m2_m) {
  Spectrum spectrum;
  for (const SpectrumSample& sample : samples) {
    spectrum.irradiance.add(sample.wavelength_nm * nm, sample.value * unit_w_per_m2_m);
  }
  return spectrum;
}

/// Integral of response(x) f(x) over the band by Simpson's rule between `at` (the band's knots and
/// those of f, ascending): exact where f is linear times x.
template <class F>
double integrate(const Band& band, const std::vector<double>& at, F&& f) {
  double sum = 0.0;
  for (std::size_t i = 1; i < at.size(); ++i) {
    const double a = at[i - 1], b = at[i], m = 0.5 * (a + b);
    const auto g = [&](double x) { return band.response.at_or_zero(x) * f(x); };
    sum += (b - a) / 6 * (g(a) + 4 * g(m) + g(b));
  }
  return sum;
}

}  // namespace

const Spectrum& solar_spectrum() {
  static const Spectrum spectrum = from_samples(sun_samples, 1e6);
  return spectrum;
}

const Spectrum& sunlight_spectrum() {
  static const Spectrum spectrum = [] {
    constexpr double kelvin = 5050.0, last_m = 100 * um, step = 1.01;
    constexpr double scale_m = planck_j_s * speed_of_light_m_per_s / (boltzmann_j_per_k * kelvin);
    const auto black_body = [](double x) {
      return 1.0 / (std::pow(x, 5) * std::expm1(scale_m / x));
    };
    Spectrum sun = solar_spectrum();
    Curve& curve = sun.irradiance;
    const double from_m = curve.wavelength_m.back();
    const double scale = curve.value.back() / black_body(from_m);
    for (double x = from_m * step; curve.wavelength_m.back() < last_m; x *= step) {
      curve.wavelength_m.push_back(std::min(x, last_m));
      curve.value.push_back(scale * black_body(curve.wavelength_m.back()));
    }
    return sun;
  }();
  return spectrum;
}

const Spectrum& vega_spectrum() {
  static const Spectrum spectrum = from_samples(vega_samples, 1e-9 * 1e6);
  return spectrum;
}

double photon_rate_per_m2(const Spectrum& spectrum, const Band& band) {
  check_band(band);
  const std::vector<double>& samples = spectrum.irradiance.wavelength_m;
  if (samples.size() < 2) throw Error("a spectrum needs two samples or more");
  if (band.low_m() < samples.front() || band.high_m() > samples.back())
    throw Error("band " + band.name + ": reaches beyond the spectrum of the source, " +
                std::to_string(samples.front() / um) + " to " +
                std::to_string(samples.back() / um) + " um");
  const double energy = integrate(band, knots(band, spectrum.irradiance),
                                  [&](double x) { return spectrum.irradiance.at_or_zero(x) * x; });
  return energy / (planck_j_s * speed_of_light_m_per_s);
}

double black_body_photon_rate(double temperature_k, const Band& band, const Curve& factors) {
  const std::vector<double> coarse = knots(band, factors);
  std::vector<double> at{coarse[0]};
  for (std::size_t i = 1; i < coarse.size(); ++i) {
    const double a = coarse[i - 1], b = coarse[i];
    const int pieces = std::max(1, int(std::ceil((b - a) / (10 * nm) - 1e-9)));
    for (int k = 1; k <= pieces; ++k) at.push_back(k == pieces ? b : a + (b - a) * k / pieces);
  }
  return integrate(band, at, [&](double x) {
    return factors.at_or_end(x) * black_body_photons_at(temperature_k, x);
  });
}

double black_body_photons_at(double temperature_k, double wavelength_m) {
  constexpr double scale_m_k = planck_j_s * speed_of_light_m_per_s / boltzmann_j_per_k;
  const double x_um = wavelength_m / um;  // near 1
  return 1.0 / (x_um * x_um * x_um * x_um * std::expm1(scale_m_k / (temperature_k * wavelength_m)));
}

}  // namespace dmise
