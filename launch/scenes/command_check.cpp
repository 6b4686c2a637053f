#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "core/config/sensors/effect_list.h"
#include "core/orbit/interpolation_error.h"
#include "core/time/iso8601.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/process/host_names.h"
#include "launch/run/scenario_forecast.h"
#include "nodes/runtime/security/security.h"
#include "sensors/forecast/forecast_text.h"
#include "sensors/frame/make_sensor.h"

namespace dmise {
namespace {

struct CheckOptions {
  std::string scenario, out, keys;
  int hosts = 0;
  double limb_deg = 0.0;
  bool json = false;
};

/// Writes an empty file into `out` as a run would, which may have to make the directory, and
/// removes what it made. Throws `ConfigError` if that fails.
void check_directory(const std::string& out) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  std::vector<fs::path> made;  // the innermost first
  fs::path at = fs::absolute(out).lexically_normal();
  if (!at.has_filename()) at = at.parent_path();
  // What cannot be looked at, as a name that is too long, is not there: making it says why.
  const auto is_there = [&] { return fs::exists(fs::symlink_status(at, ignored)); };
  for (; !is_there() && at.has_relative_path(); at = at.parent_path()) made.push_back(at);
  if (!fs::is_directory(at, ignored))
    throw ConfigError("--out: " + at.string() + " is not a directory, got " + out);
  struct Removal {
    const std::vector<fs::path>& made;
    ~Removal() {
      for (const fs::path& directory : made) rmdir(directory.c_str());
    }
  } removal{made};
  make_directories(out, "--out");
  std::string file = out + "/.check-XXXXXX";
  const int fd = mkstemp(file.data());
  if (fd < 0) throw ConfigError("--out: " + out + ": can't be written: " + std::strerror(errno));
  close(fd);
  unlink(file.c_str());
}

/// Throws `ConfigError` if a process of a launch has no key.
void check_keys(const Scenario& scenario, const CheckOptions& options) {
  if (options.hosts > 0) check_agent_keys(scenario, options.hosts, options.keys);
  std::vector<std::string> names = nodes_of(scenario);
  names.insert(names.end(), {"time-master", broker_name, operator_name});
  for (int host = 0; host < options.hosts; ++host) names.push_back(agent_name(scenario, host));
  for (const auto& name : names) {
    read_key(options.keys, name);
    public_key_of(options.keys, name);
  }
}

/// Constructs each sensor as the run does, to find errors.
void make_sensors(const Scenario& scenario, const std::shared_ptr<const StarMap>& stars) {
  Threads threads(1);
  for (const auto& sensor : scenario.sensors) {
    make_sensor(scenario, sensor.name, "", "", stars, threads);
    if (sensor.effects.drawn_by_opengl())
      GlEvaluator().description();  // throws if there is no OpenGL
  }
}

/// Description of a sensor's evaluator, if it is not the default. Opens OpenGL, so that a machine
/// without it is noticed now.
std::string evaluator_of(const EffectSet& effects) {
  if (effects.snapshots() == 0) return "";
  const std::string count = "each frame is the sum of " + std::to_string(effects.snapshots()) +
                            (effects.snapshots() == 1 ? " snapshot" : " snapshots");
  return effects.drawn_by_opengl() ? count + ", drawn by " + GlEvaluator().description() : count;
}

/// "1.5", or "[1.5, 2, 0]".
std::string text_of(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += formatted("%s%g", text.empty() ? "" : ", ", number);
  return numbers.size() == 1 ? text : "[" + text + "]";
}

/// The effects of a sensor's frames, with their parameters.
std::string effects_text(const SensorConfig& sensor, const SceneFacts& scene) {
  std::string text;
  for (const EffectFacts* effect : effects_in(sensor, scene)) {
    std::string parameters;
    for (const auto& [key, numbers] : parameters_in(sensor, *effect))
      parameters +=
          (parameters.empty() ? " (" : ", ") + std::string(key) + " = " + text_of(numbers);
    text += "  " + std::string(effect->name) + ": " + std::string(effect->what) + parameters +
            (parameters.empty() ? "\n" : ")\n");
  }
  return text;
}

/// The facts of a scenario that decide which effects run in the frames of `sensor`.
SceneFacts facts_of(const Scenario& scenario, const SensorConfig& sensor, bool has_stars) {
  SceneFacts scene = scene_facts(sensor);
  scene.stars = has_stars;
  scene.shapes = have_shapes(scenario.objects, scenario.own_objects);
  scene.glints = have_glints(scenario.objects, scenario.own_objects);
  return scene;
}

/// Sensors with the same effects and parameters together, in the order of the scenario.
void print_effects(const Scenario& scenario, bool has_stars) {
  std::vector<std::pair<std::string, std::string>> groups;  // names of sensors, their effects
  for (const auto& sensor : scenario.sensors) {
    if (!sensor.is_camera()) continue;
    const std::string text = effects_text(sensor, facts_of(scenario, sensor, has_stars));
    const auto group =
        std::ranges::find(groups, text, &std::pair<std::string, std::string>::second);
    if (group == groups.end())
      groups.emplace_back(sensor.name, text);
    else
      group->first += ", " + sensor.name;
  }
  for (const auto& [names, text] : groups)
    std::printf("effects of %s:\n%s", names.c_str(), text.c_str());
}

void write_effects(JsonWriter& json, const Scenario& scenario, bool has_stars) {
  json.key("effects").begin_object();
  for (const auto& sensor : scenario.sensors) {
    if (!sensor.is_camera()) continue;
    json.key(sensor.name).begin_array();
    for (const EffectFacts* effect : effects_in(sensor, facts_of(scenario, sensor, has_stars))) {
      json.begin_object().field("name", effect->name).field("what", effect->what);
      json.key("parameters").begin_object();
      for (const auto& [key, numbers] : parameters_in(sensor, *effect))
        numbers.size() == 1 ? json.field(key, numbers[0]) : json.list(key, numbers);
      json.end_object().end_object();
    }
    json.end_array();
  }
  json.end_object();
}

/// What is known of paths between ticks: of element sets by measurement, of a node's objects not.
void print_interpolation(const Scenario& scenario) {
  std::printf("objects between ticks: %s\n",
              interpolation_text(scenario.interpolation, scenario.tick.seconds()).c_str());
  for (const OwnNode& node : scenario.own_nodes)
    if (node.role == OwnNodeRole::actor)
      std::printf(
          "objects of %s between ticks: cubics join states %g s apart, by an error that "
          "depends on the node; the run notes more than 1 m\n",
          node.name.c_str(), double(node.period_ticks) * scenario.tick.seconds());
}

void print_text(const Scenario& scenario, const ScenarioForecast& forecast, bool has_stars) {
  for (const auto& note : forecast.notes) std::printf("note: %s\n", printable(note, 4000).c_str());
  for (const auto& sensor : forecast.sensors) {
    for (const auto& line : lines_of(sensor)) std::printf("%s\n", line.c_str());
    const SensorConfig& config = sensor_named(scenario, sensor.sensor);
    if (const std::string evaluator = evaluator_of(config.effects); !evaluator.empty())
      std::printf("%s: %s\n", sensor.sensor.c_str(), evaluator.c_str());
    if (!config.detect)
      std::printf("%s: detection off: frames are reported without detections\n",
                  sensor.sensor.c_str());
  }
  print_effects(scenario, has_stars);
  if (forecast.objects > 0) print_interpolation(scenario);
  for (const auto& warning : forecast.warnings)
    std::printf("warning: %s\n", printable(warning, 4000).c_str());
  const std::size_t warnings = forecast.warnings.size();
  const std::string warned = ", " + counted(warnings, "warning");
  std::printf("%s: %s, %s, %s of %g s: no errors%s\n", printable(scenario.path).c_str(),
              counted(forecast.objects, "object").c_str(),
              counted(scenario.sensors.size(), "sensor").c_str(),
              counted(std::size_t(scenario.last_tick()), "tick").c_str(), scenario.tick.seconds(),
              warnings > 0 ? warned.c_str() : "");
}

void print_json(const Scenario& scenario, const ScenarioForecast& forecast, const Clock& clock,
                bool has_stars) {
  JsonWriter json;
  json.begin_object().field("scenario", printable(scenario.path));
  json.field("start_utc", format_utc(clock.utc({0}), 6));
  // Divided, so that 60 s are 60.
  json.field("duration_s", double(scenario.duration.ns) / 1e9);
  json.field("tick_s", double(scenario.tick.ns) / 1e9);
  json.field("objects", forecast.objects);
  json.key("sensors").begin_array();
  for (const auto& sensor : forecast.sensors) write_json(json, sensor, clock);
  json.end_array();
  write_effects(json, scenario, has_stars);
  for (const auto& [key, lines] :
       {std::pair{"notes", &forecast.notes}, std::pair{"warnings", &forecast.warnings}}) {
    json.key(key).begin_array();
    for (const auto& line : *lines) json.value(printable(line, 4000));
    json.end_array();
  }
  std::printf("%s\n", json.end_object().take().c_str());
}

void check(const CheckOptions& options) {
  const Scenario scenario = load_scenario(options.scenario);
  if (!options.out.empty()) check_directory(options.out);
  if (!options.keys.empty()) check_keys(scenario, options);
  const Clock clock = make_clock(scenario);
  const ScenarioInputs scene = load_scene(scenario, clock);
  make_sensors(scenario, scene.stars);
  const auto forecast =
      scenario_forecast(scenario, scene, clock, {.min_limb_angle_rad = options.limb_deg * deg});
  if (options.json)
    print_json(scenario, forecast, clock, scene.stars != nullptr);
  else
    print_text(scenario, forecast, scene.stars != nullptr);
}

void add_check_options(CLI::App& command) {
  auto options = std::make_shared<CheckOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command.add_flag("--json", options->json, "print one JSON object");
  command.add_option("--out", options->out, "also check that products can be written there");
  auto* keys =
      command.add_option("--keys", options->keys,
                         "also check that this directory has the key of every process of a launch");
  command
      .add_option("--hosts", options->hosts,
                  "with --keys: also of this number of agents, as in a launch")
      ->default_val(0)
      ->check(CLI::Range(0, 10000))
      ->needs(keys);
  add_number_option(command, "--limb-deg", options->limb_deg, 0.0, 180.0,
                    "warn of cameras in orbit that point nearer to the Earth's limb");
  command.callback([options] { check(*options); });
}

}  // namespace

Command check_command() {
  return {.group = CommandGroup::scenarios,
          .summary = "Reads a scenario and its files, reports what each sensor will see, and warns",
          .add_options = add_check_options};
}

}  // namespace dmise
