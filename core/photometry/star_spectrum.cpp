#include "core/photometry/star_spectrum.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/units.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

#include "core/photometry/star_spectrum_table.inc"

constexpr double first_bv = -0.3, step_bv = 0.05;  // of the table
constexpr int rows = int(std::size(factors_of_colour));

double clamped(double bv) {
  return std::isnan(bv) ? least_bv : std::clamp(bv, least_bv, greatest_bv);
}

}  // namespace

ColourTemperature colour_temperature(double bv) {
  const double used = clamped(bv);
  return {4600.0 * (1.0 / (0.92 * used + 1.7) + 1.0 / (0.92 * used + 0.62)), !(used == bv)};
}

StarSpectrum star_spectrum(double bv) {
  const double at = std::clamp((clamped(bv) - first_bv) / step_bv, 0.0, rows - 1.0);
  const int row = std::min(int(at), rows - 2);
  StarSpectrum star{.kelvin = colour_temperature(bv).kelvin, .factors = {}};
  for (std::size_t i = 0; i < std::size(nodes_nm); ++i) {
    star.factors.wavelength_m.push_back(nodes_nm[i] * nm);
    star.factors.value.push_back(
        std::lerp(factors_of_colour[row][i], factors_of_colour[row + 1][i], at - row));
  }
  return star;
}

double StarSpectrum::photons_at(double wavelength_m) const {
  return factors.at_or_end(wavelength_m) * black_body_photons_at(kelvin, wavelength_m);
}

double photon_rate(const StarSpectrum& star, const Band& band) {
  return black_body_photon_rate(star.kelvin, band, star.factors);
}

}  // namespace dmise
