// dmise-sensor-node: runs one sensor of a scenario: renders, detects, publishes.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/mapped_file.h"
#include "core/base/files/paths.h"
#include "core/base/memory.h"
#include "core/config/scenario.h"
#include "core/image/fits_file.h"
#include "core/plan/cost_factors.h"
#include "core/products/frame_file.h"
#include "nodes/own/own_detector.h"
#include "nodes/own/own_program.h"
#include "nodes/own/own_sensor.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/program/program.h"
#include "nodes/runtime/protocol/kept_frames.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/frame/recorded_plans.h"
#include "sensors/scene/stage_times.h"

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

/// The file is whole from when it has its name on.
dmise::FrameBytes mapped(const std::string& path) {
  const auto file = std::make_shared<const dmise::MappedFile>(path);
  const auto bytes = file->bytes();
  return {file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
}

/// Adds a frame to those that are served: its FITS file in `directory` if there is one; else, while
/// somebody is there to ask, the same bytes in memory.
void keep_frame(const dmise::FrameProducts& frame, const dmise::OutputConfig& output,
                const std::string& directory, dmise::KeptFrames& kept) {
  if (output.fits && frame.counts.columns > 0) {
    kept.add(frame.report, [path = directory + "/" + dmise::frame_file_name(frame.report.frame)] {
      return mapped(path);
    });
  } else if (kept.wanted() && frame.counts.columns > 0) {
    const auto bytes = std::make_shared<const std::string>(dmise::encode_frame(
        frame.counts, frame.header, output.saturation ? &frame.flags : nullptr));
    kept.add(
        frame.report,
        [bytes] {
          return dmise::FrameBytes{bytes, *bytes};
        },
        bytes->size());
  } else {
    kept.add(frame.report, {});
  }
}

/// Makes room for the output of the program that the sensor starts, if it starts one.
void prepare_program(const dmise::Scenario& scenario, const std::string& sensor,
                     const std::string& out, bool allowed) {
  const std::string node = dmise::sensor_named(scenario, sensor).started_node();
  if (node.empty()) return;
  if (!allowed)
    dmise::refuse_programs({*std::ranges::find(scenario.own_nodes, node, &dmise::OwnNode::name)});
  dmise::make_directories(out + "/logs");
}

}  // namespace

int main(int argc, char** argv) {
  dmise::return_large_blocks();
  dmise::CommonFlags flags;
  std::string config, out = "out/node", digest, plan;
  int threads = 1;
  bool allowed = false;
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
  app.add_flag("--allow-programs", allowed, "runs the program that the scenario names");
  app.add_option("--threads", threads, "number of threads")->check(CLI::Range(1, 256));
  return dmise::run_program(app, flags, argc, argv, [&] {
    dmise::Scenario scenario = dmise::load_scenario(config);
    if (app.count("--seed")) scenario.seed = flags.seed;
    if (!plan.empty()) dmise::replay_plans(plan, scenario);
    if (flags.name.empty()) throw dmise::ConfigError("--name: is required: the sensor's name");
    dmise::Threads pool(threads);
    prepare_program(scenario, flags.name, out, allowed);
    const dmise::OwnNodeSettings settings{
        .start = dmise::start_program,
        .note = [](const std::string& line) { spdlog::warn("{}", line); },
        .stop = &dmise::stop_signal()};
    const auto sensor =
        dmise::make_sensor(scenario, flags.name, digest, out, dmise::load_stars(scenario), pool,
                           dmise::own_finder(scenario, flags.name, out, settings),
                           dmise::own_observer(scenario, flags.name, out, settings));
    if (flags.check) return 0;
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    sensor->stop_when([] { return dmise::stop_signal().is_set(); });
    dmise::KeptFrames kept(flags.name);
    sensor->when_made([&, times = serve_times()](const dmise::FrameProducts& frame) {
      times(frame);
      keep_frame(frame, scenario.output, out + "/" + flags.name, kept);
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
