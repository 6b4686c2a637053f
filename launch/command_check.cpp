#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/config/make_clock.h"
#include "core/optics/psf_plan.h"
#include "core/orbit/interpolation_error.h"
#include "launch/commands.h"
#include "nodes/environment/environment_actor.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/pipeline/make_sensor.h"

namespace dmise {
namespace {

/// Who draws. OpenGL is asked, so that a machine without it is found out now.
std::string evaluator_of(const EffectSet& effects) {
  if (effects.snapshots() == 0) return "drawn analytically, along the path";
  const std::string count = std::to_string(effects.snapshots()) + " snapshots, ";
  if (!effects.drawn_by_opengl()) return count + "drawn analytically";
  return count + "drawn by " + GlEvaluator().description();
}

void check(const std::string& path) {
  const Scenario scenario = load_scenario(path);
  const Clock clock = make_clock(scenario);
  const auto population = load_objects(scenario, clock);
  check_sensors(scenario, population.roster);
  for (const auto& note : population.notes) std::printf("note: %s\n", note.c_str());
  for (const auto& warning : clock.warnings(scenario.duration))
    std::printf("note: %s\n", warning.c_str());
  for (const auto& sensor : scenario.sensors) {
    const PsfPlan plan = plan_psf(sensor.camera.optics, sensor.camera.band.centre_m, sensor.seeing,
                                  sensor.exposure_s);
    std::printf("%s: points by %s: %s\n", sensor.name.c_str(), name(plan.method), plan.why.c_str());
    if (!sensor.detect)
      std::printf("%s: detection off: frames are reported, nothing is looked for in them\n",
                  sensor.name.c_str());
    std::printf("%s: %s\n", sensor.name.c_str(), evaluator_of(sensor.effects).c_str());
  }
  if (!population.roster.objects.empty())
    std::printf("objects between ticks: %s\n",
                interpolation_text(scenario.interpolation, scenario.tick.seconds()).c_str());
  std::printf("%s: %zu objects, %zu sensors, %lld ticks of %g s: no errors\n", path.c_str(),
              population.roster.objects.size(), scenario.sensors.size(),
              static_cast<long long>(scenario.last_tick()), scenario.tick.seconds());
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  auto* command =
      app.add_subcommand("check", "Reads a scenario and all that it names; runs nothing");
  command->add_option("scenario", *path, "scenario (YAML)")->required();
  command->callback([path] { check(*path); });
}

}  // namespace dmise
