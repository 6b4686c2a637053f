#include "bench/bench_network.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>

#include "bench/figure.h"
#include "bench/network_run.h"
#include "core/base/error.h"
#include "core/config/yaml/search_path.h"
#include "nodes/runtime/program/command_line.h"

namespace dmise {
namespace {

struct Options {
  int sensors = 100;
  int frames = 6;
  double real_time = 1.0;
  bool without_detection_only = false, detecting_only = false;
};
Options options;

constexpr int max_tries = 5;
constexpr int pilot_sensors = 8, pilot_frames = 3;
constexpr double share_at_first = 0.96;  // part of the processors' time that the first try fills
constexpr double share_detecting = 0.9;
// Factors between tries; with detection frames are long compared to the ticks of their deadline.
constexpr double step = 0.95, step_detecting = 0.87;

double cores() { return double(std::max(1u, std::thread::hardware_concurrency())); }

/// Number of sensors whose frames need `share` of the processors' time.
int sensors_within(double share, double cpu_s_per_frame, double real_time) {
  return int(share * cores() * network_cadence_s / real_time / cpu_s_per_frame);
}

NetworkRun measure(const NetworkCase& network, const std::filesystem::path& directory) {
  std::fprintf(stderr, "network: %d sensors, %d frames each, detection %s, ", network.sensors,
               network.frames, network.detect ? "on" : "off");
  network.real_time > 0.0 ? std::fprintf(stderr, "%g x real time\n", network.real_time)
                          : std::fprintf(stderr, "as fast as possible\n");
  const NetworkRun run = run_network(network, directory);
  if (!run.complete) throw Error("network: " + run.reason);
  std::fprintf(
      stderr,
      "network: started in %.0f s, ran %.0f s, %.3f s of processors a frame, %ld overruns, "
      "worst lag %.2f s, %.0f MB\n",
      run.start_s, run.wall_s, run.cpu_s_per_frame(), run.overruns, run.worst_lag_s,
      run.peak_pss_mb);
  for (const auto& [program, seconds] : run.cpu_of_s)
    std::fprintf(stderr, "network: %s: %.2f s, %.4f s a frame\n", program.c_str(), seconds,
                 seconds / run.frames);
  return run;
}

struct Kept {
  int sensors = 0;  // largest number that kept up; 0: none
  NetworkRun run;   // with that number, or the last one
};

/// The largest number, from `sensors` down, that keeps up; none needs more than `share`.
Kept keep_up(NetworkCase network, double share, const std::filesystem::path& directory) {
  const double by = network.detect ? step_detecting : step;
  Kept kept;
  for (int tried = 0; tried < max_tries && network.sensors > 0; ++tried) {
    kept.run = measure(network, directory);
    if (kept.run.overruns == 0) {
      kept.sensors = network.sensors;
      break;
    }
    const int affordable = sensors_within(share, kept.run.cpu_s_per_frame(), network.real_time);
    network.sensors = std::min(int(by * network.sensors), affordable);
  }
  return kept;
}

void print(const std::string& suffix, const Kept& kept, double target, bool json) {
  const NetworkRun& run = kept.run;
  print_figure({"sensors_real_time" + suffix, double(kept.sensors), "1", "", 0, target}, json);
  print_figure({"network_frame_cpu" + suffix + "_s", run.cpu_s_per_frame(), "s"}, json);
  print_figure({"network_cpu_share" + suffix, run.cpu_s / run.wall_s / cores(), "1"}, json);
  print_figure({"network_overruns" + suffix, double(run.overruns), "1"}, json);
  print_figure({"network_start" + suffix + "_s", run.start_s, "s"}, json);
}

void print_memory(const NetworkRun& run, bool json) {
  print_figure({"memory_gb", run.peak_pss_mb / 1e3, "GB", "", 0, 12, true}, json);
  print_figure({"sensor_pss_mb", run.sensor_pss_mb, "MB", "", 0, 80, true}, json);
  print_figure({"sensor_pss_bound_mb", run.sensor_most_mb, "MB"}, json);
}

}  // namespace

void add_network_options(CLI::App& command) {
  command.add_option("--sensors", options.sensors, "without detection; reduced until they keep up")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_option("--frames", options.frames, "frames per sensor")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--real-time", options.real_time, "simulated seconds per second")
      ->check(number_between(0.01, 1000.0))
      ->capture_default_str();
  const auto without = command.add_flag("--without-detection-only", options.without_detection_only,
                                        "skip the runs with detection");
  command.add_flag("--detection-only", options.detecting_only, "skip the runs without detection")
      ->excludes(without);
}

int bench_network(bool json) {
  if (find_catalogue("stars.dat.gz").empty()) return 0;
  const auto directory =
      std::filesystem::temp_directory_path() / ("dmise-bench-network-" + std::to_string(getpid()));
  NetworkCase network{.sensors = options.sensors,
                      .frames = options.frames,
                      .detect = false,
                      .real_time = options.real_time};
  if (!options.detecting_only) {
    const Kept without = keep_up(network, share_at_first, directory);
    print("", without, 100, json);
    print_memory(without.run, json);
  }
  if (!options.without_detection_only) {
    network.detect = true;
    const NetworkRun pilot = measure(
        {.sensors = pilot_sensors, .frames = pilot_frames, .detect = true, .real_time = 0.0},
        directory);
    network.sensors =
        std::max(1, sensors_within(share_detecting, pilot.cpu_s_per_frame(), network.real_time));
    print("_detecting", keep_up(network, share_detecting, directory), 0, json);
  }
  std::filesystem::remove_all(directory);
  return 0;
}

}  // namespace dmise
