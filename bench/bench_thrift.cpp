#include "bench/bench_thrift.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/bench_all_sky.h"
#include "bench/figure.h"
#include "bench/timing.h"
#include "core/config/yaml/search_path.h"
#include "sensors/accuracy/scene_frames.h"
#include "sensors/scene/stage_times.h"

namespace dmise {
namespace {

constexpr int turns = 3;
constexpr double share_of_frame = 0.01;  // less is no stage to predict

SensorConfig planned_for(SensorConfig sensor, const Accuracy& accuracy) {
  sensor.accuracy = accuracy;
  sensor.detect = false;
  return sensor;
}

/// The fastest of some frames of each accuracy, made in turns.
struct Raced {
  std::vector<double> seconds;
  std::vector<std::map<std::string, StageTime>> stages;
};

Raced race(const SceneFrames& frames, const std::vector<Accuracy>& accuracies) {
  const CostFactors factors = load_cost_factors(cost_factors_path());
  std::vector<std::unique_ptr<FramePipeline>> chains;
  for (const auto& accuracy : accuracies)
    chains.push_back(frames.pipeline(planned_for(frames.sensor(), accuracy), false));
  Raced raced{std::vector<double>(accuracies.size(), 1e30), {}};
  raced.stages.resize(accuracies.size());
  for (int turn = 0; turn < turns; ++turn)
    for (std::size_t i = 0; i < chains.size(); ++i) {
      if (turn > 0 && !frames.can_repeat())
        chains[i] = frames.pipeline(planned_for(frames.sensor(), accuracies[i]), false);
      const double start = thread_seconds();
      FrameProducts frame = chains[i]->run(frames.times(), frames.states());
      const double seconds = thread_seconds() - start;
      if (seconds < raced.seconds[i]) {
        raced.seconds[i] = seconds;
        raced.stages[i] = stage_times(frame.plan, frame.times, factors);
      }
      chains[i]->give_back(std::move(frame.counts));
    }
  return raced;
}

/// Counts stages whose time, predicted for this machine, is within a factor of 1.5 of the measured.
struct Predictions {
  int stages = 0, good = 0;

  void take(const std::map<std::string, StageTime>& measured, double frame_s, bool print) {
    for (const auto& [name, time] : measured) {
      if (time.measured_s < share_of_frame * frame_s) continue;
      const bool is_good =
          time.predicted_s <= 1.5 * time.measured_s && time.predicted_s >= time.measured_s / 1.5;
      ++stages;
      good += is_good;
      if (print)
        std::printf("  %-22s %10.3f ms, predicted %10.3f ms%s\n", name.c_str(),
                    1e3 * time.measured_s, 1e3 * time.predicted_s, is_good ? "" : "  beyond 1.5");
    }
  }
};

}  // namespace

void measure_thrift(bool json) {
  const auto directory =
      std::filesystem::temp_directory_path() / ("dmise-thrift-" + std::to_string(getpid()));
  std::filesystem::create_directories(directory);
  const std::string home = home_directory() + "/launch/scenarios/accuracy-";
  struct Case {
    const char* figure;
    std::string scenario;
    double target;
    bool draft;
  };
  Threads one(1);
  Predictions predictions;
  for (const Case& c : {Case{"all_sky_thrift", all_sky_scenario(directory), 1.0 / 8.0, true},
                        Case{"space_thrift", home + "space.yaml", 1.0 / 4.0, false},
                        Case{"resolved_thrift", home + "resolved.yaml", 1.0 / 3.0, false}}) {
    if (c.scenario.empty()) continue;
    const Scenario scenario = load_scenario(c.scenario);
    const SceneFrames frames(scenario, scenario.sensors[0].name, 1, one);
    std::vector<Accuracy> accuracies{reference_accuracy(), standard_accuracy()};
    if (c.draft) accuracies.push_back(draft_accuracy());
    const Raced raced = race(frames, accuracies);
    print_figure({c.figure, raced.seconds[1] / raced.seconds[0], "1", "", 0, c.target, true}, json);
    if (c.draft) print_figure({"draft_all_sky_s", raced.seconds[2], "s", "", 0, 0.10, true}, json);
    for (std::size_t i = 1; i < accuracies.size(); ++i) {
      if (!json)
        std::printf("%s, %s: %.4f s of a thread\n", c.figure, accuracies[i].name.c_str(),
                    raced.seconds[i]);
      predictions.take(raced.stages[i], raced.seconds[i], !json);
    }
  }
  if (predictions.stages > 0)
    print_figure({"predicted_within_1_5", double(predictions.good) / predictions.stages, "1", "", 0,
                  0.9, false},
                 json);
  std::filesystem::remove_all(directory);
}

}  // namespace dmise
