#include "sensors/forecast/detection_limit.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/detection/pixels/components.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/streaks/faint_streaks.h"
#include "core/detector/exposure/expected_noise.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "core/optics/psf_plan.h"
#include "sensors/scene/throughput.h"
#include "sensors/sky/sky_light.h"
#include "sensors/sky/thermal_optics.h"

namespace dmise {
namespace {

/// Electrons of a source of SNR `snr` on `pixels` of `noise_e`.
double electrons_of(double snr, double pixels, double noise_e) {
  const double s = snr * snr;
  return 0.5 * (s + std::sqrt(s * s + 4 * s * pixels * noise_e * noise_e));
}

/// z with P(x < z) = p of a normal deviate; p in (0.5, 1). Bisection of erfc.
double normal_quantile(double p) {
  double low = 0.0, high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    (0.5 * std::erfc(-z / std::sqrt(2.0)) < p ? low : high) = z;
  }
  return 0.5 * (low + high);
}

/// Squared correlation of a point and an even trail of `length_px`, both blurred by `sigma_px`.
double correlation_squared(double sigma_px, double length_px) {
  const double half_px = 0.5 * length_px, step_px = sigma_px / 16;
  const int steps = int((half_px + 6 * sigma_px) / step_px);
  double point_point = 0.0, trail_trail = 0.0, point_trail = 0.0;
  for (int k = -steps; k <= steps; ++k) {
    const double x = k * step_px / (std::sqrt(2.0) * sigma_px);
    const double half = half_px / (std::sqrt(2.0) * sigma_px);
    const double point = std::exp(-x * x), trail = std::erf(x + half) - std::erf(x - half);
    point_point += point * point;
    trail_trail += trail * trail;
    point_trail += point * trail;
  }
  return point_trail * point_trail / (point_point * trail_trail);
}

}  // namespace

DetectionLimit detection_limit(double noise_e, double sigma_px, double streak_px, double star_px) {
  DetectionLimit limit{.streak_px = streak_px};
  limit.point_e = limiting_point_e(noise_e, sigma_px);
  if (star_px >= detection_limits::min_difference_px) {
    // Beyond a few widths the correlation no longer changes: limit the length of the sum.
    const double unlike = 1.0 - correlation_squared(sigma_px, std::min(star_px, 100 * sigma_px));
    const double snr =
        std::max(point_limit_snr, std::sqrt(detection_limits::blend_margin / unlike));
    limit.found_point_e = electrons_of(snr, 1.0 / kernel_square_sum(sigma_px), noise_e);
  }
  const double width_px =
      2 * std::sqrt(pi) * sigma_px;  // effective width of the matched filter's noise
  const double places = std::max(1.0, streak_px / width_px);
  const double lift = places > 1.0 ? normal_quantile(std::pow(0.5, 1.0 / places)) : 0.0;
  const double density = electrons_of(streak_limit_snr - lift, width_px * width_px, noise_e);
  // `electrons_of` is for a point of these pixels; a streak's density is over one width.
  const double length_px = std::max(width_px, streak_px);
  const auto of_whole = [&](double snr) {
    return electrons_of(snr, width_px * length_px, noise_e) / length_px;
  };
  limit.streak_e_per_px = std::min(std::max(density / width_px, of_whole(point_limit_snr)),
                                   of_whole(min_streak_snr(length_px)));
  return limit;
}

PixelBackground background_at_centre(const View& view, const DrawnStars& drawn) {
  const auto& sensor = view.sensor();
  const auto& optics = sensor.camera.optics;
  const PixelPosition centre = principal_point(optics);
  const SimTime middle = view.times().middle;
  double sky_e = 0.0;
  const auto gcrs_from_camera = view.camera_from_gcrs(middle).inverse();
  const Vec<Gcrs> boresight = gcrs_from_camera * Vec<CameraFrame>{0, 0, 1};
  const auto earth = view.earth_occultation(middle);
  if (!view.shutter_closed() && sensor.effects.has(SkyBackground::facts) &&
      !(earth && earth->hides_direction(boresight)))
    sky_e = sky_over(view, drawn).photons_per_s_m2_sr(view.enu_from_gcrs(middle) * boresight) *
            Throughput(view).electrons_per_photon_m2() * view.times().seconds() *
            pixel_solid_angle_sr(optics, centre) * view.illumination(centre);
  if (!view.shutter_closed()) sky_e += thermal_optics_e(view);
  const Detector detector = acting_detector(sensor.camera.detector, sensor.effects);
  return {sky_e + detector.dark_e_per_s * view.times().seconds(),
          noise_over_sky_e(sensor, view.times(), view.seed(), sky_e)};
}

double noise_over_sky_e(const SensorConfig& sensor, const FrameTimes& times, std::uint64_t seed,
                        double sky_e) {
  constexpr int side = 8;
  const ExpectedElectronImage light(side, side, float(sky_e));
  Threads threads(1);
  const auto noise = expected_noise(light, sensor.camera.detector, exposure_of(sensor, times, seed),
                                    sensor.effects, threads);
  return double(middle_of(noise.pixels));
}

double saturation_e(const Detector& acting) {
  const double max_e = (std::exp2(acting.adc_bits) - 1 - acting.bias_dn) * acting.gain_e_per_dn;
  return acting.well_is_limited ? std::min(max_e, acting.full_well_e) : max_e;
}

namespace {

PsfPlan blur_plan(const SensorConfig& sensor) {
  return plan_psf(sensor.camera.optics, sensor.camera.band.centre_m, sensor.seeing,
                  sensor.exposure_s, AirTurbulence::level(sensor.effects));
}

}  // namespace

double blur_sigma_px(const SensorConfig& sensor) {
  const double fwhm_px = blur_plan(sensor).fwhm_px;
  const double sigma_px = sensor.effects.has(PointSpread::facts) ? fwhm_px / fwhm_per_sigma : 0.0;
  return std::sqrt(sigma_px * sigma_px + 1.0 / 12);
}

BlurByRange::BlurByRange(const SensorConfig& sensor)
    : optics_(sensor.camera.optics),
      stars_sigma_px_(blur_sigma_px(sensor)),
      step_(sensor.effects.has(PointSpread::facts)
                ? RangeDefocus::misplaced[std::size_t(sensor.effects.level(RangeDefocus::facts))]
                : 1.0),
      scale_(optics_, blur_plan(sensor)) {}

double BlurByRange::disc_px(double range_m) const {
  if (!(step_ < 1.0)) return 0.0;
  const double in_focus_m = optics_.spread.defocus_m;
  const double defocus_m = in_focus_m - range_defocus_m(optics_, range_m);
  if (scale_.stepped_m(defocus_m, in_focus_m, step_) == in_focus_m) return 0.0;
  return std::abs(scale_.disc_px(defocus_m));
}

double BlurByRange::sigma_px(double range_m) const {
  const double disc_px = this->disc_px(range_m);
  if (disc_px == 0.0) return stars_sigma_px_;
  // The disc of stars is in the quadrature of their width as a Gaussian's.
  const double of_stars_px = scale_.disc_px(optics_.spread.defocus_m) / fwhm_per_sigma;
  const double focused_px2 =
      std::max(1.0 / 12, stars_sigma_px_ * stars_sigma_px_ - of_stars_px * of_stars_px);
  return std::sqrt(focused_px2 + disc_variance_px2(optics_, disc_px));
}

}  // namespace dmise
