#pragma once
#include <cstdint>
#include <vector>

#include "core/base/sim_time.h"

namespace dmise {

/// What became of one task of a simulated network.
struct CueOutcome {
  std::uint32_t id = 0, track = 0;
  std::uint32_t object = 0;  // that its detections are mostly of; 0: none is known
  int exposures = 0;         // that were made
  int first_detection = 0;   // the exposure of the first detection of its target, from 1; 0: none
  double slew_deg = 0.0, slew_s = 0.0, in_field = 0.0;
  double sigma_before_m = 0.0;  // error of the target's position when the task was given
  double sigma_after_m = 0.0;   // some ticks after its end
  SimTime given, on_target, end;
};

struct CueTrialSettings {
  std::uint64_t seed = 1;
  int ticks = 36;              // lasting 5 s each
  std::size_t objects = 3000;  // none is known to the network
  double detection_probability = 0.83;
};

/// Eight all-sky sites 400 km apart at 20 arcsec and two 0.4 m telescopes at 1 arcsec (5 deg/s,
/// 3 deg/s^2, 2 s to settle, a field of 1.3 deg), by simulation of detections alone: what the sites
/// find in no catalogue the telescopes are cued to. Tasks by id.
std::vector<CueOutcome> cue_trial(const CueTrialSettings& settings);

}  // namespace dmise
