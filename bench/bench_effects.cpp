#include "bench/bench_effects.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench_thrift.h"
#include "bench/effect_trial.h"
#include "bench/figure.h"
#include "bench/whole_field.h"
#include "core/base/files/json.h"

namespace dmise {
namespace {

struct Options {
  int scenes = 300;
  std::uint64_t seed = 1;
  int only = 0, fields = 2;
  bool every_level = false, no_thrift = false;
  std::string keep, effect;
};
Options options;

constexpr double share_that_counts = 0.1;  // part of a budget: a looser bound of less costs nothing

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool is_of_sources(const ErrorKind& kind) {
  return kind.value == &ErrorBound::photometry_mag || kind.value == &ErrorBound::position_px;
}

/// Bound over measured error, where the bound takes up much of the budget.
std::optional<double> tightness_of(const LevelTrial& level, const ErrorKind& kind) {
  const double bound = level.bound.*kind.value, budget = level.budget.*kind.value;
  if (!(budget > 0.0) || !std::isfinite(bound) || bound <= share_that_counts * budget ||
      !(is_of_sources(kind) ? level.has_sources : level.has_background))
    return std::nullopt;
  return bound / std::max(1e-12, level.measured.*kind.value);
}

/// One line for each budget and bound that does not hold.
void print_faults(const SceneTrial& trial, bool json) {
  const auto print = [&](const std::string& what, const ErrorKind& kind, double limit,
                         double measured) {
    std::fprintf(json ? stderr : stdout, "scene %d (%s): %s: %s %.4g %s, measured %.4g\n",
                 trial.scene.number, trial.scene.what.c_str(), what.c_str(), kind.key, limit,
                 kind.unit, measured);
  };
  for (const auto& kind : error_kinds) {
    for (const auto& plan : trial.plans)
      if (!plan.within(kind))
        print("budget of " + plan.accuracy, kind, plan.budget.*kind.value,
              plan.measured.*kind.value);
    for (const auto& level : trial.levels)
      if (!level.holds(kind))
        print("bound of " + level.effect + ":" + level.level, kind, level.bound.*kind.value,
              level.measured.*kind.value);
  }
}

/// What was found of one level of one effect, over all scenes.
struct Row {
  int trials = 0, faults = 0;
  double largest_bound[4] = {}, largest_measured[4] = {};
  std::vector<double> tightness[4];
};

void print_table(const std::vector<SceneTrial>& trials, bool json) {
  std::map<std::string, Row> rows;
  for (const auto& trial : trials)
    for (const auto& level : trial.levels) {
      Row& row = rows[level.effect + ":" + level.level];
      ++row.trials;
      bool holds = true;
      for (std::size_t k = 0; k < std::size(error_kinds); ++k) {
        const auto value = error_kinds[k].value;
        holds = holds && level.holds(error_kinds[k]);
        if (std::isfinite(level.bound.*value))
          row.largest_bound[k] = std::max(row.largest_bound[k], level.bound.*value);
        row.largest_measured[k] = std::max(row.largest_measured[k], level.measured.*value);
        if (const auto ratio = tightness_of(level, error_kinds[k]))
          row.tightness[k].push_back(*ratio);
      }
      row.faults += !holds;
    }
  if (!json) {
    std::printf("%-28s %6s %6s", "effect:level", "scenes", "faults");
    for (const auto& kind : error_kinds) std::printf("  %-32s", kind.key);
    std::printf("\n%-28s %6s %6s", "", "", "");
    for (std::size_t k = 0; k < std::size(error_kinds); ++k)
      std::printf("  %-32s", "bound     measured  b/m x trials");
    std::printf("\n");
  }
  for (const auto& [name, row] : rows) {
    if (json) {
      JsonWriter writer;
      writer.begin_object().field("effect", name).field("scenes", row.trials);
      writer.field("faults", row.faults);
      for (std::size_t k = 0; k < std::size(error_kinds); ++k) {
        writer.key(error_kinds[k].key).begin_object().field("bound", row.largest_bound[k]);
        writer.field("measured", row.largest_measured[k]);
        writer.field("bound_over_measured", median(row.tightness[k])).end_object();
      }
      std::printf("%s\n", writer.end_object().take().c_str());
      continue;
    }
    std::printf("%-28s %6d %6d", name.c_str(), row.trials, row.faults);
    for (std::size_t k = 0; k < std::size(error_kinds); ++k)
      std::printf("  %-9.3g %-9.3g %-5.3g x %-4zu", row.largest_bound[k], row.largest_measured[k],
                  median(row.tightness[k]), row.tightness[k].size());
    std::printf("\n");
  }
}

void print_figures(const std::vector<SceneTrial>& trials, bool json) {
  const double count = double(std::max<std::size_t>(1, trials.size()));
  const auto share = [&](bool (SceneTrial::*good)() const) {
    return double(std::ranges::count_if(trials, good)) / count;
  };
  std::vector<double> plan_s, tightness;
  for (const auto& trial : trials) {
    if (trial.plan_s > 0.0) plan_s.push_back(trial.plan_s);
    for (const auto& level : trial.levels)
      for (const auto& kind : error_kinds)
        if (const auto ratio = tightness_of(level, kind)) tightness.push_back(*ratio);
  }
  print_figure(
      {"scenes_within_budget", share(&SceneTrial::within_budgets), "1", "", 0, 0.99, false}, json);
  print_figure({"scenes_bounds_hold", share(&SceneTrial::bounds_hold), "1", "", 0, 0.99, false},
               json);
  print_figure({"bound_tightness", median(tightness), "1", "", 0, 5.0, true}, json);
  print_figure({"plan_ms", 1e3 * median(plan_s), "ms", "", 0, 0.3, true}, json);
}

/// Whole fields of every shipped camera, numbered after the scenes.
void try_fields(const std::filesystem::path& directory, Threads& threads, bool json,
                std::vector<SceneTrial>& trials) {
  int number = options.scenes;
  for (const std::string& camera : shipped_cameras())
    for (int i = 0; i < options.fields; ++i) {
      const auto place = directory / ("field-" + std::to_string(++number));
      trials.push_back(try_whole_field(camera, number, options.seed, place, threads));
      print_faults(trials.back(), json);
      if (options.keep.empty()) std::filesystem::remove_all(place);
    }
}

}  // namespace

void add_effects_options(CLI::App& app) {
  app.add_option("--scenes", options.scenes, "scenes that are drawn; 0: none")
      ->default_val(300)
      ->check(CLI::Range(0, 1000000));
  app.add_option("--seed", options.seed, "of the scenes")->default_val(1);
  app.add_option("--only", options.only, "this scene alone, from 1 on")
      ->check(CLI::Range(1, 1000000));
  app.add_flag("--every-level", options.every_level, "also levels that no plan took");
  app.add_option("--effect", options.effect, "only this effect, at each of its levels");
  app.add_flag("--no-thrift", options.no_thrift, "without the time that plans save");
  app.add_option("--fields", options.fields, "whole fields of each shipped camera; 0: none")
      ->default_val(2)
      ->check(CLI::Range(0, 100000));
  app.add_option("--keep", options.keep, "directory for the scenes, to run them otherwise");
}

int bench_effects(bool json) {
  if (!json) std::setvbuf(stdout, nullptr, _IOLBF, 0);
  namespace fs = std::filesystem;
  const fs::path directory =
      options.keep.empty()
          ? fs::temp_directory_path() / ("dmise-effects-" + std::to_string(getpid()))
          : fs::path(options.keep);
  Threads threads(1);
  std::vector<SceneTrial> trials;
  const int first = std::max(1, options.only);
  const int last = options.only > 0 ? options.only : options.scenes;
  for (int number = first; number <= last; ++number) {
    const fs::path place = directory / ("scene-" + std::to_string(number));
    try {
      trials.push_back(try_scene(
          number,
          {.seed = options.seed, .every_level = options.every_level, .effect = options.effect},
          place, threads));
    } catch (const std::exception& e) {
      throw std::runtime_error("effects: scene " + std::to_string(number) + " of seed " +
                               std::to_string(options.seed) + ": " + e.what());
    }
    print_faults(trials.back(), json);
    if (options.keep.empty()) fs::remove_all(place);
  }
  if (options.only == 0 && options.effect.empty()) try_fields(directory, threads, json, trials);
  if (options.keep.empty()) fs::remove_all(directory);
  if (!trials.empty()) {
    print_table(trials, json);
    print_figures(trials, json);
  }
  if (!options.no_thrift && options.only == 0) measure_thrift(json);
  const auto good = std::ranges::count_if(trials, [](const SceneTrial& trial) {
    return trial.within_budgets() && trial.bounds_hold();
  });
  return double(good) >= 0.99 * double(trials.size()) ? 0 : 1;
}

}  // namespace dmise
