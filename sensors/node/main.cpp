// dmise-sensor-node: runs one sensor of a scenario: renders, detects, publishes.
#include <spdlog/spdlog.h>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/plan/cost_factors.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/program/program.h"
#include "sensors/node/kept_files.h"
#include "sensors/pipeline/make_sensor.h"
#include "sensors/pipeline/recorded_plans.h"
#include "sensors/pipeline/stage_times.h"

namespace {

/// Adds up the stages of frames for the metrics of this process, if it serves any.
std::function<void(const dmise::FrameProducts&)> serve_times() {
  dmise::Metrics* metrics = dmise::Metrics::of_process();
  if (!metrics) return [](const dmise::FrameProducts&) {};
  return [metrics, figures = dmise::FrameFigures(),
          factors = dmise::load_cost_factors(dmise::cost_factors_path())](
             const dmise::FrameProducts& frame) mutable {
    for (const auto& [stage, time] : dmise::stage_times(frame.plan, frame.times, factors)) {
      figures.stages[stage].predicted_s += time.predicted_s;
      figures.stages[stage].measured_s += time.measured_s;
    }
    metrics->set(figures);
  };
}

}  // namespace

int main(int argc, char** argv) {
  dmise::return_large_blocks();
  dmise::CommonFlags flags;
  std::string config, out = "out/node", digest, plan;
  int threads = 1;
  CLI::App app(
      "Renders the frames of one sensor of a scenario, detects moving objects, publishes both.",
      "dmise-sensor-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--config", config, "scenario (YAML)")->required();
  app.add_option("--out", out, "directory of the run; this sensor writes to a subdirectory")
      ->capture_default_str();
  app.add_option("--digest", digest, "digest of the run, written into every frame");
  app.add_option("--plan", plan,
                 "run.json of a run: its frames' levels of effects instead of a plan");
  app.add_option("--threads", threads, "number of threads")->check(CLI::Range(1, 256));
  return dmise::run_program(app, flags, argc, argv, [&] {
    dmise::Scenario scenario = dmise::load_scenario(config);
    if (app.count("--seed")) scenario.seed = flags.seed;
    if (!plan.empty()) dmise::replay_plans(plan, scenario);
    if (flags.name.empty()) throw dmise::ConfigError("--name: is required: the sensor's name");
    dmise::Threads pool(threads);
    const auto sensor =
        dmise::make_sensor(scenario, flags.name, digest, out, dmise::load_stars(scenario), pool);
    if (flags.check) return 0;
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    sensor->stop_when([] { return dmise::stop_signal().is_set(); });
    dmise::KeptFrames kept(flags.name);
    sensor->when_made([&, times = serve_times()](const dmise::FrameProducts& frame) {
      times(frame);
      dmise::keep_frame(frame, scenario.output, out + "/" + flags.name, kept);
    });
    const auto end = dmise::run_node(*sensor, {.master = flags.master,
                                               .host = flags.host,
                                               .join_within_s = scenario.network.join_within_s,
                                               .stop_within_s = 1.0,
                                               .keys = flags.keys,
                                               .via = flags.via,
                                               .frames = &kept,
                                               .stop = &dmise::stop_signal()});
    if (!sensor->evaluator().empty()) spdlog::info("drawn by {}", sensor->evaluator());
    if (!sensor->renderer().empty()) spdlog::info("shapes drawn by {}", sensor->renderer());
    return end.exit_code;
  });
}
