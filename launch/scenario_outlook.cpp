#include "launch/scenario_outlook.h"

#include <algorithm>

#include "core/base/printable.h"
#include "core/config/own_node_roles.h"
#include "launch/notes.h"
#include "sensors/outlook/outlook_text.h"

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

}  // namespace

ScenarioOutlook scenario_outlook(const Scenario& scenario, const ScenarioInputs& scene,
                                 const Clock& clock, const OutlookOptions& options) {
  const ObjectPopulation& population = scene.population;
  ScenarioOutlook outlook{.objects = population.roster.objects.size()};
  for (const OwnNode& node : scenario.own_nodes) outlook.notes.push_back(node_text(scenario, node));
  append(outlook.notes, population.notes);
  append(outlook.notes, clock.warnings(scenario.duration));
  append(outlook.warnings, scenario.warnings);
  append(outlook.warnings, catalogue_warnings(scenario, population));
  Threads threads(1);
  for (const auto& sensor : scenario.sensors) {
    if (!sensor.is_camera()) continue;
    outlook.sensors.push_back(
        sensor_outlook(scenario, sensor, population, clock, scene.stars, threads, options));
    append(outlook.warnings, outlook.sensors.back().warnings);
  }
  return outlook;
}

void print_outlook(const Scenario& scenario, const ScenarioInputs& scene, const Clock& clock) {
  constexpr std::size_t most_sensors = 16;
  Scenario first = scenario;
  first.sensors.resize(std::min(scenario.sensors.size(), most_sensors));
  const auto outlook =
      scenario_outlook(first, scene, clock, {.most_frames = 3, .most_states = 500'000});
  for (const auto& note : outlook.notes) print_note(note);
  for (const auto& sensor : outlook.sensors) print_note(sensor.sensor + ": " + short_text(sensor));
  for (const auto& warning : outlook.warnings) print_warning(warning);
  if (const std::size_t others = scenario.sensors.size() - first.sensors.size())
    print_note("dmise check reports the same for " + std::to_string(others) + " more sensors");
}

}  // namespace dmise
