#include "core/optics/psf_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

// Fraction of a unit Gaussian at 0 between a and b.
double share(double a, double b, double sigma) {
  const double s = 1.0 / (sigma * std::sqrt(2.0));
  // On the side where erfc keeps its precision.
  if (a > 0) return 0.5 * (std::erfc(a * s) - std::erfc(b * s));
  if (b < 0) return 0.5 * (std::erfc(-b * s) - std::erfc(-a * s));
  return 0.5 * (std::erf(b * s) - std::erf(a * s));
}

}  // namespace

PsfTable make_psf_table(double sigma_px) {
  if (!(sigma_px >= 0.0 && sigma_px <= widest_sigma_px))
    throw Error("psf: width must be in 0..500 px");
  PsfTable t;
  t.sigma_px = std::max(sigma_px, narrowest_sigma_px);
  const int reach = int(std::ceil(5 * t.sigma_px + 0.5));
  t.first = 1 - reach;
  t.size = 2 * reach;
  t.stride = (t.size + 7) / 8 * 8;
  // Interpolation error: (1 / phases)^2 / 8 times the second derivative, below 0.25 / sigma^2.
  t.phases = int(std::bit_ceil(unsigned(std::clamp(600.0 / t.sigma_px, 64.0, 40000.0))));
  t.weights.assign(std::size_t(t.phases + 1) * std::size_t(t.stride), 0.0f);
  constexpr double far = 1e9;
  for (int p = 0; p <= t.phases; ++p) {
    const double c = double(p) / t.phases;
    double sum = 0.0, moment = 0.0;
    for (int i = 0; i < t.size; ++i) {
      const double left = i == 0 ? -far : t.first + i - 0.5 - c;
      const double right = i == t.size - 1 ? far : t.first + i + 0.5 - c;
      t.weights[std::size_t(p) * std::size_t(t.stride) + std::size_t(i)] =
          float(share(left, right, t.sigma_px));
      const double weight = t.weights[std::size_t(p) * std::size_t(t.stride) + std::size_t(i)];
      sum += weight;
      moment += weight * i;
    }
    t.whole.push_back({sum, moment});
  }
  return t;
}

double diffraction_sigma_px(const Optics& o, double wavelength_m) {
  constexpr double half_maximum = 0.5145;  // Airy: (2 J1(v)/v)^2 = 1/2 at v = 1.61634
  const double fwhm_rad = 2 * half_maximum * wavelength_m / o.aperture_m;
  return fwhm_rad / o.pixel_angle_rad() / fwhm_per_sigma;
}

double psf_sigma_px(const Optics& o, double wavelength_m) {
  return std::hypot(o.psf_fwhm_px / fwhm_per_sigma, diffraction_sigma_px(o, wavelength_m));
}

}  // namespace dmise
