#pragma once
#include <array>
#include <optional>

#include "core/base/pixel.h"
#include "core/config/scenario.h"
#include "core/frames/geodesy.h"
#include "core/optics/exclusion.h"
#include "core/sky/bodies/occultation.h"
#include "core/sky/places/apparent.h"
#include "core/visibility/pointing.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/exposure_errors.h"
#include "sensors/scene/state_window.h"

namespace dmise {

/// Whether a view has the errors of the sensor's clock and pointing.
enum class Belief {
  truth,     // it has: so the frame is made
  believed,  // none: so the sensor describes it
};

/// How one sensor sees the world during one exposure: where it is, where it points, and which pixel
/// a direction falls on, at any time of the exposure.
class View {
 public:
  /// `commanded`: by the sensor's clock. `window` must cover its `exposure_span` and outlive the
  /// view.
  View(const SensorConfig& sensor, const FrameTimes& commanded, const StateWindow& window,
       std::uint64_t seed = 1, Belief belief = Belief::truth);
  View(const View&) = default;
  View& operator=(const View&) = delete;

  const SensorConfig& sensor() const { return sensor_; }
  /// When the shutter is open: of a rolling one in its first row.
  const FrameTimes& times() const { return times_; }
  /// This view while a source is exposed.
  View during(const FrameTimes& times) const;
  /// Whether rows are exposed one after another.
  bool rolls() const { return shutter_.row_time_us > 0.0; }
  /// From the first row's opening to the last row's end.
  FrameTimes times_of_all_rows() const;
  /// How much later than the first the row at `y_px` is exposed.
  SimTime row_delay(double y_px) const;
  /// What the sensor does not know of this; none in a view of what it believes.
  const ExposureErrors& errors() const { return errors_; }
  const StateWindow& states() const { return window_; }
  std::uint64_t seed() const { return seed_; }
  bool on_ground() const { return site_.has_value(); }
  const std::optional<Site>& site() const { return site_; }
  /// The object that carries the sensor; it does not see itself.
  std::optional<std::size_t> platform() const { return platform_; }

  /// The object that the sensor points at.
  std::optional<std::size_t> target() const { return target_; }

  ObserverState observer(SimTime t) const;
  const EarthOrientation& earth() const { return environment_.earth; }
  /// The Earth's surface, in mid exposure.
  OblateEarth surface() const { return oblate_earth(earth(), sensor_.ellipsoid); }
  const EnvironmentState& environment() const { return environment_; }
  /// The air over a ground sensor; null where the sensor did not ask for it.
  const SiteState* air() const { return air_; }
  /// The air that refracts over a ground sensor.
  const Weather& weather() const { return weather_; }
  /// The refraction over a ground sensor, whether its effects have it or not.
  const Refraction& refraction() const { return refraction_; }
  Rotation<CameraFrame, Gcrs> camera_from_gcrs(SimTime t) const;
  /// Returns where the camera's axis points.
  Vec<Gcrs> boresight(SimTime t) const {
    return camera_from_gcrs(t).inverse() * Vec<CameraFrame>{0, 0, 1};
  }
  /// Where light seems to come from, at `t`, with the sensor's effects.
  ApparentPlaces places(SimTime t) const { return places(t, sensor_.effects); }
  ApparentPlaces places(SimTime t, const EffectSet& effects) const;
  /// Places with all that the scenario asks for, whatever was planned: for truth.
  ApparentPlaces true_places(SimTime t) const {
    return places(t, sensor_.unplanned ? *sensor_.unplanned : sensor_.effects);
  }
  /// Normal of the ellipsoid at a ground sensor; for a sensor in orbit, away from the Earth's
  /// centre.
  Vec<Gcrs> up(SimTime t) const;
  /// East, north and `up` at `t`; in space any east and north.
  Rotation<Enu, Gcrs> enu_from_gcrs(SimTime t) const;

  /// How fast a direction that is fixed among the stars moves over a ground sensor's sky [rad/s].
  double turns_rad_per_s(const Vec<Gcrs>& direction) const;

  /// Returns what decides which effects apply.
  SceneFacts scene() const;
  /// Planets in the field or next to it, where the effect is on.
  const std::vector<Planet>& planets() const { return bodies_.planets; }
  /// Bodies that are nearer to the axis than the camera allows; none in a view of what it believes.
  const Excluded& excluded() const { return excluded_; }
  /// Whether no light comes in: because of them, or because the camera is covered.
  bool shutter_closed() const {
    return sensor_.camera.dark || closes_shutter(sensor_.camera.exclusion, excluded_);
  }
  /// Returns the Earth's occultation of what is behind it at `t`; nothing where the effect is off.
  std::optional<EarthOccultation> earth_occultation(SimTime t) const;
  /// Light that reaches a pixel, relative to the boresight's: (0, 1].
  double illumination(PixelPosition pixel) const;

  /// The colour of moonlight on objects in the band; 1 where the effect is off.
  double moonlight_colour() const { return moonlight_colour_; }

 private:
  PointingScene pointing_scene(SimTime t) const;
  /// The attitude that the mount is told when its clock reads `reading`.
  Rotation<CameraFrame, Gcrs> commanded_camera(SimTime reading) const;

  const SensorConfig& sensor_;
  const ExposureErrors errors_;
  FrameTimes times_;
  RollingShutter shutter_;
  const StateWindow& window_;
  std::uint64_t seed_;
  EnvironmentState environment_;  // at mid exposure
  const SiteState* air_;          // at mid exposure
  std::optional<Site> site_;
  Vec<Itrs> site_m_;
  std::optional<std::size_t> platform_, target_;
  Weather weather_;
  Refraction refraction_;
  PointingScene aimed_;
  bool vignettes_ = false;
  Excluded excluded_;
  BodiesInField bodies_;
  bool daylight_ = false;
  double moonlight_colour_ = 1.0;
};

}  // namespace dmise
