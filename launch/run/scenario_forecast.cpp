#include "launch/run/scenario_forecast.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/config/own_node_roles.h"
#include "core/config/star_catalogues.h"
#include "core/effects/frame_effects.h"
#include "core/sky/stars/star_map.h"
#include "core/sky/variables/variable_stars.h"
#include "launch/command/notes.h"
#include "sensors/forecast/forecast_text.h"

namespace dmise {
namespace {

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const auto& line : more)
    if (std::find(all.begin(), all.end(), line) == all.end()) all.push_back(line);
}

/// "node gnc runs `python3 gnc.py` in DIR; it says where inspector is"
std::string node_text(const Scenario& scenario, const OwnNode& node) {
  std::vector<std::string> moved, turned;
  for (const OwnObject& object : scenario.own_objects) {
    if (is_moved_by(node, object)) moved.push_back(object.name);
    if (is_turned_by(node, object)) turned.push_back(object.name);
  }
  std::string text = "node " + node.name +
                     (node.run.empty() ? " is elsewhere"
                                       : " runs `" + command_text(node) + "` in " + node.directory);
  std::vector<std::string> searched;
  for (const SensorConfig& sensor : scenario.sensors)
    if (sensor.detector && sensor.detector->node == node.name) searched.push_back(sensor.name);
  if (!searched.empty()) text += "; it detects in frames of " + joined(searched);
  std::vector<std::string> observing;
  for (const SensorConfig& sensor : scenario.sensors)
    if (sensor.observing && sensor.observing->node == node.name)
      observing.push_back(sensor.name + (sensor.observing->truth ? " (told the truth)" : ""));
  if (!observing.empty()) text += "; it is the sensor " + joined(observing);
  if (node.role == OwnNodeRole::tracker) text += "; it makes the tracks";
  if (!moved.empty()) text += "; it moves " + joined(moved);
  if (!turned.empty()) text += "; it turns " + joined(turned);
  return text;
}

/// How many objects have the default sphere, which is no object's measure; empty: none has.
std::string default_spheres_text(const Scenario& scenario, const ObjectRoster& roster) {
  std::set<std::uint32_t> shaped;
  for (const OwnObject& object : scenario.own_objects)
    if (object.geometry) shaped.insert(object.catalogue_number);
  const ObjectModels& models = models_of(scenario.objects);
  const auto count = std::ranges::count_if(roster.objects, [&](const ObjectInfo& object) {
    return object.sphere == DiffuseSphere{} && !shaped.contains(object.catalogue_number) &&
           !models.of(object.name, object.catalogue_number);
  });
  if (count == 0) return "";
  const DiffuseSphere usual;
  return formatted(
      "%zu of %s %s a diffuse sphere of %g m and albedo %g, the default: magnitudes are not to be "
      "believed without facts, a model, or radius_m and albedo",
      std::size_t(count), counted(roster.objects.size(), "object").c_str(),
      count == 1 ? "is" : "are each", usual.radius_m, usual.albedo);
}

/// The faintest magnitude to which a sensor draws synthetic stars; -infinity: none does.
double synthetic_to_v_mag(const ScenarioForecast& forecast) {
  double to_v_mag = -std::numeric_limits<double>::infinity();
  for (const SensorForecast& sensor : forecast.sensors)
    for (const FrameForecast& frame : sensor.frames)
      if (frame.synthetic && frame.synthetic->stars >= 0.5)
        to_v_mag = std::max(to_v_mag, frame.synthetic->to_v_mag);
  return to_v_mag;
}

/// The faintest limiting magnitude of the sensors; -infinity: none is known.
double limit_v_mag(const ScenarioForecast& forecast) {
  double limit = -std::numeric_limits<double>::infinity();
  for (const SensorForecast& sensor : forecast.sensors)
    if (sensor.mid_run) limit = std::max(limit, sensor.mid_run->point_limit_v_mag.value_or(limit));
  return limit;
}

/// Where the scenario's catalogue of stars ends, if its sensors see farther; else empty.
std::string end_of_catalogue_text(const Scenario& scenario, const StarMap& stars,
                                  const ScenarioForecast& forecast) {
  const double end_v_mag =
      std::min(scenario.faintest_star_mag, stars.summary.faintest_filled_v_mag);
  const std::string end = formatted("stars of %s end at V = %g",
                                    printable(scenario.star_catalogue_named).c_str(), end_v_mag);
  if (const double to = synthetic_to_v_mag(forecast); to > end_v_mag) {
    const bool can_be_real = scenario.star_catalogue_named == default_star_catalogue;
    return end + formatted("; fainter ones are synthetic, by star counts, to V = %g at most", to) +
           (can_be_real ? "; `catalogue: tycho2` has real ones to V = 11 (`dmise catalogue fetch "
                          "tycho2` makes it)"
                        : "");
  }
  if (!scenario.synthetic_stars_to_v_mag && limit_v_mag(forecast) > end_v_mag + 1.0)
    return end +
           formatted(", and the sensors see to V = %.1f: `synthetic_to: limit` continues them",
                     limit_v_mag(forecast));
  return "";
}

/// Whether a sensor would show stars if there were a catalogue.
bool draws_stars(const SensorConfig& sensor) {
  return sensor.is_camera() && sensor.effects.has(StarBackground::facts);
}

/// What varies among the stars of a catalogue, and how many do not although they are variable.
std::string variables_text(const Scenario& scenario, const VariableStars& variables) {
  std::size_t varying = 0, eclipsing = 0;
  for (const VariableStars::Star& star : variables.stars()) {
    varying += star.varies();
    eclipsing += star.curve.shape == LightCurveShape::separate_eclipses ||
                 star.curve.shape == LightCurveShape::touching_eclipses;
  }
  const std::size_t found = variables.stars().size();
  return formatted(
      "variable stars: %s has %zu of the %zu; %zu vary (%zu eclipsing, %zu pulsating), and %zu "
      "have "
      "the catalogue's magnitude: of another type, or without period, epoch or amplitude",
      printable(scenario.star_catalogue_named).c_str(), found, variables.records(), varying,
      eclipsing, varying - eclipsing, found - varying);
}

std::string problems_text(const VariableStars& variables) {
  const std::size_t others = variables.problems() - 1;
  return variables.problem() + " (left out" +
         (others > 0 ? ", as are " + counted(others, "more line") : "") + ")";
}

}  // namespace

ScenarioForecast scenario_forecast(const Scenario& scenario, const ScenarioInputs& scene,
                                   const Clock& clock, const ForecastOptions& options) {
  const ObjectPopulation& population = scene.population;
  ScenarioForecast forecast{.objects = population.roster.objects.size()};
  for (const OwnNode& node : scenario.own_nodes)
    forecast.notes.push_back(node_text(scenario, node));
  append(forecast.notes, population.notes);
  if (const auto text = default_spheres_text(scenario, population.roster); !text.empty())
    forecast.notes.push_back(text);
  append(forecast.notes, clock.warnings(scenario.duration));
  append(forecast.warnings, scenario.warnings);
  append(forecast.warnings, catalogue_warnings(scenario, population));
  Threads threads(1);
  for (const auto& sensor : scenario.sensors) {
    if (!sensor.is_camera()) continue;
    forecast.sensors.push_back(
        sensor_forecast(scenario, sensor, population, clock, scene.stars, threads, options));
    append(forecast.warnings, forecast.sensors.back().warnings);
  }
  if (!scene.stars && std::ranges::any_of(scenario.sensors, draws_stars))
    forecast.notes.push_back(
        "no stars are drawn: `stars: {catalogue: kstars}` draws those to V = 9, and `synthetic_to: "
        "limit` those beyond");
  if (scene.stars)
    if (const auto text = end_of_catalogue_text(scenario, *scene.stars, forecast); !text.empty())
      forecast.notes.push_back(text);
  if (scene.stars && scene.stars->variables) {
    const VariableStars& variables = *scene.stars->variables;
    forecast.notes.push_back(variables_text(scenario, variables));
    if (variables.problems() > 0) forecast.warnings.push_back(problems_text(variables));
  }
  return forecast;
}

void print_forecast(const Scenario& scenario, const ScenarioInputs& scene, const Clock& clock) {
  constexpr std::size_t max_sensors = 16;
  Scenario first = scenario;
  first.sensors.resize(std::min(scenario.sensors.size(), max_sensors));
  const auto forecast =
      scenario_forecast(first, scene, clock, {.max_frames = 3, .max_states = 500'000});
  for (const auto& note : forecast.notes) print_note(note);
  for (const auto& sensor : forecast.sensors) print_note(sensor.sensor + ": " + short_text(sensor));
  for (const auto& warning : forecast.warnings) print_warning(warning);
  if (const std::size_t others = scenario.sensors.size() - first.sensors.size())
    print_note("dmise check reports the same for " + std::to_string(others) + " more sensors");
}

}  // namespace dmise
