#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/json.h"
#include "core/base/printable.h"
#include "core/config/make_clock.h"
#include "core/config/scenario.h"
#include "core/plan/plan_json.h"
#include "core/time/iso8601.h"
#include "launch/commands.h"
#include "launch/scenario_outlook.h"
#include "sensors/outlook/plan_outlook.h"

namespace dmise {
namespace {

struct ExplainOptions {
  std::string scenario, sensor;
  std::uint32_t frames = 16;
  bool json = false, all = false;
};

std::string error_text(const ErrorBound& error) {
  std::string text;
  for (const auto& kind : error_kinds) {
    const double value = error.*kind.value;
    if (value == 0.0) continue;
    if (std::isinf(value)) return "unbounded";
    text += formatted("%s%.2g %s", text.empty() ? "" : ", ", value,
                      &kind == &error_kinds[3] ? "noise" : kind.unit);
  }
  return text.empty() ? "none" : text;
}

void print_span(const PlanSpan& span, const Clock& clock, const CostFactors& factors, bool all) {
  const EffectPlan& plan = span.plan;
  std::printf("  frames %u to %u, %s to %s: predicted %.3g s a frame, error %s of %s%s\n",
              span.first_frame, span.last_frame, format_utc(clock.utc(span.start), 0).c_str(),
              format_utc(clock.utc(span.end), 0).c_str(), predicted_s(plan, factors),
              error_text(plan.error).c_str(), error_text(plan.budget).c_str(),
              plan.in_time ? "" : "; no plan is as fast as was asked");
  if (span.shutter_closed)
    std::printf(
        "    the shutter is closed: no light comes in, and the detector alone is planned\n");
  std::printf("    %-22s %-9s %9s  %-28s %s\n", "effect", "level", "cost, ms", "next lower level",
              "why");
  for (const auto& p : plan.planned) {
    if (!all && !p.decided && !p.forced) continue;
    std::printf("    %-22s %-9s %9.3f  %-28s %s\n", std::string(p.facts->name).c_str(),
                std::string(p.level_name()).c_str(), 1e3 * predicted_s(p, factors),
                p.decided && p.level > 0 ? error_text(p.cheaper).c_str() : "-",
                why(p, plan).c_str());
  }
}

void explain(const ExplainOptions& options) {
  const Scenario scenario = load_scenario(options.scenario);
  if (!options.sensor.empty()) sensor_named(scenario, options.sensor);
  const Clock clock = make_clock(scenario);
  const ScenarioInputs scene = load_scene(scenario, clock);
  const CostFactors factors = load_cost_factors(cost_factors_path());
  Threads threads(1);
  JsonWriter json;
  json.begin_object().field("scenario", printable(scenario.path)).key("sensors").begin_array();
  for (const auto& sensor : scenario.sensors) {
    if (!options.sensor.empty() && sensor.name != options.sensor) continue;
    const auto spans = plan_outlook(scenario, sensor, scene.population, clock, scene.stars.get(),
                                    threads, options.frames);
    if (options.json) {
      json.begin_object().field("sensor", sensor.name).field("accuracy", sensor.accuracy.name);
      json.key("spans").begin_array();
      for (const auto& span : spans) {
        json.begin_object().field("first_frame", span.first_frame);
        json.field("last_frame", span.last_frame);
        json.field("start", format_utc(clock.utc(span.start), 6));
        json.field("end", format_utc(clock.utc(span.end), 6));
        if (span.shutter_closed) json.field("shutter_closed", true);
        write_plan(json.key("plan"), span.plan, factors);
        json.end_object();
      }
      json.end_array().end_object();
      continue;
    }
    std::printf("%s: %s\n", sensor.name.c_str(),
                sensor.accuracy.is_planned() ? ("accuracy: " + sensor.accuracy.name).c_str()
                                             : "not planned (accuracy: off)");
    for (const auto& span : spans) print_span(span, clock, factors, options.all);
  }
  json.end_array().end_object();
  if (options.json) std::printf("%s\n", json.take().c_str());
}

}  // namespace

void add_explain_command(CLI::App& app) {
  auto options = std::make_shared<ExplainOptions>();
  auto* command = app.add_subcommand(
      "explain",
      "Shows at which level each effect runs in a sensor's frames, why, and what it costs");
  command->add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command->add_option("--sensor", options->sensor, "only this sensor");
  command->add_option("--frames", options->frames, "plan at most this many frames of each sensor")
      ->default_val(16)
      ->check(CLI::Range(1, 100000));
  command->add_flag("--all", options->all, "also effects without a choice of levels");
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([options] { explain(*options); });
}

}  // namespace dmise
