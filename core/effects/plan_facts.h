#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/effects/accuracy.h"
#include "core/effects/effects.h"

namespace dmise {

/// Where the sky is looked at to plan an exposure: a pixel's light and noise there [e-].
struct SkySample {
  double sky_e = 0.0;          // all parts
  double noise_e = 1.0;        // of sky, dark current and read-out, > 0
  std::vector<double> part_e;  // in the order of the sky's parts
};

/// What is known of a sensor and one exposure before it is made: by it effects state their errors
/// and costs. All figures are finite.
struct PlanFacts {
  SceneFacts scene;
  // The sensor.
  int columns = 1, rows = 1;
  double pixel_rad = 1e-5;  // the finest scale of the field
  double aperture_m = 0.1, obscuration = 0.0;
  double exposure_s = 1.0;
  double wavelength_m = 550e-9, relative_bandwidth = 0.2;
  double fwhm_px = 1.0;
  double peak_share = 1.0;  // of a point's light in its brightest pixel, most
  // Light between sources.
  std::vector<SkySample> sky;  // over the field, where it sees the sky; at least one
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
  std::array<double, 32> stars_brighter{};  // in the field, by whole V magnitudes from 0
  double star_zero_e = 0.0;                 // of a star of V = 0 over the exposure
  double star_shift_rad = 0.0;              // of proper motion since the catalogue's epoch, largest
  double star_parallax_rad = 0.0;
  double star_trail_px = 0.0;        // least
  double brightest_star_mag = -1.5;  // in the field
  // Objects.
  std::size_t objects = 0, shapes = 0, resolved = 0;
  double light_time_rad = 0.0;  // way of an object while its light travels, seen from the sensor
  bool near_shadow = false;     // an object is in the Earth's shadow or close
  double brightest_object_e = 0.0;
  // The blur.
  bool diffraction = false, turbulence = false, kernels_change = false;
  double grid_cells = 0.0;  // of the transform, 0: none
  int kernel_half_cells = 0, field_kernels = 1, screens = 0;

  double pixels() const { return double(columns) * rows; }
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
  double brightest_e() const {
    const double star_e =
        stars_brighter.back() > 0.0 ? star_zero_e * std::pow(10.0, -0.4 * brightest_star_mag) : 0.0;
    return std::max(star_e, brightest_object_e);
  }
};

/// An effect as the planner sees it.
struct PlannableEffect {
  const EffectFacts* facts = nullptr;
  ErrorBound (*error)(int level, const PlanFacts&) = nullptr;
  double (*cost_s)(int level, const PlanFacts&) = nullptr;
  bool (*applies)(const PlanFacts&) = nullptr;
};

}  // namespace dmise
