#include "core/config/sensors/sensor_config.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/sensors/band_wavelengths.h"
#include "core/config/sensors/camera_config.h"
#include "core/config/sensors/detector_config.h"
#include "core/config/sensors/effects_config.h"
#include "core/config/sensors/exclusion_config.h"
#include "core/config/sensors/instrument_config.h"
#include "core/config/sensors/optics_config.h"
#include "core/config/sensors/pointing_config.h"
#include "core/config/sensors/thermal_optics_config.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/search_path.h"
#include "core/config/yaml/yaml_reader.h"
#include "core/effects/frame_effects.h"
#include "core/optics/psf_plan.h"
#include "core/optics/psf_table.h"
#include "core/optics/pupil_sampling.h"
#include "core/sky/air/airmass.h"
#include "core/sky/places/place_effects.h"

namespace dmise {
namespace {

SiteConfig read_site(const YamlValue& value) {
  if (value.is_scalar()) return read_site(load_preset("site", value));
  YamlMap map(value, site_section());
  SiteConfig site;
  if (const auto name = map.find("name")) site.name = name->text();
  map.find("source");  // informative only
  site.latitude_deg = map.number("latitude_deg");
  site.longitude_deg = map.number("longitude_deg");
  read_bound(map, site);
  read_surroundings(map, site.surroundings);
  map.done();
  return site;
}

/// A trail is one parabola: over 10 deg it is accurate to 1e-4 of a focal length.
constexpr double max_turn_deg = 10.0;

/// Airmass of a camera at fixed azimuth and elevation; 1 for one that follows the sky.
double airmass_of(const Pointing& pointing) {
  const auto* fixed = std::get_if<PointHorizon>(&pointing);
  return fixed ? std::max(1.0, airmass(fixed->elevation_deg * deg)) : 1.0;
}

/// Sky, atmosphere and weather: the sensor's, else its site's, else the defaults.
void read_sensor_surroundings(YamlMap& map, SensorConfig& sensor) {
  const auto* site = std::get_if<SiteConfig>(&sensor.place);
  Surroundings around = site ? site->surroundings : Surroundings{};
  const auto old_key = map.find("extinction_mag_per_airmass");
  if (!site)
    for (const auto& ground_only : {map.find("atmosphere"), map.find("weather")})
      if (ground_only) ground_only->fail("is for a sensor on the ground", false);
  if (old_key) around.atmosphere = standard_atmosphere(old_key->number());
  read_surroundings(map, around);
  sensor.sky = around.sky ? *around.sky : sky_preset(site ? "dark" : "space");
  sensor.atmosphere = around.atmosphere ? *around.atmosphere : standard_atmosphere(0.17);
  sensor.weather = around.weather.value_or(WeatherConfig{});
}

/// Adds to the point spread the blur of the camera's vibration in an exposure.
void add_blur_of_vibration(YamlMap& map, SensorConfig& sensor) {
  const Vibration vibration = acting_instrument(sensor.instrument, sensor.effects);
  if (!vibration.applies()) return;
  const double blur_rad = vibration.blur_rad(sensor.exposure_s);
  Optics& optics = sensor.camera.optics;
  constexpr double widest_px = 1000.0;
  if (fwhm_per_sigma * blur_rad > widest_px * optics.pixel_angle_rad())
    map.require(Vibration::facts.name)
        .fail("its blur in an exposure must be at most 1000 px wide", false);
  if (optics.spread.model == PointSpread::Model::gaussian)
    optics.psf_fwhm_px =
        std::hypot(optics.psf_fwhm_px, fwhm_per_sigma * blur_rad / optics.pixel_angle_rad());
  else
    optics.spread.jitter_rad = std::hypot(optics.spread.jitter_rad, blur_rad);
}

/// Refuses a rolling shutter that has not finished the first frame when the run ends, or during
/// which the camera turns too far.
void check_rows(const YamlValue& exposure, const SensorConfig& sensor, double rate_deg_per_s,
                SimTime duration) {
  if (!sensor.effects.has(RollingShutter::facts)) return;
  const RollingShutter& shutter = sensor.camera.detector;
  const double delay_s = shutter.last_row_delay_s(sensor.camera.optics.rows);
  if (delay_s == 0.0) return;
  const double until_s = sensor.exposure_s + delay_s;
  if (sim_seconds(sensor.first_exposure_s + until_s) > duration)
    exposure.fail("the first exposure of the last row ends after the run does");
  if (rate_deg_per_s * until_s > max_turn_deg)
    exposure.fail("the camera must turn by no more than 10 deg until the last row is exposed");
}

/// Refuses a point spread for which no kernel is possible. An error "a.b: reason" is reported at
/// that key, or at its nearest ancestor in this file (a camera may be a preset).
void check_point_spread(const YamlValue& value, const SensorConfig& sensor) {
  const Camera& camera = sensor.camera;
  try {
    const PsfPlan plan = plan_psf(camera.optics, camera.band.centre_m, sensor.seeing,
                                  sensor.exposure_s, AirTurbulence::level(sensor.effects));
    if (sensor.effects.is_forced(AirTurbulence::facts) &&
        AirTurbulence::level(sensor.effects) == AirTurbulence::short_exposure &&
        plan.exposure == ExposureKind::lasting)
      throw ConfigError(
          "effects.turbulence: short takes one screen for each r0 / wind of the exposure, and "
          "there are more than optics.most_screens, " +
          std::to_string(camera.optics.spread.max_screens) + ": raise it or take long");
    if (plan.method == PointSpread::Method::direct && sensor.effects.drawn_by_opengl())
      throw ConfigError(
          "effects.evaluator: opengl can't draw the point sources of this camera, whose "
          "optics.method is direct; deposit and transform can be drawn");
    if (plan.method != PointSpread::Method::deposit)
      sample_pupils(camera.optics, wavelengths_of(camera.band, camera.optics.spread.wavelengths),
                    plan, sensor.seeing);
  } catch (const ConfigError& e) {
    const std::string complaint = e.what(), key = complaint.substr(0, complaint.find(':'));
    const std::string path = key.starts_with("optics.") ? "camera." + key : key;
    YamlValue at = value;
    std::size_t begin = 0;
    while (begin < path.size() && at.is_map()) {
      const std::size_t end = std::min(path.find('.', begin), path.size());
      const auto next = YamlMap(at).find(path.substr(begin, end - begin));
      if (!next) break;
      at = *next;
      begin = end + 1;
    }
    at.fail(begin > path.size() ? complaint.substr(key.size() + 2) : complaint, false);
  }
}

/// Refuses a band in which a sensor's frames can't be made.
void check_band_of_frames(const YamlValue& value, const SensorConfig& sensor, bool site) {
  if (sensor.effects.has(SkyBackground::facts))
    check_sky_in_band(value, sensor.sky, sensor.camera.band, site,
                      sensor.weather.pwv_mm || !sensor.effects.has(ThermalSky::facts));
  check_point_spread(value, sensor);
}

void read_place(YamlMap& map, const YamlValue& value, SensorConfig& sensor) {
  const auto site = map.find("site");
  const auto platform = map.find("platform");
  if (bool(site) == bool(platform))
    value.fail(
        site ? "has site and platform: give either site (on the ground) or platform (an object "
               "of the catalogue)"
             : "needs either site (on the ground) or platform (an object of the catalogue)",
        false);
  if (site)
    sensor.place = read_site(*site);
  else
    sensor.place = PlatformConfig{printable(platform->text()), platform->place()};
}

/// Reads when exposures are.
void read_exposures(YamlMap& map, SimTime duration, SensorConfig& sensor) {
  const auto exposure = map.require("exposure_s");
  sensor.exposure_s = exposure.number();
  sensor.cadence_s = map.number("cadence_s");
  if (sensor.cadence_s < sensor.exposure_s) exposure.fail("must be <= cadence_s");
  read_bound(map, sensor);
  if (sim_seconds(sensor.first_exposure_s + sensor.exposure_s) > duration)
    exposure.fail("the first exposure ends after the run does");
}

SensorConfig read_own_sensor(const YamlValue& value, SimTime duration, const EarthConfig& earth) {
  YamlMap map(value, own_sensor_section());
  SensorConfig sensor{.where = value.place()};
  sensor.ellipsoid = earth.ellipsoid;
  sensor.name = map.require("name").text();
  const YamlValue node = map.require("node");
  sensor.observing = {.node = node.text(), .where = node.place()};
  read_bound(map, *sensor.observing);
  read_place(map, value, sensor);
  read_exposures(map, duration, sensor);
  map.done();
  return sensor;
}

const Section& detection_section() {
  static const Section section{
      "detection",
      "Detection by a program of one's own, or with light curves.",
      {optional("node", form::text(), "One of `nodes`, which is asked for each frame."),
       optional("light_curves", form::flag(),
                "Whether detections of streaks have their light over time and its period. Not of a "
                "program of one's own.",
                "off")}};
  return section;
}

void read_detection(const YamlValue& value, SensorConfig& sensor) {
  if (!value.is_map()) {
    sensor.detect = value.flag();
    return;
  }
  YamlMap map(value, detection_section());
  const auto node = map.find("node");
  const auto curves = map.find("light_curves");
  if (node && curves) curves->fail("is not of a program of one's own (node)", false);
  sensor.detect = true;
  sensor.light_curves = curves && curves->flag();
  if (node) sensor.detector = {.node = node->text(), .where = node->place()};
  map.done();
}

// Keys that sensors with a camera share with those that are a program.
Key name_key() {
  return required("name", form::text(),
                  "A unique name of 1 to 64 letters, digits, - and _. It names the directory of "
                  "the sensor's products.");
}
Key site_key() {
  return optional("site", form::text(preset_names("sites")) | form::map(site_section),
                  "The place on the ground: a name (`dmise list sites`), a file, or coordinates.");
}
Key platform_key() {
  return optional("platform", form::text(),
                  "Catalogue number or name of the object that carries the sensor.");
}
Key exposure_key() {
  return required("exposure_s", form::number(1e-6, 3600.0),
                  "Length of an exposure [s], at most the cadence.");
}
Key cadence_key() {
  return required("cadence_s", form::number(1e-3, 86400.0),
                  "Time from the beginning of an exposure to that of the next [s].");
}
Key first_exposure_key() {
  return bound<&SensorConfig::first_exposure_s>(
      "first_exposure_s", form::not_negative(),
      "Beginning of the first exposure after the start of the run [s].");
}

}  // namespace

const Section& site_section() {
  static const Section section{
      "site", "A place on the ground, with what surrounds it.",
      with_keys({optional("name", form::text(), "Name of the site."),
                 optional("source", form::text(), "Where the numbers come from. It is not used."),
                 required("latitude_deg", form::number(-90.0, 90.0), "Geodetic latitude [deg]."),
                 required("longitude_deg", form::number(-180.0, 360.0), "Longitude, east [deg]."),
                 bound<&SiteConfig::height_m>("height_m", form::number(-500.0, 9000.0),
                                              "Height above the ellipsoid [m].")},
                surroundings_keys())};
  return section;
}

const Section& own_sensor_section() {
  static const Section section{
      "own_sensor",
      "A sensor of one's own: a program that says what it observes. Either `site` or `platform` is "
      "needed.",
      {name_key(),
       required("node", form::text(), "One of `nodes`, which is asked at each exposure."),
       site_key(), platform_key(), exposure_key(), cadence_key(), first_exposure_key(),
       bound<&SensorConfig::Observing::truth>(
           "truth", form::flag(),
           "Whether the program is told the true positions and velocities of all objects."),
       bound<&SensorConfig::Observing::half_angle_deg>(
           "half_angle_deg", form::above(0.0, 180.0),
           "Half angle of the cone about its boresight that contains its field [deg].")}};
  return section;
}

const Section& sensor_section() {
  static const Section section{
      "sensor", "A camera at a site or aboard an object. Either `site` or `platform` is needed.",
      with_keys(
          {name_key(), site_key(), platform_key(),
           required("camera", form::text(preset_names("cameras")) | form::map(camera_section),
                    "The camera: a name (`dmise list cameras`), a file, or its keys."),
           required("pointing", pointing_forms(), "Where the camera points."), exposure_key(),
           cadence_key(), first_exposure_key(),
           optional("detection", form::flag() | form::map(detection_section),
                    "Whether moving objects are detected in the frames, or by what program. By "
                    "default as the scenario says."),
           optional("accuracy", accuracy_forms(),
                    "How accurate frames must be. By default as the scenario says."),
           optional("effects", effects_forms(), "Effects of this sensor, after the scenario's."),
           optional("seeing", form::map(seeing_section),
                    "Turbulence, for a camera with `psf: diffraction`."),
           optional("malfunctions", form::list(form::map(malfunction_section)),
                    "What goes wrong with its devices in `dmise observatory`; nothing else is "
                    "changed by it. On the ground."),
           bound<&SensorConfig::mask_deg>(
               "mask_deg", form::number(0.0, 89.0),
               "Lowest elevation for `dmise visible` [deg], on the ground."),
           optional("extinction_mag_per_airmass", form::number(0.0, 5.0),
                    "Extinction at 550 nm: a short form of `atmosphere: {extinction: ..}`.")},
          with_keys(surroundings_keys(), instrument_keys()))};
  return section;
}

SensorConfig read_sensor(const YamlValue& value, const EffectSet& effects, const Accuracy& accuracy,
                         bool detect, SimTime duration, const EarthConfig& earth) {
  if (value.is_map() && YamlMap(value).find("node")) return read_own_sensor(value, duration, earth);
  YamlMap map(value, sensor_section());
  SensorConfig sensor;
  sensor.where = value.place();
  sensor.effects = effects;
  sensor.accuracy = accuracy;
  sensor.ellipsoid = earth.ellipsoid;
  sensor.earth_albedo = earth.albedo;
  if (const auto own = map.find("accuracy")) sensor.accuracy = read_accuracy(*own);
  const auto detection = map.find("detection");
  sensor.detect = detect;
  if (detection) read_detection(*detection, sensor);
  sensor.name = map.require("name").text();
  read_place(map, value, sensor);
  const bool site = std::holds_alternative<SiteConfig>(sensor.place);
  sensor.camera = read_camera(map.require("camera"));
  if (site) check_exclusion_on_ground(map.require("camera"), sensor.camera.exclusion);
  if (!site) check_warm_in_space(map.require("camera"), sensor.camera.optics.thermal);
  read_pointing(map.require("pointing"), site, sensor, earth.origin);
  read_instrument(map, sensor.instrument);
  read_exposures(map, duration, sensor);
  const auto exposure = map.require("exposure_s");
  check_exposure(sensor.camera, exposure);
  if (FocusDrift& drift = sensor.camera.optics.spread.drift; drift.any())
    drift.run_s = duration.seconds();
  const double rate_deg_per_s =
      turn_rate_deg_per_s(sensor.pointing) + sensor.instrument.drift_size_rad_per_s() / deg;
  if (rate_deg_per_s * sensor.exposure_s > max_turn_deg)
    exposure.fail("the camera must turn by no more than 10 deg within an exposure");
  if (const auto seeing = map.find("seeing")) {
    if (sensor.camera.optics.spread.model != PointSpread::Model::diffraction)
      seeing->fail("needs a camera with psf: diffraction", false);
    sensor.seeing = read_seeing(*seeing, airmass_of(sensor.pointing));
  }
  read_sensor_surroundings(map, sensor);
  if (sensor.atmosphere.refraction)
    sensor.effects.force(AtmosphericRefraction::facts, *sensor.atmosphere.refraction);
  if (const auto malfunctions = map.find("malfunctions")) {
    if (!site) malfunctions->fail("is for a sensor on the ground", false);
    sensor.malfunctions = read_malfunctions(*malfunctions);
  }
  if (const auto mask = map.find("mask_deg"); mask && !site)
    mask->fail("a mask is for a sensor on the ground", false);
  if (const auto own = map.find("effects")) read_effects(*own, sensor.effects);
  check_clock(map, sensor, duration);
  check_rows(exposure, sensor, rate_deg_per_s, duration);
  add_blur_of_vibration(map, sensor);
  check_band_of_frames(value, sensor, site);
  for (const Filter& filter : sensor.camera.filters) {
    SensorConfig filtered = sensor;
    filtered.camera.band = filter.band;
    check_band_of_frames(value, filtered, site);
  }
  map.done();
  return sensor;
}

}  // namespace dmise
