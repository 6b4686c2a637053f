#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/effects/accuracy.h"
#include "core/effects/effects.h"
#include "core/effects/sky_part.h"

namespace dmise {

/// A sample of the sky by which an exposure is planned: light and noise of a pixel there [e-].
struct SkySample {
  double sky_e = 0.0;                           // all parts
  double noise_e = 1.0;                         // from sky, dark current and read-out, > 0
  std::array<double, sky_part_count> part_e{};  // in the order of SkyPart

  double of(SkyPart part) const { return part_e[static_cast<std::size_t>(part)]; }
};

/// Limits of stars by whole V magnitudes from 0.
inline constexpr std::size_t star_limits = 32;

/// Turbulence before the sensor, at the centre of its band.
struct AirFacts {
  double airy_px = 1.0;             // wavelength / aperture
  double apertures_per_r0 = 1.0;    // aperture / r0
  double apertures_blown = 0.0;     // way of the wind in the exposure / aperture
  int screens = 0;                  // in a short exposure; 0: exposures are long
  double still_peak_share = 1.0;    // as `peak_share`, without turbulence
  bool still_is_deposited = false;  // without turbulence the blur takes no transform
  bool can_be_off = true;           // the blur can be computed without it
  double bleeds_at_e = unbounded;   // charge of a pixel, of a detector that blooms
};

/// What is known of a sensor and one exposure before it is made. Effects state their errors and
/// costs by it. All figures are finite.
struct PlanFacts {
  SceneFacts scene;
  // The sensor.
  int columns = 1, rows = 1;
  double pixel_rad = 1e-5;          // the finest scale of the field
  double widest_pixel_rad = 0.0;    // the coarsest one
  double relative_bandwidth = 0.2;  // width over centre
  double fwhm_px = 1.0;
  double peak_share = 1.0;  // largest share of a point's light in its brightest pixel
  int screens = 0;          // in a short exposure, which shows a point as a cloud of speckles
  double speckle_px = 1.0;  // width of the finest structure of a point
  double ghost_pixel_share = 0.0;  // point's light in a pixel of its ghost by the lens
  /// Where kernels of the blur end, and a pixel's share of a point's light there without the taper
  /// to 0 over their outer half.
  double kernel_end_px = unbounded, kernel_end_share = 0.0;
  double airy_px = 1.0;  // wavelength / aperture
  /// Contrast of the rings of diffraction after pixels, seeing and jitter, 0..1.
  double ring_contrast = 1.0;
  // Light between sources.
  std::vector<SkySample> sky;  // over the field, where it sees the sky; at least one
  static constexpr double usual_between = 1.25;
  /// Largest factor by which a part of the sky may be brighter between the samples.
  std::array<double, sky_part_count> between_samples = [] {
    std::array<double, sky_part_count> usual{};
    usual.fill(usual_between);
    return usual;
  }();
  /// Light of a pixel beyond which it is saturated, whatever the plan.
  double saturated_e = unbounded;
  double nearest_moon_rad = 3.0;       // to the nearest of the field
  bool sees_zenith = false;            // or is near it
  double cloud_detail_px = unbounded;  // size of the smallest pieces of cloud in the field
  double sky_look_s = 0.32e-6;         // cost of evaluating all parts once
  double dark_e = 0.0, read_noise_e = 0.0;
  bool read_later = false;  // its noise is drawn after effects that take charge only
  // The air.
  double max_airmass = 1.0, zenith_extinction_mag = 0.0;
  double gas_mag = 0.0;         // absorption of sunlight by gases at the largest airmass
  double scintillation = 0.0;   // deviation of a source's light at the largest airmass
  double refraction_rad = 0.0;  // largest in the field
  double dispersion_rad = 0.0;  // length of the longest spectrum of the band's light
  double moon_refraction_rad = 0.0;
  bool moon_is_down = false;  // below the horizon without refraction
  // Directions.
  double nearest_sun_rad = 3.0;                                      // from the field's edge
  double annual_aberration_rad = 0.0, diurnal_aberration_rad = 0.0;  // largest in the field
  bool sees_horizon = false;                                         // the Earth is in the field
  double disc_e = 0.0;            // brightest pixel of Sun, Moon and Earth in the field
  double stray_light_e = 0.0;     // in a pixel
  double thermal_optics_e = 0.0;  // brightest pixel
  double limb_airglow_e = 0.0, limb_air_e = 0.0;  // brightest pixel of the Earth's limb
  double min_illumination = 1.0;                  // by vignetting
  double illumination_slope_per_px = 0.0;         // steepest, relative, of a vignetting by a table
  // What the sensor does not know of itself.
  double pointing_error_rad = 0.0;  // largest displacement in the field
  double clock_error_s = 0.0;       // size, in the exposure
  /// Largest speeds past a camera that moves by its clock.
  double star_rate_rad_per_s = 0.0, object_rate_rad_per_s = 0.0;
  // Stars.
  double stars = 0.0;                                  // whose places are computed, to the limit
  std::array<double, star_limits> stars_brighter{};    // stars to each whole V magnitude
  double brightest_star_e = 0.0;                       // light of one star in the field
  std::array<double, star_limits> brightest_left_e{};  // light of the brightest beyond each limit
  double star_trail_px = 0.0;                          // shortest
  double star_shift_rad = 0.0;  // largest proper motion since the catalogue's epoch
  double star_parallax_rad = 0.0;
  /// Faint starlight of a pixel, most, with stars drawn to each limit.
  std::array<double, star_limits> starlight_e{};
  /// Synthetic stars that are made, and light of the brightest beyond, by the same limits.
  std::array<double, star_limits> synthetic_brighter{}, synthetic_left_e{};
  // Objects.
  std::size_t objects = 0, shapes = 0;
  double light_time_rad = 0.0;  // motion of an object while its light travels, seen by the sensor
  bool near_shadow = false;     // an object is in the Earth's shadow or near it
  bool near_shadow_of_air = false;  // sunlight to an object passes the Earth's air, or may
  double brightest_object_e = 0.0;
  std::vector<double> shape_radius_px;  // each object with a shape has one
  double narrowest_object_px = 0.0;     // 0: a point
  double hidden_sky_px = 0.0;           // largest number of pixels of sky behind an object
  bool faint_objects = false;           // an object may be too faint to count as a source
  double longest_trail_px = 0.0;        // any source's, within the frame
  /// Objects that their range puts out of focus: the share of their light that is elsewhere than in
  /// focus, and the cost of drawing one so.
  struct OutOfFocus {
    double misplaced = 0.0, cost_s = 0.0;
  };
  std::vector<OutOfFocus> out_of_focus;
  static constexpr double glint_e = 1e9;  // most in a pixel of a shape
  AirFacts air;
  // The blur.
  static constexpr double transform_pixel_s = 2e-9;
  int min_wavelengths = 1;      // over the band, by the camera
  bool kernels_change = false;  // with every exposure
  double kernel_s = 0.0;        // cost of all kernels of one wavelength
  /// Largest differences between the kernels of each level of `psf_field` and the true blur of a
  /// place: share of a point's light that is misplaced, and displacement of its centroid.
  static constexpr std::size_t field_levels = 4;
  std::array<double, field_levels> field_misplaced{}, field_shift_px{};
  /// Largest difference of defocus from the usual in the run, as the diameter of its disc.
  double defocus_px = 0.0;

  double pixels() const { return double(columns) * rows; }
  /// Returns about how often the sky is evaluated for its grid.
  double sky_looks() const { return 1.7 * (columns / 32.0 + 2.0) * (rows / 32.0 + 2.0); }
  /// Returns the index of a limit in the arrays of stars.
  static std::size_t limit(double v_mag) {
    return std::size_t(std::clamp(v_mag, 0.0, double(star_limits) - 1.0));
  }
  double stars_to(double v_mag) const { return v_mag < 0.0 ? 0.0 : stars_brighter[limit(v_mag)]; }
  double min_noise_e() const {
    double least = unbounded;
    for (const auto& s : sky) least = std::min(least, s.noise_e);
    return sky.empty() ? 1.0 : least;
  }
  /// Returns `light_e` in units of the smallest noise of a pixel.
  double in_noise(double light_e) const { return light_e / min_noise_e(); }
  double sigma_px() const { return std::hypot(fwhm_px / 2.355, 0.29); }
  /// Returns the root of the sum of squares of the shares that pixels have of the light of a source
  /// with a trail of `trail_px`. The signal-to-noise ratio of a source is that times its light over
  /// a pixel's noise, and a relative pattern of independent pixels changes its light by that share.
  double pattern_share(double trail_px = 0.0) const {
    const double sigma = sigma_px();
    return std::min(1.0, std::sqrt(0.2821 / sigma / std::max(trail_px, 3.545 * sigma)));
  }
  /// Returns the light of the faintest source whose photometry and position count.
  double faintest_source_e() const { return min_snr * min_noise_e() / pattern_share(); }
  /// Returns the light in the brightest pixel of a source, in units of the pixel's noise; `snr`: of
  /// its whole light.
  double peak_in_noise(double snr, double trail_px) const {
    const double share = trail_px > 2.0 ? std::sqrt(peak_share) / (0.5 * trail_px) : peak_share;
    const double speckle = screens > 0 ? 1.0 + 3.0 / std::sqrt(double(screens)) : 1.0;
    return speckle * snr * std::min(share, peak_share) / pattern_share(trail_px);
  }

  /// Returns the relative error of a pixel's noise by an error of its light, in units of the noise.
  /// The noise is taken as no less than one electron.
  double noise_of(double background_sigma) const {
    const double noise_e = min_noise_e();
    return std::min(1.0, 0.5 * background_sigma * std::max(1.0, noise_e) / (noise_e * noise_e));
  }
  /// Error of sources that are misplaced by an angle, with what their faint edges leave beside
  /// them.
  ErrorBound shifted_stars(double angle_rad) const {
    return shifted(angle_rad, stars > 0.0, star_trail_px);
  }
  ErrorBound shifted_objects(double angle_rad) const {
    ErrorBound error = shifted(angle_rad, faint_objects, 0.0);
    if (!faint_objects) return error;
    // The edge of a dark object before the sky.
    const double share = std::min(1.0, hidden_sky_px) * std::min(1.0, error.position_px);
    return error + without_light([&](const SkySample& s) { return share * s.sky_e; });
  }
  ErrorBound shifted_by(double angle_rad) const {
    return faint_objects ? shifted_objects(angle_rad) : shifted_stars(angle_rad);
  }
  /// Error of sources whose light is wrong by `magnitude`, and of the background by sources that
  /// are too faint for photometry.
  ErrorBound dimmed_by(double magnitude) const {
    const double trail_px = faint_objects ? 0.0 : star_trail_px;
    const double background_sigma = peak_in_noise(min_snr, trail_px) * std::min(1.0, magnitude);
    return {.photometry_mag = magnitude,
            .background_sigma = background_sigma,
            .noise = noise_of(background_sigma)};
  }
  /// Error of a frame without the light `light_e(sample)`.
  template <class Light>
  ErrorBound without_light(const Light& light_e) const {
    ErrorBound error;
    for (const auto& s : sky) {
      const double light = light_e(s), share = light / (s.noise_e * s.noise_e);
      error.background_sigma = std::max(error.background_sigma, light / s.noise_e);
      error.noise = std::max(error.noise, 1.0 - std::sqrt(std::max(0.0, 1.0 - share)));
    }
    return error;
  }
  /// Error of a frame without charge that all pixels have, also those that see no sky.
  ErrorBound without_charge(double charge_e) const {
    const auto charge = [&](const SkySample&) { return charge_e; };
    ErrorBound error = without_light(charge);
    if (!sees_horizon) return error;
    const double noise_e = std::sqrt(std::max(dark_e + read_noise_e * read_noise_e, 1e-6));
    const double share = charge_e / (noise_e * noise_e);
    error.background_sigma = std::max(error.background_sigma, charge_e / noise_e);
    error.noise = std::max(error.noise, 1.0 - std::sqrt(std::max(0.0, 1.0 - share)));
    return error;
  }
  /// Error of a blur that puts a share of a point's light elsewhere within its width, `shift_px` of
  /// it to one side. Between sources, where a source has less than half of the noise.
  ErrorBound misplaced(double share, double shift_px) const {
    if (!(share > 0.0 || shift_px > 0.0)) return {};
    share = std::min(share, 1.0);
    constexpr double half_noise = 0.5, beyond = 2.0;
    const double background_sigma =
        std::min(half_noise + beyond * share, share * in_noise(brightest_e() * peak_share));
    ErrorBound error{.photometry_mag = share < 0.99 ? -2.5 * std::log10(1.0 - share) : unbounded,
                     .position_px = shift_px + share * std::hypot(1.0, fwhm_px),
                     .background_sigma = background_sigma,
                     .noise = noise_of(background_sigma)};
    if (!(share < 0.99)) error.position_px = error.background_sigma = error.noise = unbounded;
    return error;
  }
  /// Error of a frame without a part of the sky.
  ErrorBound without_part(SkyPart part) const {
    const double most = between_samples[static_cast<std::size_t>(part)];
    return without_light([&](const SkySample& s) { return most * s.of(part); });
  }
  /// Returns the moonlight where the field is nearest to the Moon, which may be between samples.
  double moonlight_e(const SkySample& s) const {
    constexpr auto part = SkyPart::scattered_moonlight;
    return s.of(part) * between_samples[static_cast<std::size_t>(part)] / usual_between;
  }
  /// Returns the light of the brightest pixel, at most.
  double brightest_pixel_e() const {
    double sky_e = 0.0;
    for (const auto& s : sky) sky_e = std::max(sky_e, s.sky_e);
    return 1.25 * sky_e + dark_e + brightest_e() * peak_share + (shapes > 0 ? glint_e : 0.0);
  }
  /// Returns the light of the brightest source, at most.
  double brightest_e() const { return std::max(brightest_star_e, brightest_object_e); }

  /// Least signal-to-noise ratio of a source that counts, and of one that is not background.
  static constexpr double min_snr = 5.0, min_snr_of_source = 0.5;
  /// Largest share of a source's light that a neighbour may have in its aperture: with more the
  /// source does not count.
  static constexpr double neighbour_share = 0.002;

 private:
  /// Error by a shift where kernels of the brightest source end, in units of the noise. Their light
  /// is `end` x sin^2(pi x distance from the end / radius) there; where it exceeds half of the
  /// noise there is no background.
  double kernel_end_in_noise(double px) const {
    const double end = in_noise(kernel_end_share * brightest_e());
    if (!(end > 0.0) || !std::isfinite(kernel_end_px)) return 0.0;
    constexpr double half = 0.5, pixel_px = 0.7;
    const double per_px = pi / kernel_end_px;
    const double from_end_px =
        std::min(0.5 * kernel_end_px, std::sqrt(half / end) / per_px + pixel_px);
    return std::min(end, end * per_px * per_px * px * (2.0 * from_end_px + px));
  }
  /// Largest shift of the centroid of pixels per shift of a Gaussian of that deviation,
  /// 1 + 2 sum_k exp(-2 (pi k sigma)^2): pixels that are too wide for it draw it to their middles.
  static double centroid_slope(double sigma_px) {
    if (sigma_px >= 0.4) return 1.0 + 2.0 * std::exp(-2.0 * pi * pi * sigma_px * sigma_px);
    const double sigma = std::max(sigma_px, 1e-3);
    return (1.0 + 2.0 * std::exp(-0.5 / (sigma * sigma))) / (sigma * std::sqrt(2.0 * pi));
  }
  ErrorBound shifted(double angle_rad, bool faint, double trail_px) const {
    constexpr double off_axis = 1.08, steepest = 0.607;  // a Gaussian's slope is at most e^-0.5
    const double of_light =
        (screens > 0 ? 0.15 : 0.02) + 8.0 / cloud_detail_px;  // clouds: magnitudes a piece
    const double width_px = screens > 0 ? std::min(sigma_px(), speckle_px / 2.355) : sigma_px();
    const double px = off_axis * angle_rad / pixel_rad;
    const double blur_px = 0.95 * fwhm_px / 2.355;  // Airy patterns are narrower in frequency
    const double centroid_px = std::min(px + 1.0, px * centroid_slope(blur_px));
    // Beside sources that count there is light of their rings alone, which go from dark to bright
    // in half of their distance.
    const double peak = faint || scene.diffracts ? peak_in_noise(min_snr_of_source, trail_px) : 0.0;
    const double rings = scene.diffracts ? std::min(1.0, 2.0 * ring_contrast) : 0.0;
    const double background_sigma =
        peak * std::min(1.0, steepest * px / width_px) +
        in_noise(ghost_pixel_share * brightest_e() * std::min(1.0, px)) + kernel_end_in_noise(px) +
        in_noise(disc_e * std::min(1.0, px)) + rings * 0.5 * std::min(1.0, pi * px / speckle_px);
    return {.photometry_mag = of_light * px,
            .position_px = centroid_px,
            .background_sigma = background_sigma,
            .noise = noise_of(background_sigma)};
  }
};

}  // namespace dmise
