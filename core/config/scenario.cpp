#include "core/config/scenario.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/config/band_wavelengths.h"
#include "core/config/camera_config.h"
#include "core/config/detector_config.h"
#include "core/config/optics_config.h"
#include "core/config/output_config.h"
#include "core/config/pointing_config.h"
#include "core/config/search_path.h"
#include "core/config/yaml_reader.h"
#include "core/optics/psf_plan.h"
#include "core/optics/pupil_sampling.h"
#include "core/orbit/interpolation_error.h"
#include "core/sky/airmass.h"
#include "core/sky/sun_moon.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

SiteConfig read_site(const YamlValue& value) {
  if (value.is_scalar()) {
    const std::string path = find_preset("sites", value.text(), value.file());
    if (path.empty()) {
      const std::string hint = nearest_name(value.text(), preset_names("sites"));
      value.fail("no such site" + (hint.empty() ? "" : ", did you mean " + hint + "?"));
    }
    return read_site(YamlValue::load(path));
  }
  YamlMap map(value);
  SiteConfig site;
  site.name = map.text_or("name", "");
  map.find("source");  // for people
  site.latitude_deg = map.number("latitude_deg", Bounds::between(-90.0, 90.0));
  site.longitude_deg = map.number("longitude_deg", Bounds::between(-180.0, 360.0));
  site.height_m = map.number_or("height_m", 0.0, Bounds::between(-500.0, 9000.0));
  read_surroundings(map, site.surroundings);
  map.done();
  return site;
}

void read_effects(const YamlValue& value, EffectSet& effects) {
  YamlMap map(value);
  for (std::size_t i = 0; i < effect_count; ++i) {
    const auto effect = static_cast<Effect>(i);
    if (const auto flag = map.find(facts(effect).name)) effects.set(effect, flag->flag());
  }
  if (const auto both = map.find("aberration")) {
    effects.set(Effect::annual_aberration, both->flag());
    effects.set(Effect::diurnal_aberration, both->flag());
  }
  constexpr int usual_snapshots = 16;
  const auto integration = map.find("integration");
  const bool analytic = integration && integration->choice({"analytic", "snapshots"}) == "analytic";
  if (integration) effects.set_snapshots(analytic ? 0 : usual_snapshots);
  if (analytic) effects.draw_by_opengl(false);
  if (const auto evaluator = map.find("evaluator")) {
    effects.draw_by_opengl(evaluator->choice({"analytic", "opengl"}) == "opengl");
    if (effects.drawn_by_opengl() && analytic) evaluator->fail("needs integration: snapshots");
    if (effects.drawn_by_opengl() && effects.snapshots() == 0)
      effects.set_snapshots(usual_snapshots);
  }
  if (const auto count = map.find("snapshots")) {
    if (effects.snapshots() == 0) count->fail("needs integration: snapshots", false);
    effects.set_snapshots(int(count->integer(1, 100000)));
  }
  map.done();
}

/// Trails are one parabola each: over 10 deg they are still within 1e-4 of a focal length.
constexpr double most_turn_deg = 10.0;

/// Of a camera fixed to the horizon's grid; of one that follows the sky the zenith's, 1.
double airmass_of(const Pointing& pointing) {
  const auto* fixed = std::get_if<PointHorizon>(&pointing);
  return fixed ? std::max(1.0, airmass(fixed->elevation_deg * deg)) : 1.0;
}

/// Sky, air and weather: the sensor's own, else its site's, else the usual ones.
void read_sensor_surroundings(YamlMap& map, SensorConfig& sensor) {
  const auto* site = std::get_if<SiteConfig>(&sensor.place);
  Surroundings around = site ? site->surroundings : Surroundings{};
  const auto old_key = map.find("extinction_mag_per_airmass");
  if (!site)
    for (const auto& ground_only : {map.find("atmosphere"), map.find("weather")})
      if (ground_only) ground_only->fail("is for a sensor on the ground", false);
  if (old_key) around.atmosphere = standard_atmosphere(old_key->number(Bounds::between(0.0, 5.0)));
  read_surroundings(map, around);
  sensor.sky = around.sky ? *around.sky : sky_preset(site ? "dark" : "space");
  sensor.atmosphere = around.atmosphere ? *around.atmosphere : standard_atmosphere(0.17);
  sensor.weather = around.weather.value_or(WeatherConfig{});
}

// Refuses what no kernel can be made of: a complaint "a.b: reason" at that key, or at the last one
// on the way to it that this file has (a camera may be a preset).
void check_point_spread(const YamlValue& value, const SensorConfig& sensor) {
  const Camera& camera = sensor.camera;
  try {
    const PsfPlan plan =
        plan_psf(camera.optics, camera.band.centre_m, sensor.seeing, sensor.exposure_s);
    if (plan.method == PointSpread::Method::direct && sensor.effects.drawn_by_opengl())
      throw ConfigError(
          "effects.evaluator: opengl draws points by deposit or transform; this "
          "camera's are summed directly (optics.method)");
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

SensorConfig read_sensor(const YamlValue& value, const EffectSet& effects, bool detect,
                         SimTime duration) {
  YamlMap map(value);
  SensorConfig sensor;
  sensor.effects = effects;
  sensor.detect = map.flag_or("detection", detect);
  const auto name = map.require("name");
  sensor.name = name.text();
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  if (sensor.name.size() > 64 || !std::all_of(sensor.name.begin(), sensor.name.end(), allowed))
    name.fail("must be at most 64 letters, digits, - and _");
  const auto site = map.find("site");
  const auto platform = map.find("platform");
  if (bool(site) == bool(platform))
    value.fail("needs either site (on the ground) or platform (an object of the catalogue)", false);
  if (site) {
    sensor.place = read_site(*site);
  } else {
    sensor.place = PlatformConfig{platform->text()};
  }
  sensor.camera = read_camera(map.require("camera"));
  read_pointing(map.require("pointing"), bool(site), sensor);
  const auto exposure = map.require("exposure_s");
  sensor.exposure_s = exposure.number({.least = 1e-6, .most = 3600.0});
  sensor.cadence_s = map.number("cadence_s", {.least = 1e-3, .most = 86400.0});
  if (sensor.cadence_s < sensor.exposure_s) exposure.fail("must be <= cadence_s");
  check_exposure(sensor.camera, exposure);
  if (turn_rate_deg_per_s(sensor.pointing) * sensor.exposure_s > most_turn_deg)
    exposure.fail("the camera must turn by no more than 10 deg within an exposure");
  const auto first = map.find("first_exposure_s");
  if (first) sensor.first_exposure_s = first->number(Bounds::not_negative());
  if (sim_seconds(sensor.first_exposure_s + sensor.exposure_s) > duration)
    exposure.fail("the first exposure ends after the run does");
  if (const auto seeing = map.find("seeing")) {
    if (sensor.camera.optics.spread.model == PointSpread::Model::gaussian)
      seeing->fail("needs a camera with psf: diffraction", false);
    sensor.seeing = names_profile(*seeing)
                        ? read_seeing_profile(*seeing, airmass_of(sensor.pointing),
                                              sensor.atmosphere.turbulence)
                        : read_seeing(*seeing);
  }
  read_sensor_surroundings(map, sensor);
  if (sensor.atmosphere.refraction)
    sensor.effects.set(Effect::refraction, *sensor.atmosphere.refraction);
  if (const auto mask = map.find("mask_deg")) {
    if (platform) mask->fail("a mask is for a sensor on the ground", false);
    sensor.mask_deg = mask->number(Bounds::between(0.0, 89.0));
  }
  if (const auto own = map.find("effects")) read_effects(*own, sensor.effects);
  if (sensor.effects.has(Effect::sky))
    check_sky_in_band(value, sensor.sky, sensor.camera.band, bool(site));
  check_point_spread(value, sensor);
  map.done();
  return sensor;
}

/// Both ends of the run must have a Sun, so that no run stops on the way for want of one.
void check_span(const Scenario& scenario, const YamlValue& start, const YamlValue& duration) {
  const Clock clock(parse_utc(scenario.start_utc));
  const std::string span = std::to_string(ephemeris_first_year) + " to " +
                           std::to_string(ephemeris_last_year) + ", the years of the ephemeris";
  if (!ephemeris_covers(clock.tt({0}))) start.fail("must be within " + span);
  const SimTime margin = sim_seconds(1.0);  // slopes look a little beyond the last tick
  if (!ephemeris_covers(clock.tt(scenario.time_of(scenario.last_tick()) + margin)))
    duration.fail("the run must end within " + span);
}

void read_simulation(const YamlValue& value, Scenario& scenario) {
  YamlMap map(value);
  const auto start = map.require("start");
  scenario.start_utc = start.text();
  try {
    parse_utc(scenario.start_utc);
  } catch (const BeforeLeapSeconds&) {
    start.fail("must not be before 1972, when UTC was not yet whole seconds from TAI");
  } catch (const Error&) {
    start.fail("must be a UTC time such as 2018-01-21T00:30:00Z");
  }
  scenario.duration = sim_seconds(map.number("duration_s", {.least = 1e-3, .most = 3.2e8}));
  scenario.tick = sim_seconds(map.number("tick_s", {.least = 1e-6, .most = 3600.0}));
  scenario.seed = static_cast<std::uint64_t>(
      map.integer_or("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
  if (const auto order = map.find("interpolation"))
    scenario.interpolation = order_within(
        static_cast<HermiteOrder>(std::stoi(order->choice({"3", "5", "7"}))), scenario.last_tick());
  if (const auto eop = map.find("earth_orientation")) {
    scenario.earth_orientation_path = find_beside(eop->text(), value.file());
    if (scenario.earth_orientation_path.empty()) eop->fail("there is no such file");
  }
  check_span(scenario, start, map.require("duration_s"));
  map.done();
}

/// Objects between ticks must be where they are to about a metre.
void check_tick(const Scenario& scenario, const YamlValue& tick) {
  if (scenario.objects.empty() && scenario.own_objects.empty()) return;
  const double longest_s = longest_tick_s(scenario.interpolation);
  if (scenario.tick <= sim_seconds(longest_s)) return;
  const auto limit = [](HermiteOrder order) {
    return std::to_string(static_cast<int>(longest_tick_s(order))) + " s";
  };
  tick.fail("objects between ticks longer than " + limit(scenario.interpolation) +
            " are metres off by interpolation of order " +
            std::to_string(static_cast<int>(scenario.interpolation)) +
            " (simulation.interpolation: 5 allows " + limit(HermiteOrder::quintic) + ", 7 " +
            limit(HermiteOrder::septic) + ", in runs of that many ticks)");
}

void read_stars(const YamlValue& value, Scenario& scenario) {
  YamlMap map(value);
  const auto catalogue = map.require("catalogue");
  scenario.star_catalogue_named = catalogue.text();
  scenario.star_catalogue_path = scenario.star_catalogue_named == "kstars"
                                     ? find_catalogue("stars.dat")
                                     : find_beside(scenario.star_catalogue_named, value.file());
  if (scenario.star_catalogue_path.empty())
    catalogue.fail(scenario.star_catalogue_named == "kstars"
                       ? "Debian's kstars catalogue is not there; ./dmise setup fetches it"
                       : "there is no such file");
  scenario.faintest_star_mag = map.number_or("faintest_mag", 9.5, Bounds::between(-2.0, 30.0));
  map.done();
}

void read_environment(const YamlValue& value, EnvironmentConfig& environment) {
  YamlMap map(value);
  const Bounds period = Bounds::between(0.0, 3600.0);
  environment.common_every_s = map.number_or("common_every_s", 0.0, period);
  environment.site_every_s = map.number_or("site_every_s", 60.0, period);
  map.done();
}

void read_network(const YamlValue& value, NetworkConfig& network) {
  YamlMap map(value);
  network.window_ticks = static_cast<int>(map.integer_or("window_ticks", 4, 1, 10000));
  if (const auto policy = map.find("on_silent_node")) {
    const std::string name = policy->choice({"fail", "wait", "drop", "restart"});
    network.on_silent_node = name == "fail"   ? OnSilentNode::fail
                             : name == "wait" ? OnSilentNode::wait
                             : name == "drop" ? OnSilentNode::drop
                                              : OnSilentNode::restart;
  }
  network.silent_after_s = map.number_or("silent_after_s", 5.0, Bounds::between(0.1, 3600.0));
  network.restarts = static_cast<int>(map.integer_or("restarts", 5, 1, 1000000));
  network.real_time = map.number_or("real_time", 0.0, Bounds::between(0.0, 1e6));
  network.join_within_s = map.number_or("join_within_s", 30.0, Bounds::between(0.1, 86400.0));
  map.done();
}

}  // namespace

Scenario load_scenario(const std::string& path) {
  YamlMap map(YamlValue::load(path));
  Scenario scenario;
  scenario.path = path;
  read_simulation(map.require("simulation"), scenario);
  if (const auto objects = map.find("objects")) {
    auto read = read_objects(*objects, parse_utc(scenario.start_utc));
    scenario.objects = std::move(read.catalogues);
    scenario.own_objects = std::move(read.own);
    check_tick(scenario, YamlMap(map.require("simulation")).require("tick_s"));
  }
  if (const auto stars = map.find("stars")) read_stars(*stars, scenario);
  EffectSet effects;
  if (const auto value = map.find("effects")) read_effects(*value, effects);
  const bool detect = map.flag_or("detection", true);
  const auto sensors = map.require("sensors");
  std::set<std::string> names{"orbit-node", "environment-node", "positions-node", "time-master",
                              "broker"};
  for (const auto& value : sensors.list()) {
    scenario.sensors.push_back(read_sensor(value, effects, detect, scenario.duration));
    if (!names.insert(scenario.sensors.back().name).second)
      YamlMap(value).require("name").fail("another node has this name");
  }
  if (scenario.sensors.empty()) sensors.fail("needs at least one sensor", false);
  if (const auto environment = map.find("environment"))
    read_environment(*environment, scenario.environment);
  if (const auto network = map.find("network")) read_network(*network, scenario.network);
  if (const auto output = map.find("output")) scenario.output = read_output(*output);
  map.done();
  return scenario;
}

const SensorConfig& sensor_named(const Scenario& scenario, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& sensor : scenario.sensors) {
    if (sensor.name == name) return sensor;
    names.push_back(sensor.name);
  }
  const std::string hint = nearest_name(name, names);
  throw ConfigError(scenario.path + ": sensors: no sensor is named " + name +
                    (hint.empty() ? "" : ", did you mean " + hint + "?"));
}

}  // namespace dmise
