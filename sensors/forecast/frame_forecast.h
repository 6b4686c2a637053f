#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/sky/stars/star_cache.h"
#include "sensors/forecast/detection_limit.h"
#include "sensors/forecast/thermal_limit.h"
#include "sensors/objects/object_shapes.h"
#include "sensors/scene/view.h"

namespace dmise {

class ExposurePlanner;

/// A planet as a frame shows it; V above the air.
struct PlanetForecast {
  std::string_view name;
  double v_mag = 0.0, diameter_rad = 0.0;
  bool is_disc = false;  // drawn as one, not as a point
};

/// Prediction of one frame, at mid exposure, without rendering it. Elevations are of centres,
/// without refraction, above the horizon of the ellipsoid; on the ground only.
struct FrameForecast {
  std::uint32_t frame = 0;
  SimTime middle;
  std::optional<double> boresight_elevation_rad, sun_elevation_rad, moon_elevation_rad,
      target_elevation_rad;
  std::optional<double> limb_angle_rad;  // boresight above the Earth's limb; in orbit
  bool boresight_hidden = false;         // by the Earth
  bool target_hidden = false;
  bool sun_in_field = false;
  std::vector<PlanetForecast> planets;  // in the field or next to it
  bool shutter_closed = false;          // nothing is in the field
  PixelBackground background;           // at the frame's centre
  double full_e = 0.0;                  // saturation level
  std::optional<ThermalLimit> thermal;
  double extinction_mag = 0.0;  // along the boresight
  double streak_deg_per_s = 0.0, streak_px = 0.0;
  double star_px = 0.0;  // length of a star's trail at the centre
  // Empty for a saturated or hidden sky; `found_point_v_mag` also if stars do not trail,
  // `streak_limit_v_mag` also for streaks that are too short.
  std::optional<double> point_limit_v_mag, found_point_v_mag, streak_limit_v_mag;
  /// The disc of a point at `near_range_m` has a diameter of `near_disc_px`; 0: as sharp as stars.
  double near_disc_px = 0.0;
  std::optional<double> near_limit_v_mag;
  std::optional<std::uint32_t> stars, objects;  // with light in the frame; stars of the catalogue
  struct Synthetic {
    double stars = 0.0;     // expected in the frame
    double to_v_mag = 0.0;  // where they end
  };
  std::optional<Synthetic> synthetic;  // stars where the catalogue ends
};

/// Rate of the streaks of the limit: a satellite 1000 km overhead.
inline constexpr double usual_rate_deg_per_s = 0.42;

/// Range for which a defocus is stated.
inline constexpr double near_range_m = 500e3;

/// Further inputs besides the view. `stars`, `shapes` and `planner` may be null. Objects are
/// counted if `count_objects`, because the states may be of some of them alone.
struct ForecastScene {
  std::shared_ptr<const StarMap> stars;
  double faintest_star_mag = 0.0;
  const ObjectShapes* shapes = nullptr;
  const ExposurePlanner* planner = nullptr;  // the sensor's, for the limit of synthetic stars
  double psf_sigma_px = 0.0;                 // including the pixel
  bool count_objects = true;
};

FrameForecast frame_forecast(const View& view, const ForecastScene& scene);

/// Objects whose sunlit path is in the frame or within `margin_px` of it.
std::uint32_t objects_with_light(const View& view, const ObjectShapes* shapes, double margin_px);

}  // namespace dmise
