#include "core/discrimination/aperture_fraction.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/psf_plan.h"
#include "core/optics/psf_table.h"
#include "core/optics/waves/otf.h"

namespace dmise {
namespace {

/// Mean over all directions of the squared transfer function of a pixel at `nu` cycles per pixel:
/// one for the light's integration over pixels, one for that of the circle over them.
double pixels_squared(double nu_per_px) {
  constexpr int directions = 24;  // over an eighth of the circle
  double sum = 0.0;
  for (int i = 0; i < directions; ++i) {
    const double angle = 0.25 * pi * (i + 0.5) / directions;
    const double along = pixel_otf(nu_per_px * std::cos(angle), 1.0);
    const double across = pixel_otf(nu_per_px * std::sin(angle), 1.0);
    sum += along * along * across * across;
  }
  return sum / directions;
}

bool is_round(const PointSpread& s) {
  return s.model != PointSpread::Model::file && s.wavefront.empty() && !s.field.any() &&
         s.spiders == 0;
}

}  // namespace

double aperture_fraction(const Optics& optics, double wavelength_m, double radius_px) {
  const PointSpread& spread = optics.spread;
  if (!(radius_px > 0.0)) throw Error("aperture: radius_px: must be > 0");
  if (!is_round(spread))
    throw Error(
        "aperture: the camera has aberrations, spiders or a psf_file: its point spread is not "
        "round");
  const bool gaussian = spread.model == PointSpread::Model::gaussian;
  const double pixel_rad = optics.pixel_angle_rad();
  const PsfPlan plan = plan_psf(optics, wavelength_m, std::nullopt, 1.0);
  const bool deposited = plan.method == PointSpread::Method::deposit;
  const double sigma_px =
      gaussian ? psf_sigma_px(optics, wavelength_m) : plan.fwhm_px / fwhm_per_sigma;
  const Blur blur{
      .wavelength_m = wavelength_m,
      .aperture_m = optics.aperture_m,
      .obscuration = optics.obscuration,
      .jitter_rad = spread.jitter_rad,
      .defocus_disc_rad = std::abs(spread.defocus_m) / optics.f_number() / optics.focal_length_m};
  const auto otf = [&](double nu_per_px) {
    if (gaussian || deposited) return jitter_otf(nu_per_px, sigma_px);
    return optical_otf(blur, nu_per_px / pixel_rad);
  };
  // The transform of a disc of radius r is r J1(2 pi r nu) / nu.
  const double end_per_px = gaussian || deposited ? 1.5 / std::max(sigma_px, 0.05)
                                                  : optics.aperture_m / wavelength_m * pixel_rad;
  const int steps = 2 * int(std::ceil(std::max(400.0, 40.0 * radius_px * end_per_px)));
  const double step = end_per_px / steps;
  double sum = 0.0;  // Simpson's rule; the integrand is 0 at 0
  for (int i = 1; i <= steps; ++i) {
    const double nu = i * step, weight = i == steps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum +=
        weight * std::cyl_bessel_j(1.0, 2.0 * pi * radius_px * nu) * otf(nu) * pixels_squared(nu);
  }
  const double whole = 2.0 * pi * radius_px * sum * step / 3.0;
  return deposited || gaussian ? whole : whole / (1.0 - plan.beyond);
}

double aperture_fraction(const Optics& optics, double wavelength_m, const Aperture& aperture) {
  const auto within = [&](double radius_px) {
    return aperture_fraction(optics, wavelength_m, radius_px);
  };
  const auto square = [](double x) { return x * x; };
  return within(aperture.radius_px) - (within(aperture.outer_px) - within(aperture.inner_px)) *
                                          square(aperture.radius_px) /
                                          (square(aperture.outer_px) - square(aperture.inner_px));
}

}  // namespace dmise
