#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/orbit/attitude.h"
#include "core/photometry/magnitude_system.h"

namespace dmise {

/// A measured brightness of a satellite, and where all were.
struct ObservedLight {
  std::size_t track = 0;      // index within its set, in order of time
  std::uint32_t object = 0;   // satellite, by a number of its set; 0: not told
  double measured_mag = 0.0;  // above the atmosphere, in the system of its set
  AttitudeScene scene;        // seconds of the set; satellite and Sun
  Vec<Gcrs> observer_m;
  double sunlit = 1.0;  // fraction of the Sun that the Earth leaves
};

/// Measurements of one family in order of time.
struct ObservedSet {
  std::string file;
  MagnitudeSystem system = MagnitudeSystem::vega;
  std::vector<ObservedLight> lights;
  std::size_t tracks = 0;
  std::size_t left_out = 0;  // lights in penumbra, and of passes whose orbit is not found
  double worst_rms_m = 0.0;  // greatest rms in a pass: ranges about its orbit
};

/// Magnitudes of single exposures with height, elevation and azimuth, as those of Starlink by
/// Pomenis (AB, Mount Lemmon). A track is a night. A file need not be in order of time. Throws
/// `ConfigError` with the line.
ObservedSet read_exposures(const std::string& path);

/// Light curves of MMT-9 with range and phase (V of Vega). A circular orbit of the stated
/// inclination that agrees with both says where the satellite was (pass_orbit.h).
ObservedSet read_light_curves(const std::string& path, double inclination_rad, double height_m);

}  // namespace dmise
