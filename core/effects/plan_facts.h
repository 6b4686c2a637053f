#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"

namespace dmise {

/// Parts of the sky by their place in SkySample::part_e.
inline constexpr std::size_t most_sky_parts = 7;

/// Where the sky is looked at to plan an exposure: a pixel's light and noise there [e-].
struct SkySample {
  double sky_e = 0.0;                           // all parts
  double noise_e = 1.0;                         // of sky, dark current and read-out, > 0
  std::array<double, most_sky_parts> part_e{};  // in the order of the sky's parts
};

/// What is known of a sensor and one exposure before it is made: by it effects state their errors
/// and costs. All figures are finite.
struct PlanFacts {
  SceneFacts scene;
  // The sensor.
  int columns = 1, rows = 1;
  double pixel_rad = 1e-5;          // the finest scale of the field
  double relative_bandwidth = 0.2;  // width over centre
  double fwhm_px = 1.0;
  double peak_share = 1.0;       // of a point's light in its brightest pixel, most
  double star_peak_share = 1.0;  // the same of a star, which may leave a trail
  // Light between sources.
  std::vector<SkySample> sky;   // over the field, where it sees the sky; at least one
  double sky_look_s = 0.32e-6;  // what one look at all parts costs
  double dark_e = 0.0, read_noise_e = 0.0;
  // The air.
  double most_airmass = 1.0, zenith_extinction_mag = 0.0;
  double scintillation = 0.0;   // deviation of a source's light at the largest airmass
  double refraction_rad = 0.0;  // largest in the field
  // Directions.
  double nearest_sun_rad = 3.0;                                      // of the field's edge
  double annual_aberration_rad = 0.0, diurnal_aberration_rad = 0.0;  // largest in the field
  bool sees_horizon = false;                                         // the Earth is in the field
  double least_illumination = 1.0;                                   // by vignetting
  // Stars.
  double stars = 0.0;                       // in the field, to the scenario's limit
  std::array<double, 32> stars_brighter{};  // the same by whole V magnitudes from 0
  double star_zero_e = 0.0;                 // of a star of V = 0 over the exposure
  double star_shift_rad = 0.0;              // of proper motion since the catalogue's epoch, largest
  double star_parallax_rad = 0.0;
  /// Faint starlight of a pixel, most, with stars drawn to each whole V magnitude from 0.
  std::array<double, 32> starlight_e{};
  double brightest_star_mag = -1.5;  // in the field
  // Objects.
  std::size_t objects = 0, shapes = 0, resolved = 0;
  double light_time_rad = 0.0;  // way of an object while its light travels, seen from the sensor
  bool near_shadow = false;     // an object is in the Earth's shadow or close
  double brightest_object_e = 0.0;
  static constexpr double glint_e = 1e9;  // of a shape, in a pixel
  // The blur.
  bool kernels_change = false;  // with every exposure
  double kernel_s = 0.0;        // of all kernels of one wavelength

  double pixels() const { return double(columns) * rows; }
  /// Returns how often the sky is looked at for its grid, about.
  double sky_looks() const { return 3.0 * (columns / 32.0 + 2.0) * (rows / 32.0 + 2.0); }
  double stars_to(double v_mag) const {
    if (v_mag < 0.0) return 0.0;
    const double last = double(stars_brighter.size()) - 1.0;
    return stars_brighter[std::size_t(std::min(v_mag, last))];
  }
  double least_noise_e() const {
    double least = unbounded;
    for (const auto& s : sky) least = std::min(least, s.noise_e);
    return sky.empty() ? 1.0 : least;
  }
  /// Returns the largest share of a pixel's noise that `light_e` is in the field.
  double in_noise(double light_e) const { return light_e / least_noise_e(); }
  /// Error of sources that are misplaced by an angle, with what their faint edges leave beside
  /// them.
  ErrorBound shifted_by(double angle_rad) const {
    constexpr double off_axis = 1.08, edge = 0.45, of_light = 0.01;
    const double px = off_axis * angle_rad / pixel_rad;
    const double background_sigma = std::min(1.0, edge * px / std::hypot(fwhm_px / 2.355, 0.3));
    return {.photometry_mag = of_light * px,
            .position_px = px,
            .background_sigma = background_sigma,
            .noise = 0.5 * background_sigma / std::max(1.0, least_noise_e())};
  }
  /// Returns the root of the sum of squares of a point's light by pixels: a pattern of independent
  /// pixels changes the light of a point by so much of itself.
  double pattern_share() const {
    const double sigma_px = std::hypot(fwhm_px / 2.355, 0.29);
    return std::min(1.0, 0.2821 / sigma_px);
  }
  /// Error of sources whose light is off by a factor, with that of those too faint for photometry,
  /// which have three deviations of noise in their brightest pixel.
  ErrorBound dimmed_by(double magnitude) const {
    const double background_sigma = 3.0 * std::min(1.0, magnitude);
    return {.photometry_mag = magnitude,
            .background_sigma = background_sigma,
            .noise = 0.5 * background_sigma / std::max(1.0, least_noise_e())};
  }
  /// Error of the frame without light that `light_e(sample)` gives everywhere.
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
  /// The same for a part of the sky, which may be brighter between the samples.
  ErrorBound without_part(std::size_t part) const {
    constexpr double between_samples = 1.25;
    return without_light([&](const SkySample& s) { return between_samples * s.part_e[part]; });
  }
  /// Returns the light of the brightest pixel, at most.
  double brightest_pixel_e() const {
    double sky_e = 0.0;
    for (const auto& s : sky) sky_e = std::max(sky_e, s.sky_e);
    return 1.25 * sky_e + dark_e + brightest_e() * peak_share + (shapes > 0 ? glint_e : 0.0);
  }
  /// Returns the light of the brightest source, at most.
  double brightest_e() const {
    const double star_e =
        stars_brighter.back() > 0.0 ? star_zero_e * std::pow(10.0, -0.4 * brightest_star_mag) : 0.0;
    return std::max(star_e, brightest_object_e);
  }
};

/// An effect of one sensor as the planner sees it.
struct PlannableEffect {
  const EffectFacts* facts = nullptr;
  std::function<ErrorBound(int level, const PlanFacts&)> error{};  // none: it runs as it is asked
  std::function<double(int level, const PlanFacts&)> cost_s{};     // none: it costs nothing
};

}  // namespace dmise
