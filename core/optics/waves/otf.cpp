#include "core/optics/waves/otf.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// Overlap of two unit-diameter discs whose centres are x diameters apart, as a fraction of one.
double disc_overlap(double x) {
  if (x >= 1.0) return 0.0;
  return 2 / pi * (std::acos(x) - x * std::sqrt(1 - x * x));
}

// Overlap of discs of diameters 1 and e, x apart, in units of the larger one's area.
double unequal_overlap(double x, double e) {
  if (x >= 0.5 * (1 + e)) return 0.0;
  if (x <= 0.5 * (1 - e)) return e * e;
  const double c = std::clamp((1 + e * e - 4 * x * x) / (2 * e), -1.0, 1.0);
  const double phi = std::acos(c);
  const double half = std::tan(0.5 * phi) * (1 + e) / (1 - e);
  return e * e - (e * std::sin(phi) + 0.5 * (1 + e * e) * phi - (1 - e * e) * std::atan(half)) / pi;
}

}  // namespace

double diffraction_otf(double nu, double wavelength_m, double aperture_m, double obscuration) {
  if (nu == 0.0 || wavelength_m == 0.0) return 1.0;
  const double x = std::abs(nu) * wavelength_m / aperture_m, e = obscuration;
  if (!(x < 1.0)) return 0.0;
  if (e <= 0.0) return disc_overlap(x);
  const double overlap = disc_overlap(x) + e * e * disc_overlap(x / e) - 2 * unequal_overlap(x, e);
  return std::clamp(overlap / (1 - e * e), 0.0, 1.0);
}

double long_exposure_otf(double nu, double wavelength_m, double r0_m) {
  return std::exp(-3.44 * std::pow(std::abs(nu) * wavelength_m / r0_m, 5.0 / 3.0));
}

double pixel_otf(double nu, double pixel_rad) {
  const double x = pi * nu * pixel_rad;
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6 : std::sin(x) / x;
}

double jitter_otf(double nu, double sigma_rad) {
  const double x = 2 * pi * nu * sigma_rad;
  return std::exp(-0.5 * x * x);
}

double defocus_otf(double nu, double disc_rad) {
  const double x = std::abs(pi * nu * disc_rad);
  return x < 1e-4 ? 1.0 - x * x / 8 : 2 * j1(x) / x;
}

double optical_otf(const Blur& b, double nu) {
  const double diffraction = diffraction_otf(nu, b.wavelength_m, b.aperture_m, b.obscuration);
  if (diffraction == 0.0) return 0.0;
  return diffraction * long_exposure_otf(nu, b.wavelength_m, b.r0_m) *
         jitter_otf(nu, b.jitter_rad) * defocus_otf(nu, b.defocus_disc_rad);
}

}  // namespace dmise
