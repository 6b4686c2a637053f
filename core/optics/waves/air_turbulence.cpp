#include "core/optics/waves/air_turbulence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr double deviations = 4.0;       // one exposure in 3000 has more
constexpr double aperture_widths = 3.0;  // radius in which light is summed, in widths of a point

/// lambda / r0: the scale of seeing.
double seeing_px(const AirFacts& air) { return air.airy_px * air.apertures_per_r0; }

/// Deviation of the mean of the speckle patterns of an exposure in a pixel, relative to it.
double speckle_contrast(const AirFacts& air) {
  const double cells = std::max(1.0, 1.0 / (air.airy_px * air.airy_px));
  return 1.0 / std::sqrt(air.screens * cells);
}

/// Scatter of all that is beyond a radius: there is a speckle for each square of wavelength /
/// aperture.
double rim_contrast(const AirFacts& air, double radius_px) {
  return std::min(1.0, air.airy_px / radius_px) / std::sqrt(double(air.screens));
}

/// Share of the light of a circular aperture without air that is farther away.
double diffracted_beyond(const AirFacts& air, double radius_px) {
  return std::min(1.0, 0.2 * air.airy_px / radius_px);
}

/// Share of a source's light in one pixel at the rim of its aperture: the derivative of
/// `scattered_beyond`.
double halo_share(const AirFacts& air, double radius_px) {
  return 0.031 * std::pow(seeing_px(air), 5.0 / 3.0) * std::pow(radius_px, -11.0 / 3.0);
}

/// Light that a brighter neighbour puts into the aperture of a source, over the source's own. A
/// source with a tenth of its light or more at the rim does not count.
double share_of_neighbour(const PlanFacts& f, double radius_px) {
  constexpr double rim_share = 0.1;
  const double area_px = std::numbers::pi * radius_px * radius_px;
  return std::min(rim_share,
                  f.brightest_e() / f.faintest_source_e() * halo_share(f.air, radius_px) * area_px);
}

/// Whether a sharper image may bleed where the reference does not.
bool may_bleed(int level, const PlanFacts& f) {
  const double share = level == AirTurbulence::off ? f.air.still_peak_share : f.peak_share;
  return f.shapes > 0 ? std::isfinite(f.air.bleeds_at_e)
                      : f.brightest_e() * share > f.air.bleeds_at_e;
}

/// Light beside sources that counts as background, in noise. In the reference that is less than
/// half of the noise there by definition.
double beside_sources(int level, const PlanFacts& f, double radius_px) {
  constexpr double half_noise = 0.5, brightest_speckle = 8.0;
  const double source_e = f.shapes > 0 ? PlanFacts::glint_e : f.brightest_e();
  const double halo = f.in_noise(source_e * halo_share(f.air, radius_px));
  const double contrast = f.air.screens > 0 ? speckle_contrast(f.air) : 0.0;
  const double above = brightest_speckle * contrast, below = deviations * contrast;
  if (level == AirTurbulence::long_exposure) {
    // Where the halo is brighter the reference's is no background, even at its darkest.
    const double brightest = below < 1.0 ? half_noise * below / (1.0 - below) : halo;
    return std::min(above * halo, std::max(half_noise, brightest));
  }
  // Brightest rings have twice the mean of a pattern's wings, of which each pixel has some if
  // there are two rings in it.
  const double rings = f.in_noise(source_e * 2.0 * diffracted_beyond(f.air, radius_px) /
                                  (2.0 * std::numbers::pi * radius_px * radius_px));
  return std::max(f.air.airy_px < 0.5 ? std::min(half_noise, rings) : rings,
                  std::min(half_noise, (1.0 + above) * halo));
}

}  // namespace

double image_motion_px(const AirFacts& air) {
  if (air.screens == 0) return 0.0;
  const double once = 0.18 * std::pow(air.apertures_per_r0, 5.0 / 3.0) * air.airy_px * air.airy_px;
  const double blown = air.screens > 1 ? std::cbrt(1.0 / (1.0 + 0.25 * air.apertures_blown)) : 1.0;
  return std::sqrt(once * (blown + (1.0 - blown) / air.screens));
}

double scattered_beyond(const AirFacts& air, double radius_px) {
  return std::min(1.0, 0.11 * std::pow(radius_px / seeing_px(air), -5.0 / 3.0));
}

ErrorBound AirTurbulence::error(int level, const PlanFacts& f) {
  const AirFacts& air = f.air;
  if (level == short_exposure || (level == long_exposure && air.screens == 0)) return {};
  if (level == off && !air.can_be_off) return not_bounded;
  const bool any = f.shapes > 0 || f.brightest_e() > 0.0;
  if (!any) return {};
  if (may_bleed(level, f)) return not_bounded;
  const double radius_px = aperture_widths * std::hypot(1.0, f.fwhm_px);
  const double contrast = air.screens > 0 ? speckle_contrast(air) : 0.0;
  const double uneven = air.screens > 0 ? deviations * rim_contrast(air, radius_px) : 0.0;
  const double shift_px = deviations * image_motion_px(air);
  const double scattered = scattered_beyond(air, radius_px);
  const double diffracted = diffracted_beyond(air, radius_px);
  // Light that leaves the aperture: what scatters more or less, and what moves over its edge. A
  // neighbour's comes in from one side, less of it in the centre than at the edge.
  const double scatter = level == off ? 1.0 + uneven : uneven;
  const double neighbour = std::min(1.0, scatter) * share_of_neighbour(f, radius_px);
  const double moved =
      std::min(1.0, shift_px * shift_px / (radius_px * radius_px)) * (scattered + diffracted);
  const double wings = air.still_is_deposited && level == off ? diffracted : 0.0;
  ErrorBound error =
      f.dimmed_by(1.086 * (scattered * std::min(2.0, scatter) + moved + wings + neighbour));
  error.position_px = shift_px + 0.5 * radius_px * neighbour;
  // A source that is no background is brighter.
  const double snr = f.brightest_e() * f.pattern_share() / f.min_noise_e();
  const double peak = f.peak_in_noise(
      f.shapes > 0 ? PlanFacts::min_snr_of_source : std::min(snr, PlanFacts::min_snr_of_source),
      f.faint_objects ? 0.0 : f.star_trail_px);
  const double sharper =
      level == off ? std::max(1.0, air.still_peak_share / std::max(f.peak_share, 1e-9)) : 1.0;
  const double core = level == off
                          ? sharper
                          : std::min(1.0, deviations * contrast + 0.607 * shift_px / f.sigma_px());
  error.background_sigma += peak * core + beside_sources(level, f, radius_px);
  error.noise = f.noise_of(error.background_sigma);
  if (f.shapes == 0 && snr < PlanFacts::min_snr) error.photometry_mag = error.position_px = 0.0;
  return error;
}

double AirTurbulence::cost_s(int level, const PlanFacts& f) {
  if (level == off) return 0.0;
  const double kernels_s = level == short_exposure && f.kernels_change ? f.kernel_s : 0.0;
  return kernels_s + (f.air.still_is_deposited ? PlanFacts::transform_pixel_s * f.pixels() : 0.0);
}

}  // namespace dmise
