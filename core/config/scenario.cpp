#include "core/config/scenario.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/config/fly_objects.h"
#include "core/config/fusion_config.h"
#include "core/config/node_names.h"
#include "core/config/output_config.h"
#include "core/config/own_node_roles.h"
#include "core/config/place_deputies.h"
#include "core/config/scenario_text.h"
#include "core/config/schema.h"
#include "core/config/sensors/effects_config.h"
#include "core/config/sensors/interpolation_choice.h"
#include "core/config/sensors/sensor_config.h"
#include "core/config/star_catalogues.h"
#include "core/config/yaml/bound_key.h"
#include "core/config/yaml/distribution.h"
#include "core/config/yaml/search_path.h"
#include "core/orbit/interpolation_error.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr double max_kept_s =
    18 * 86400.0;  // longest run whose orbits are kept: forces reach 20 days

const Section& simulation_section() {
  static const Section section{
      "simulation", "When the run begins, how long it lasts and in which steps.",
      with_keys(
          {required("start", form::time(), "UTC at which the run begins, not before 1972."),
           required("duration_s", form::number(1e-3, 3.2e8),
                    "Length of the run [s], a whole number of ticks."),
           required("tick_s", form::number(1e-6, 3600.0),
                    "Time between ticks [s], at which the state of the world is published."),
           bound<&Scenario::seed>("seed", form::seed(), "Seed of all random numbers."),
           optional(
               "interpolation", form::choice({"3", "5", "7"}),
               "Order of the polynomials that join objects between ticks. By default the lowest "
               "that the sensors' accuracy allows."),
           optional(
               "earth_orientation", form::text(),
               "An IERS finals2000A file of UT1 - UTC and polar motion. Without it they are 0.")},
          earth_keys())};
  return section;
}

const Section& stars_section() {
  static const Section section{
      "stars",
      "The stars behind the objects.",
      {optional("catalogue", form::text({"kstars", "tycho2"}),
                "`kstars` (V to 9), `tycho2` (that and Tycho-2, V to 11; `dmise catalogue fetch "
                "tycho2` makes it), or a file: HYG in CSV, "
                "Yale BSC5, kstars' own form, or an index that `dmise catalogue index` has made.",
                default_star_catalogue),
       optional("variables", form::text(),
                "The General Catalogue of Variable Stars (`gcvs5.txt`, or `gcvs_cat.dat` of CDS "
                "B/gcvs). Its stars then have the brightness of the instant. Without it all are "
                "constant."),
       bound<&Scenario::faintest_star_mag>("faintest_mag", form::number(-2.0, 30.0),
                                           "Faintest star of the catalogue that is drawn [V mag]."),
       optional("synthetic_to", form::number(0.0, 21.0) | form::choice({"limit", "off"}),
                "Where the catalogue ends, stars go on by counts to this magnitude [V mag]; "
                "`limit`: to the faintest that stands out of a frame's noise.",
                "off")}};
  return section;
}

const Section& environment_section() {
  static const Section section{
      "environment",
      "How often the environment node publishes.",
      {bound<&EnvironmentConfig::common_every_s>(
           "common_every_s", form::number(0.0, 3600.0),
           "Interval of Sun, Moon and Earth [s]. 0: every tick."),
       bound<&EnvironmentConfig::site_every_s>("site_every_s", form::number(0.0, 3600.0),
                                               "Interval of each site's weather [s].")}};
  return section;
}

const Section& network_section() {
  static const Section section{
      "network",
      "How the processes of a launched run work together.",
      {bound<&NetworkConfig::window_ticks>("window_ticks", form::integer(1, 10000),
                                           "Ticks by which a node may run ahead of the slowest."),
       bound<&NetworkConfig::on_silent_node>("on_silent_node",
                                             form::choice({"fail", "wait", "drop", "restart"}),
                                             "What is done about a node that does not answer."),
       bound<&NetworkConfig::silent_after_s>(
           "silent_after_s", form::number(0.1, 3600.0),
           "Time without an answer after which a node is silent [s]."),
       bound<&NetworkConfig::restarts>("restarts", form::integer(1, 1000000),
                                       "Most restarts of a node, with `on_silent_node: restart`."),
       bound<&NetworkConfig::real_time>(
           "real_time", form::number(0.0, 1e6),
           "Simulated seconds per second of wall-clock time. 0: as fast as possible."),
       bound<&NetworkConfig::join_within_s>("join_within_s", form::number(0.1, 86400.0),
                                            "Time within which all nodes must have joined [s]."),
       bound<&NetworkConfig::publish_states>(
           "publish_states", form::flag(),
           "Publishes states of all objects for subscribers that are not nodes of the "
           "scenario."),
       bound<&NetworkConfig::sensors_propagate>(
           "sensors_propagate", form::flag(),
           "Sensors propagate the objects in their field. Off: they take published states.")}};
  return section;
}

/// Checks that the ephemeris covers both ends of the run, so that no run stops half way.
void check_span(const Scenario& scenario, const YamlValue& start, const YamlValue& duration) {
  const Clock clock(parse_utc(scenario.start_utc));
  const std::string span = std::to_string(ephemeris_first_year) + " to " +
                           std::to_string(ephemeris_last_year) + ", the years of the ephemeris";
  if (!ephemeris_covers(clock.tt({0}))) start.fail("must be within " + span);
  const SimTime margin = sim_seconds(1.0);  // slopes need times after the last tick
  if (!ephemeris_covers(clock.tt(scenario.time_of(scenario.last_tick()) + margin)))
    duration.fail("the run must end within " + span);
}

/// Checks that the duration is a whole number of ticks.
void check_whole_ticks(const Scenario& scenario, const YamlValue& duration) {
  const std::int64_t tick_ns = scenario.tick.ns, whole = scenario.duration.ns / tick_ns;
  if (whole * tick_ns == scenario.duration.ns) return;
  const auto seconds_of = [&](std::int64_t ticks) {
    return formatted("%.12g", SimTime{ticks * tick_ns}.seconds());
  };
  duration.fail("must be a whole number of ticks (tick_s: " + seconds_of(1) +
                "): " + (whole > 0 ? seconds_of(whole) + " or " : "") + seconds_of(whole + 1));
}

void read_simulation(const YamlValue& value, Scenario& scenario) {
  YamlMap map(value, simulation_section());
  const auto start = map.require("start");
  scenario.start_utc = start.text();
  start.time();  // checks it
  scenario.duration = sim_seconds(map.number("duration_s"));
  scenario.tick = sim_seconds(map.number("tick_s"));
  check_whole_ticks(scenario, map.require("duration_s"));
  read_bound(map, scenario);
  if (const auto order = map.find("interpolation")) order->choice();
  if (const auto eop = map.find("earth_orientation")) {
    scenario.earth_orientation_path = eop->existing_file();
    try {
      IersTable::read_finals2000a(scenario.earth_orientation_path);
    } catch (const Error& e) {
      eop->fail(e.what(), false);
    }
  }
  scenario.earth = read_earth(map);
  check_span(scenario, start, map.require("duration_s"));
  map.done();
}

/// Sets the order of interpolation between ticks: what `simulation` says, else by the sensors'
/// budgets. Checks that it is accurate to about a metre.
void set_interpolation(Scenario& scenario, YamlMap simulation) {
  if (const auto order = simulation.find("interpolation")) {
    scenario.interpolation = static_cast<HermiteOrder>(std::stoi(order->text()));
  } else if (!scenario.objects.empty() || !scenario.own_objects.empty()) {
    scenario.interpolation = choose_interpolation(scenario.sensors, scenario.tick.seconds());
  }
  scenario.interpolation = order_within(scenario.interpolation, scenario.last_tick());
  if (scenario.objects.empty() && scenario.own_objects.empty()) return;
  const auto tick = simulation.require("tick_s");
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

/// Warns of objects and models that turn too fast for the ticks.
void warn_of_attitudes(Scenario& scenario) {
  const auto warn = [&](const AttitudeConfig& attitude) {
    const auto warning = coarse_tick_warning(attitude, scenario.tick.seconds());
    if (warning && std::ranges::find(scenario.warnings, *warning) == scenario.warnings.end())
      scenario.warnings.push_back(*warning);
  };
  for (const auto& object : scenario.own_objects)
    if (object.attitude) warn(*object.attitude);
  for (const auto& [pattern, model] : models_of(scenario.objects).rules()) warn(model->attitude);
}

/// Nothing: there are none; infinity: they go to each frame's limit.
std::optional<double> read_synthetic_to(YamlMap& map) {
  const auto to = map.find("synthetic_to");
  if (to && to->is_like_number()) return to->number();
  if (!to || to->choice() == "off") return std::nullopt;
  return unbounded;
}

void read_stars(const YamlValue& value, Scenario& scenario) {
  YamlMap map(value, stars_section());
  const auto catalogue = map.find("catalogue");
  const YamlValue& where = catalogue ? *catalogue : value;
  scenario.star_catalogue_named = catalogue ? catalogue->text() : default_star_catalogue;
  scenario.star_catalogue_where = where.place();
  const char* file = star_catalogue_file(scenario.star_catalogue_named);
  scenario.star_catalogue_path = file ? find_catalogue(file) : where.existing_file();
  if (scenario.star_catalogue_path.empty())
    where.fail(missing_star_catalogue(scenario.star_catalogue_named));
  if (const auto variables = map.find("variables")) {
    scenario.star_variables_path = variables->existing_file();
    scenario.star_variables_where = variables->place();
  }
  read_bound(map, scenario);
  scenario.synthetic_stars_to_v_mag = read_synthetic_to(map);
  map.done();
}

void read_environment(const YamlValue& value, EnvironmentConfig& environment) {
  YamlMap map(value, environment_section());
  read_bound(map, environment);
  map.done();
}

void read_network(const YamlValue& value, NetworkConfig& network) {
  YamlMap map(value, network_section());
  read_bound(map, network);
  map.done();
}

/// A sensor that is cued needs a fusion, and what it is cued for: detections. It makes no exposure
/// while it slews, so that nothing may depend on all exposures before.
void check_cued(const Scenario& scenario, const SensorConfig& sensor) {
  const auto* cued = std::get_if<PointCued>(&sensor.pointing);
  if (!cued) return;
  const auto fail = [&](const char* why) { throw ConfigError(cued->where + ": " + why); };
  if (!scenario.fusion) fail("needs fusion: the fusion node gives it its tasks");
  if (!sensor.detect) fail("needs detection: on");
  if (sensor.effects.has(Persistence::facts) && sensor.camera.detector.persistence_fraction > 0.0)
    fail("persistence needs all exposures; set effects: {persistence: off}");
}

}  // namespace

const Section& scenario_section() {
  static const Section section{
      "scenario",
      "A scenario: when, what is in space, who watches it, and what is written.",
      {required("simulation", form::map(simulation_section), "The run."),
       optional("objects", objects_forms(), "Catalogues of objects, and objects of one's own."),
       optional("nodes", own_nodes_forms(),
                "Programs of one's own that take part in the run: they move objects, detect in "
                "the frames of sensors, are sensors, or make the tracks."),
       optional("stars", form::map(stars_section), "The stars; without it there are none."),
       required("sensors", form::list(form::map(sensor_section) | form::map(own_sensor_section), 1),
                "The sensors, at least one: cameras, and sensors of one's own."),
       optional("accuracy", accuracy_forms(), "How accurate frames must be, for all sensors.",
                "standard"),
       optional("effects", effects_forms(), "Effects switched for all sensors."),
       optional("detection", form::flag(), "Whether moving objects are detected in the frames.",
                "on"),
       optional("fusion", form::flag() | form::map(fusion_section),
                "Tracks of what all sensors detect.", "off"),
       optional("environment", form::map(environment_section),
                "How often the environment is published."),
       optional("network", form::map(network_section), "How processes work together."),
       optional("output", form::map(output_section), "Files of every frame.")}};
  return section;
}

namespace {

Scenario without_distributions(const YamlValue& root) {
  refuse_distributions(root, "dmise dataset draws a value for each seed");
  return read_scenario(root);
}

}  // namespace

Scenario load_scenario(const std::string& path) {
  return without_distributions(YamlValue::load(path));
}

Scenario scenario_of_text(const std::string& text, const std::string& name) {
  return without_distributions(YamlValue::parse(text, name));
}

Scenario read_scenario(const YamlValue& root, OwnNodeModels models) {
  YamlMap map(root, scenario_section());
  Scenario scenario;
  scenario.path = root.file();
  read_simulation(map.require("simulation"), scenario);
  if (const auto objects = map.find("objects")) {
    auto read = read_objects(*objects, parse_utc(scenario.start_utc), scenario.earth);
    scenario.objects = std::move(read.catalogues);
    scenario.own_objects = std::move(read.own);
    for (const auto& object : scenario.own_objects)
      for (const auto& line : object.motion.warnings) scenario.warnings.push_back(line);
    warn_of_attitudes(scenario);
  }
  if (const auto stars = map.find("stars")) read_stars(*stars, scenario);
  EffectSet effects;
  if (const auto value = map.find("effects")) read_effects(*value, effects);
  Accuracy accuracy = standard_accuracy();
  if (const auto value = map.find("accuracy")) accuracy = read_accuracy(*value);
  const bool detect = map.flag("detection");
  const auto sensors = map.require("sensors");
  NodeNames names;
  for (const auto& value : sensors.list()) {
    if (value.is_map())
      if (const auto name = YamlMap(value).find("name"))
        if (const auto fault = names.fault_of(name->text())) name->fail(*fault);
    scenario.sensors.push_back(
        read_sensor(value, effects, accuracy, detect, scenario.duration, scenario.earth));
  }
  if (const auto nodes = map.find("nodes")) {
    for (const auto& value : nodes->list())
      if (value.is_map())
        if (const auto name = YamlMap(value).find("name"))
          if (const auto fault = names.fault_of(name->text())) name->fail(*fault);
    scenario.own_nodes = read_own_nodes(*nodes, models);
  }
  for (auto& sensor : scenario.sensors) {
    sensor.synthetic_stars_to_v_mag = scenario.synthetic_stars_to_v_mag;
    for (const auto& line : sensor.camera.warnings)
      if (std::ranges::find(scenario.warnings, line) == scenario.warnings.end())
        scenario.warnings.push_back(line);
  }
  if (scenario.sensors.empty()) sensors.fail("needs at least one sensor", false);
  set_interpolation(scenario, YamlMap(map.require("simulation")));
  if (const auto environment = map.find("environment"))
    read_environment(*environment, scenario.environment);
  if (const auto network = map.find("network")) read_network(*network, scenario.network);
  if (const auto output = map.find("output")) scenario.output = read_output(*output);
  if (const auto fusion = map.find("fusion"); fusion && !(fusion->is_scalar() && !fusion->flag())) {
    scenario.fusion = read_fusion(*fusion);
    scenario.fusion->settings.ellipsoid = scenario.earth.ellipsoid;
    if (std::ranges::none_of(scenario.sensors, &SensorConfig::detect))
      fusion->fail("needs a sensor that detects", false);
    if (scenario.fusion->settings.keep_orbits && scenario.duration.seconds() > max_kept_s)
      fusion->fail("keep_orbits is for runs of at most 18 days", false);
  }
  assign_own_nodes(scenario);
  for (const SensorConfig& sensor : scenario.sensors) check_cued(scenario, sensor);
  if (scenario.output.positions_enu && !scenario.earth.origin)
    throw ConfigError(scenario.output.positions_where + ": enu needs simulation.origin");
  map.done();
  fly_objects(scenario);
  place_deputies(scenario);
  return scenario;
}

std::optional<Site> site_of(const SensorConfig& sensor) {
  const auto* site = std::get_if<SiteConfig>(&sensor.place);
  if (!site) return std::nullopt;
  return Site{site->latitude_deg, site->longitude_deg, site->height_m, sensor.ellipsoid};
}

bool takes_states(const SensorConfig& sensor) {
  return sensor.observing &&
         (sensor.observing->truth || std::holds_alternative<PlatformConfig>(sensor.place));
}

bool Scenario::nodes_take_states() const {
  return output.positions() || !network.sensors_propagate ||
         std::ranges::any_of(sensors, takes_states);
}

void keep_cameras(Scenario& scenario, const std::string& who) {
  const std::string first = scenario.sensors.front().where;
  std::erase_if(scenario.sensors, [](const SensorConfig& sensor) { return !sensor.is_camera(); });
  if (scenario.sensors.empty()) throw ConfigError(first + ": " + who + " needs a camera");
}

const SensorConfig& sensor_named(const Scenario& scenario, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& sensor : scenario.sensors) {
    if (sensor.name == name) return sensor;
    names.push_back(sensor.name);
  }
  throw ConfigError(scenario.path + ": sensors: no sensor is named " + name +
                    did_you_mean(name, names));
}

}  // namespace dmise
