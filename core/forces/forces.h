#pragma once
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/orbit/two_body.h"
#include "core/time/clock.h"

namespace dmise {

/// Forces that act on an object.
struct ForceSettings {
  int zonals = 4;         // highest zonal harmonic of the Earth: 0 (two-body), 2, 3 or 4
  bool drag = true;       // acts on states with drag_m2_per_kg != 0
  bool radiation = true;  // pressure of sunlight on states with srp_m2_per_kg != 0
  bool sun_moon = false;  // attraction of Sun and Moon as points
};

/// The Earth's axis, the Sun and the Moon at one instant. A step of propagation takes those of its
/// middle.
struct ForceInputs {
  Vec<Gcrs> pole{0, 0, 1};
  Vec<Gcrs> sun_m;
  Vec<Gcrs> moon_m;
};

/// Accelerations of an object near the Earth: two-body, zonal harmonics J2 to J4 of EGM2008 about
/// the pole of date, drag in an atmosphere that turns with the Earth and whose density falls
/// exponentially between the heights of a table, radiation pressure with a cylindrical shadow, Sun
/// and Moon. Immutable; may be shared between threads. docs/models/tracking.md has sources and
/// what is left out.
class ForceModel {
 public:
  /// Pole and bodies are tabulated within 10 days of `reference`; beyond, the values at the ends
  /// hold. Throws `Error` for settings out of range.
  ForceModel(const Clock& clock, SimTime reference, const ForceSettings& settings = {});
  /// Two-body and zonals about the z axis of GCRS, without Sun and Moon, for tests and examples.
  explicit ForceModel(const ForceSettings& settings);

  const ForceSettings& settings() const { return settings_; }
  ForceInputs surroundings(SimTime time) const;

 private:
  static constexpr double reach_s = 10 * 86400.0, node_s = 6 * 3600.0;
  struct Node {
    Vec<Gcrs> pole{0, 0, 1};
    Vec<Gcrs> sun_m, sun_m_per_s, moon_m, moon_m_per_s;
  };

  ForceSettings settings_;
  SimTime first_;            // time of the first node
  std::vector<Node> nodes_;  // every node_s
};

}  // namespace dmise
