#pragma once
#include <vector>

#include "core/base/sim_time.h"
#include "core/frames/earth_orientation.h"
#include "core/time/clock.h"

namespace dmise {

/// The Earth's orientation, the Sun and the Moon, tabulated every hour. Immutable; may be shared
/// between threads.
class EarthSurroundings {
 public:
  /// Covers `first_s` to `last_s` of simulation time. Throws `Error` outside 1900 to 2100.
  EarthSurroundings(const Clock& clock, double first_s, double last_s);

  struct At {
    Rotation<Itrs, Gcrs> itrs_from_gcrs;
    Vec<Gcrs> pole;  // axis of the Earth's rotation
    Vec<Gcrs> sun_m, moon_m;
  };
  /// At a simulation time; beyond the span it is less accurate. Interpolation adds 10 m to the Sun
  /// and the Moon and 0.1 mas to the orientation, without daily jumps of UT1.
  At at(double time_s) const;

 private:
  static constexpr double node_s = 3600.0;
  struct Node {
    Rotation<Cirs, Gcrs> cirs_from_gcrs;
    Rotation<Itrs, Tirs> itrs_from_tirs;
    double turn_rad = 0.0;  // Earth rotation angle less earth_turn_rad_per_s times the time
    Vec<Gcrs> sun_m, sun_m_per_s, moon_m, moon_m_per_s;
  };
  double first_s_;
  std::vector<Node> nodes_;
};

}  // namespace dmise
