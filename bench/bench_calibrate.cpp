#include "bench/bench_calibrate.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/bench_all_sky.h"
#include "bench/figure.h"
#include "core/base/error.h"
#include "core/config/yaml/search_path.h"
#include "core/plan/cost_factors.h"
#include "sensors/accuracy/scene_frames.h"
#include "sensors/scene/stage_times.h"

namespace dmise {
namespace {

std::string out_path;

/// Repeats of a frame, of which the fastest counts.
constexpr int repeats = 2;

/// Adds the stages of one frame of `scenario`, predicted and measured, and which effects are in
/// each.
void measure(const std::string& path, std::map<std::string, StageTime>& stages,
             std::map<std::string, std::string>& stages_by_effect) {
  Threads one(1);
  const Scenario scenario = load_scenario(path);
  const SceneFrames frames(scenario, scenario.sensors[0].name, 1, one);
  SensorConfig sensor = frames.sensor();
  sensor.accuracy = standard_accuracy();
  sensor.detect = false;
  auto chain = frames.pipeline(sensor, false);
  std::map<std::string, StageTime> best;
  for (int k = 0; k < repeats; ++k) {
    if (k > 0 && !frames.can_repeat()) chain = frames.pipeline(sensor, false);
    FrameProducts frame = chain->run(frames.times(), frames.states());
    for (const auto& [name, time] : stage_times(frame.plan, frame.times, {})) {
      auto [known, first] = best.try_emplace(name, time);
      known->second.measured_s = std::min(known->second.measured_s, time.measured_s);
    }
    for (const PlannedEffect& effect : frame.plan.planned)
      stages_by_effect[std::string(effect.facts->name)] = stage_of(effect.facts->name);
    chain->give_back(std::move(frame.counts));
  }
  for (const auto& [name, time] : best) {
    stages[name].predicted_s += time.predicted_s;
    stages[name].measured_s += time.measured_s;
  }
}

}  // namespace

void add_calibrate_options(CLI::App& app) {
  app.add_option("--out", out_path, "file to write instead of that in the user's cache");
}

int bench_calibrate(bool json) {
  namespace fs = std::filesystem;
  const std::string path = out_path.empty() ? cost_factors_path() : out_path;
  if (path.empty()) throw Error("calibrate: neither XDG_CACHE_HOME nor HOME is set; give --out");
  const std::string home = home_directory() + "/launch/scenarios/accuracy-";
  std::map<std::string, StageTime> stages;
  std::map<std::string, std::string> stages_by_effect;
  for (const char* name : {"all-sky", "space", "resolved"})
    measure(home + name + ".yaml", stages, stages_by_effect);
  CostFactors factors;
  for (const auto& [effect, stage] : stages_by_effect) {
    const StageTime& time = stages[stage];
    if (time.predicted_s > 0.0 && time.measured_s > 0.0)
      factors[effect] = std::clamp(time.measured_s / time.predicted_s, 1e-3, 1e3);
  }
  std::error_code ignored;
  if (const auto parent = fs::path(path).parent_path(); !parent.empty())
    fs::create_directories(parent, ignored);
  std::ofstream file(path);
  file << cost_factors_text(factors);
  if (!file.flush()) throw Error("calibrate: " + path + " can't be written");
  for (const auto& [effect, factor] : factors)
    print_figure({"cost_factor_" + effect, factor, "1"}, json);
  std::fprintf(stderr, "calibrate: wrote %s\n", path.c_str());
  return 0;
}

}  // namespace dmise
