#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/config/make_clock.h"
#include "core/config/scenario.h"
#include "core/plan/plan_json.h"
#include "core/time/iso8601.h"
#include "launch/command/command.h"
#include "launch/run/scenario_forecast.h"
#include "sensors/forecast/forecast_text.h"
#include "sensors/forecast/plan_forecast.h"

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

/// Everything about the plan of a span.
void print_span(const PlanSpan& span, const Clock& clock, const CostFactors& factors) {
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
  for (const auto& p : plan.planned)
    std::printf("    %-22s %-9s %9.3f  %-28s %s\n", std::string(p.facts->name).c_str(),
                std::string(p.level_name()).c_str(), 1e3 * predicted_s(p, factors),
                p.decided && p.level > 0 ? error_text(p.cheaper).c_str() : "-",
                why(p, plan).c_str());
}

struct ExplainedSensor {
  std::string name, accuracy, limit;
  std::vector<PlanSpan> spans;
};

/// One line of a sensor: what its plans have in common.
void print_plans(const ExplainedSensor& sensor, const CostFactors& factors) {
  double min_s = INFINITY, max_s = 0.0;
  int closed = 0, late = 0;
  for (const PlanSpan& span : sensor.spans) {
    const double cost_s = predicted_s(span.plan, factors);
    min_s = std::min(min_s, cost_s);
    max_s = std::max(max_s, cost_s);
    closed += span.shutter_closed;
    late += !span.plan.in_time;
  }
  std::printf("%s: %s", sensor.name.c_str(), sensor.accuracy.c_str());
  if (!sensor.limit.empty()) std::printf("; %s", sensor.limit.c_str());
  if (!sensor.spans.empty()) {
    std::printf("; frames %u to %u have %zu plan%s, predicted %.3g",
                sensor.spans.front().first_frame, sensor.spans.back().last_frame,
                sensor.spans.size(), sensor.spans.size() == 1 ? "" : "s", min_s);
    if (max_s > 1.005 * min_s) std::printf(" to %.3g", max_s);
    std::printf(" s a frame without detection and files");
  }
  if (closed > 0) std::printf("; in %d the shutter is closed", closed);
  if (late > 0) std::printf("; in %d no plan is as fast as was asked", late);
  std::printf("\n");
}

/// Levels of the effects that have a choice, a row each: the lowest and the highest of all plans.
void print_levels(std::span<const ExplainedSensor> sensors) {
  std::vector<std::string> effects;
  std::map<std::pair<std::string, std::size_t>, std::vector<std::string>> levels;
  for (std::size_t k = 0; k < sensors.size(); ++k)
    for (const PlanSpan& span : sensors[k].spans)
      for (const auto& p : span.plan.planned) {
        if (!p.decided && !p.forced) continue;
        const std::string effect(p.facts->name), level(p.level_name());
        if (std::ranges::find(effects, effect) == effects.end()) effects.push_back(effect);
        auto& seen = levels[{effect, k}];
        if (std::ranges::find(seen, level) == seen.end()) seen.push_back(level);
      }
  if (effects.empty()) return;
  std::printf("\n%-22s", "effect");
  for (const auto& sensor : sensors) std::printf(" %-16s", sensor.name.c_str());
  for (const std::string& effect : effects) {
    std::printf("\n%-22s", effect.c_str());
    for (std::size_t k = 0; k < sensors.size(); ++k) {
      const auto found = levels.find({effect, k});
      std::string text;
      if (found != levels.end())
        for (const std::string& level : found->second) text += (text.empty() ? "" : "|") + level;
      std::printf(" %-16s", text.empty() ? "-" : text.c_str());
    }
  }
  std::printf("\n");
}

void explain(const ExplainOptions& options) {
  Scenario scenario = load_scenario(options.scenario);
  keep_cameras(scenario, "dmise explain");
  if (!options.sensor.empty()) sensor_named(scenario, options.sensor);
  const Clock clock = make_clock(scenario);
  const ScenarioInputs scene = load_scene(scenario, clock);
  const CostFactors factors = load_cost_factors(cost_factors_path());
  Threads threads(1);
  JsonWriter json;
  std::vector<ExplainedSensor> explained;
  json.begin_object().field("scenario", printable(scenario.path)).key("sensors").begin_array();
  for (const auto& sensor : scenario.sensors) {
    if (!options.sensor.empty() && sensor.name != options.sensor) continue;
    const auto spans = plan_forecast(scenario, sensor, scene.population, clock, scene.stars.get(),
                                     threads, options.frames);
    const SensorForecast forecast = sensor_forecast(scenario, sensor, scene.population, clock,
                                                    scene.stars, threads, {.max_frames = 0});
    if (options.json) {
      json.begin_object().field("sensor", sensor.name).field("accuracy", sensor.accuracy.name);
      if (forecast.mid_run) json.field("limiting_magnitude", forecast.mid_run->point_limit_v_mag);
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
    explained.push_back({sensor.name,
                         sensor.accuracy.is_planned() ? "accuracy: " + sensor.accuracy.name
                                                      : "not planned (accuracy: off)",
                         limiting_magnitude_text(forecast), spans});
    print_plans(explained.back(), factors);
    if (options.all)
      for (const auto& span : spans) print_span(span, clock, factors);
  }
  if (!options.json && !options.all) {
    constexpr std::size_t across = 6;
    for (std::size_t k = 0; k < explained.size(); k += across)
      print_levels(std::span(explained).subspan(k, std::min(across, explained.size() - k)));
    std::printf(
        "\nlimiting magnitude: %s\n--all shows each plan, with cost, error and reason of every "
        "effect\n",
        limiting_magnitude_meaning().c_str());
  }
  json.end_array().end_object();
  if (options.json) std::printf("%s\n", json.take().c_str());
}

void add_explain_options(CLI::App& command) {
  auto options = std::make_shared<ExplainOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command.add_option("--sensor", options->sensor, "only this sensor");
  command.add_option("--frames", options->frames, "plan at most this many frames of each sensor")
      ->default_val(16)
      ->check(CLI::Range(1, 100000));
  command.add_flag("--all", options->all, "each plan, with cost, error and reason of every effect");
  command.add_flag("--json", options->json, "print one JSON object");
  command.callback([options] { explain(*options); });
}

}  // namespace

Command explain_command() {
  return {.group = CommandGroup::scenarios,
          .summary =
              "Shows at which level each effect runs in a sensor's frames, why, and what it costs",
          .add_options = add_explain_options};
}

}  // namespace dmise
