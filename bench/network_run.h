#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/process_family.h"

namespace dmise {

/// All-sky sensors on the ground, 20 s of exposure every 20 s, over a catalogue of 18,470 objects
/// and every star to V = 9; their shutters open at four instants, a tick of 5 s apart.
struct NetworkCase {
  int sensors = 100;
  int frames = 6;  // of each sensor
  bool detect = false;
  double real_time = 1.0;  // simulated seconds a second; 0: as fast as possible
};

inline constexpr double network_cadence_s = 20.0;

struct NetworkRun {
  bool complete = false;
  std::string reason;  // why not
  long overruns = 0;   // ticks not over when the next was due
  double worst_lag_s = 0.0;
  double start_s = 0.0;                    // from the launch until all were ready
  double wall_s = 0.0;                     // from there to the end
  double cpu_s = 0.0;                      // of all processes meanwhile
  std::map<std::string, double> cpu_of_s;  // the same by program, sensors together
  int frames = 0;                          // made by all sensors
  double peak_pss_mb = 0.0;                // largest sum over all processes that was seen
  double sensor_pss_mb = 0.0;              // the most that was seen of one sensor
  double sensor_most_mb = 0.0;             // bound of what was not seen (`ProcessUse::most_pss_mb`)

  double cpu_s_per_frame() const { return frames > 0 ? cpu_s / frames : 0.0; }
};

std::string network_scenario(const NetworkCase& network, const std::filesystem::path& directory);

/// Has this program launch the scenario as a process per node below `directory`, and watches.
/// Frames are written as FITS and removed when they are a few seconds old.
NetworkRun run_network(const NetworkCase& network, const std::filesystem::path& directory);

}  // namespace dmise
