#include "core/sky/air/extinction.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/error.h"
#include "core/base/numeric/vector_math.h"
#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/photometry/star_spectrum.h"
#include "core/sky/air/air_exposure.h"
#include "core/sky/air/colour_airmass.h"

namespace dmise {
namespace {

struct Sample {
  double wavelength_nm, mag_per_airmass;
};
#include "core/sky/air/extinction_tables.inc"

struct SiteExtinction {
  std::string_view name;
  std::span<const Sample> samples;
};
constexpr SiteExtinction sites[] = {{"lick", lick},           {"ctio", ctio},
                                    {"kitt_peak", kitt_peak}, {"la_palma", la_palma},
                                    {"mauna_kea", mauna_kea}, {"paranal", paranal}};

constexpr int bv_nodes = 49;  // every 0.05 of B-V, as spectra of stars are tabulated
constexpr int airmass_nodes = 33;
constexpr ColourAirmassNodes extinction_nodes{bv_nodes, airmass_nodes};
}  // namespace

std::optional<Curve> extinction_of_site(std::string_view name) {
  for (const SiteExtinction& site : sites) {
    if (site.name != name) continue;
    Curve curve;
    for (const Sample& sample : site.samples) {
      curve.add(sample.wavelength_nm * nm, sample.mag_per_airmass);
    }
    return curve;
  }
  return std::nullopt;
}

std::vector<std::string> extinction_site_names() {
  std::vector<std::string> names;
  for (const SiteExtinction& site : sites) names.emplace_back(site.name);
  return names;
}

Curve extinction_scaled_to(double k_v) {
  if (!(k_v >= 0 && k_v < 10))
    throw Error("extinction must be in [0, 10) mag/airmass, got " + std::to_string(k_v));
  Curve curve = *extinction_of_site("lick");
  const double scale = k_v / curve.at_or_end(550 * nm);
  for (double& k : curve.value) k *= scale;
  return curve;
}

Curve air_transmission(const Curve& extinction_mag_per_airmass, double airmass) {
  constexpr double step_m = 5 * nm;  // linear in k is not linear in the transmission
  const Curve& k = extinction_mag_per_airmass;
  Curve curve;
  const auto add = [&](double x) { curve.add(x, std::pow(10.0, -0.4 * k.at_or_end(x) * airmass)); };
  for (std::size_t i = 0; i < k.wavelength_m.size(); ++i) {
    const double from = k.wavelength_m[i];
    add(from);
    if (i + 1 == k.wavelength_m.size()) break;
    const double span = k.wavelength_m[i + 1] - from;
    const int pieces = std::max(1, int(std::ceil(span / step_m - 1e-9)));
    for (int p = 1; p < pieces; ++p) add(from + span * p / pieces);
  }
  return curve;
}

double zenith_extinction_mag(const Band& band, const Curve& extinction_mag_per_airmass) {
  const Band behind_air = through(band, air_transmission(extinction_mag_per_airmass, 1.0));
  return magnitude_of_light(photon_rate_per_m2(sunlight_spectrum(), behind_air) /
                            photon_rate_per_m2(sunlight_spectrum(), band));
}

BandExtinction::BandExtinction(const Band& band, const Curve& extinction_mag_per_airmass) {
  check_curve(extinction_mag_per_airmass, "extinction");
  // The band is narrow against the change of extinction: sums over even steps of wavelength.
  constexpr int steps = 128;
  const double step_m = (band.high_m() - band.low_m()) / steps;
  std::vector<double> response(steps), x_m(steps), photons(steps),
      transmission(steps * airmass_nodes);
  for (int s = 0; s < steps; ++s) {
    x_m[s] = band.low_m() + (s + 0.5) * step_m;
    response[s] = band.response.at_or_zero(x_m[s]);
    const double k = extinction_mag_per_airmass.at_or_end(x_m[s]);
    // Held above 0 in the thickest ultraviolet, so that the logarithm stays finite.
    for (int a = 0; a < airmass_nodes; ++a)
      transmission[a * steps + s] =
          std::max(light_of_magnitude(k * extinction_nodes.airmass(a)), 1e-30);
  }
  log_of_transmission_.reserve(bv_nodes * airmass_nodes);
  for (int c = 0; c < bv_nodes; ++c) {
    const StarSpectrum star = star_spectrum(extinction_nodes.bv(c));
    double above = 0.0;
    for (int s = 0; s < steps; ++s) above += photons[s] = response[s] * star.photons_at(x_m[s]);
    for (int a = 0; a < airmass_nodes; ++a) {
      double through = 0.0;
      for (int s = 0; s < steps; ++s) through += photons[s] * transmission[a * steps + s];
      log_of_transmission_.push_back(std::log(through / above));
    }
  }
}

double BandExtinction::log_of_star(double airmass, double bv) const {
  return extinction_nodes.between(extinction_nodes.place(airmass, bv), [&](int colour, int node) {
    return log_of_transmission_[std::size_t(colour * airmass_nodes + node)];
  });
}

double BandExtinction::of_star(double airmass, double bv) const {
  return std::exp(log_of_star(airmass, bv));
}

void BandExtinction::of_stars(std::span<const double> airmass, std::span<const double> bv,
                              std::span<double> share) const {
  for (std::size_t i = 0; i < share.size(); ++i) share[i] = log_of_star(airmass[i], bv[i]);
  exp_of(share, share);
}

double BandExtinction::of_sunlight(double airmass) const { return of_star(airmass, sun_bv); }

}  // namespace dmise
