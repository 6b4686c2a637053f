#include "core/photometry/star_spectrum.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

#include "core/photometry/star_spectrum_table.inc"

constexpr double first_bv = -0.3, first_dwarf_bv = 0.95, step_bv = 0.05;  // B-V in the tables
constexpr double m_kelvin = 3500.0;  // black body that the factors of type M are for
using Factors = double[std::size(nodes_nm)];

double clamped(double bv) { return std::isnan(bv) ? min_bv : std::clamp(bv, min_bv, greatest_bv); }

}  // namespace

double colour_temperature_k(double bv) {
  const double used = clamped(bv);
  return 4600.0 * (1.0 / (0.92 * used + 1.7) + 1.0 / (0.92 * used + 0.62));
}

StarSpectrum star_spectrum(const StarColour& colour) {
  std::span<const Factors> table = factors_of_colour;
  double kelvin = colour_temperature_k(colour.bv);
  double at = (clamped(colour.bv) - first_bv) / step_bv;
  if (colour.kind == StarKind::red_dwarf) {
    const double bv = std::max(clamped(colour.bv), first_dwarf_bv);
    kelvin = colour_temperature_k(bv);
    table = factors_of_red_dwarf, at = (bv - first_dwarf_bv) / step_bv;
  } else if (colour.kind >= StarKind::m0_dwarf) {
    kelvin = m_kelvin;
    table = factors_of_m_dwarf, at = int(colour.kind) - int(StarKind::m0_dwarf);
  } else if (colour.kind >= StarKind::m0_giant) {
    kelvin = m_kelvin;
    table = factors_of_m_giant, at = int(colour.kind) - int(StarKind::m0_giant);
  }
  const auto [row, part] = table_place(at, table.size());
  StarSpectrum star{.kelvin = kelvin, .factors = {}};
  for (std::size_t i = 0; i < std::size(nodes_nm); ++i) {
    star.factors.add(nodes_nm[i] * nm, std::lerp(table[row][i], table[row + 1][i], part));
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
