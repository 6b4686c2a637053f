#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/process_family.h"

namespace dmise {

/// All-sky sensors on the ground, 20 s exposures every 20 s, over a catalogue of 18,470 objects and
/// every star to V = 9, with four start times one tick of 5 s apart.
struct NetworkCase {
  int sensors = 100;
  int frames = 6;  // per sensor
  bool detect = false;
  double real_time = 1.0;  // simulated seconds per second; 0: as fast as possible
};

inline constexpr double network_cadence_s = 20.0;

struct NetworkRun {
  bool complete = false;
  std::string reason;  // why it failed
  long overruns = 0;   // ticks not done when the next was due
  double worst_lag_s = 0.0;
  double start_s = 0.0;                    // from launch to start
  double wall_s = 0.0;                     // from start to end
  double cpu_s = 0.0;                      // all processes in that time
  std::map<std::string, double> cpu_of_s;  // by program, all sensors together
  int frames = 0;                          // by all sensors
  double peak_pss_mb = 0.0;                // largest observed sum over all processes
  double sensor_pss_mb = 0.0;              // largest observed of one sensor
  double sensor_most_mb = 0.0;             // upper bound (`ProcessUse::max_pss_mb`)

  double cpu_s_per_frame() const { return frames > 0 ? cpu_s / frames : 0.0; }
};

std::string network_scenario(const NetworkCase& network, const std::filesystem::path& directory);

/// Launches the scenario as a process per node below `directory`, and observes it. Frames are
/// written as FITS and removed after a few seconds.
NetworkRun run_network(const NetworkCase& network, const std::filesystem::path& directory);

}  // namespace dmise
