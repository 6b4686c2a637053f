#include "clients/engine/like_frame.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/sky/places/atmospheric_refraction.h"

namespace dmise {
namespace {

SensorConfig chosen_sensor(const Scenario& scenario, const std::string& name) {
  if (!name.empty()) return sensor_named(scenario, name);
  if (scenario.sensors.size() != 1)
    throw ConfigError("sensor: must name one of the " + std::to_string(scenario.sensors.size()) +
                      " sensors of the scenario");
  return scenario.sensors.front();
}

SensorConfig sensor_like(SensorConfig sensor, const Likeness& frame) {
  if (!sensor.is_camera() || std::holds_alternative<PlatformConfig>(sensor.place))
    throw ConfigError(sensor.where + ": must be a camera on the ground");
  Optics& optics = sensor.camera.optics;
  optics.columns = frame.columns;
  optics.rows = frame.rows;
  optics.focal_length_m = frame.focal_length_px * optics.pixel_pitch_m;
  optics.equivalent_aperture = true;  // light is scaled by the frame's zero point
  optics.psf_fwhm_px = frame.psf_fwhm_px;
  optics.spread = {};
  sensor.camera.exclusion = {};
  sensor.pointing = PointSky{.ra_deg = frame.ra_deg, .dec_deg = frame.dec_deg};
  sensor.tracking = frame.sidereal ? Tracking::sidereal : Tracking::fixed;
  sensor.roll_deg = frame.roll_deg;
  sensor.exposure_s = frame.exposure_s;
  sensor.cadence_s = frame.exposure_s;
  sensor.first_exposure_s = 0.0;
  sensor.seeing.reset();  // it is in the width of the PSF
  sensor.weather.clouds.reset();
  sensor.instrument = {};
  sensor.accuracy = {};  // a plan without stars leaves out what displaces them, and the frame's WCS
  sensor.unplanned.reset();
  if (frame.guided) sensor.effects.force(AtmosphericRefraction::facts, false);
  sensor.detect = false;
  sensor.detector.reset();
  if (!frame.extinction) {
    const auto refraction = sensor.atmosphere.refraction;
    sensor.atmosphere = standard_atmosphere(0.0);
    sensor.atmosphere.refraction = refraction;
  }
  return sensor;
}

}  // namespace

Scenario like_frame(Scenario scenario, const Likeness& frame) {
  refuse_own_nodes(scenario.own_nodes, "an injection");
  const SimTime exposure = sim_seconds(frame.exposure_s);
  const std::int64_t ticks = std::max<std::int64_t>(
      1, std::int64_t(std::ceil(double(exposure.ns) / double(scenario.tick.ns))));
  scenario.tick.ns = std::max<std::int64_t>(1, (exposure.ns + ticks - 1) / ticks);
  scenario.duration.ns = ticks * scenario.tick.ns;
  scenario.start_utc = frame.start_utc;
  scenario.sensors = {sensor_like(chosen_sensor(scenario, frame.sensor), frame)};
  scenario.star_catalogue_path.clear();
  scenario.synthetic_stars_to_v_mag.reset();
  scenario.sensors.front().synthetic_stars_to_v_mag.reset();
  scenario.fusion.reset();
  scenario.output = {};
  return scenario;
}

}  // namespace dmise
