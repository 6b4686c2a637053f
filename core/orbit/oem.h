#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/orbit/motion_state.h"

namespace dmise {

enum class OemFrame { gcrs, itrs, teme };
/// Axes of the segment at hand, whichever `OemSegment::frame` says.
struct OemAxes {};
enum class OemInterpolation { linear, lagrange, hermite };

/// One segment of a trajectory: between its ephemeris lines it is smooth, from one to the next it
/// may jump (a manoeuvre).
struct OemSegment {
  std::string object_name;
  std::string object_id;
  OemFrame frame = OemFrame::gcrs;
  OemInterpolation interpolation = OemInterpolation::hermite;
  int degree = 7;
  double usable_start_s = 0.0;  // since the trajectory's reference
  double usable_stop_s = 0.0;
  std::vector<double> time_s;            // since the trajectory's reference, increasing
  std::vector<Vec<OemAxes>> position_m;  // in `frame`
  std::vector<Vec<OemAxes>> velocity_m_per_s;
};

/// A trajectory as a CCSDS Orbit Ephemeris Message (502.0-B) gives it.
struct Trajectory {
  std::string source;  // for messages
  Tai reference;       // first ephemeris time
  std::vector<OemSegment> segments;
};

/// Reads an OEM in KVN: geocentric, in ICRF/GCRF, EME2000 (turned to GCRS by the frame bias), ITRF
/// or TEME; times in UTC, TAI, TT or GPS. Without INTERPOLATION the lines are joined by Hermite
/// polynomials of degree 7 on positions and velocities. Covariances are passed over. Throws
/// `ConfigError` `file:line: reason, got "value"`.
Trajectory read_oem(const std::string& path);
Trajectory parse_oem(std::string_view text, const std::string& source);

/// Whether a segment covers `time`; its ends do, to a nanosecond.
bool covers(const Trajectory& trajectory, const Tai& time);

/// First and last time that any segment covers.
struct TrajectorySpan {
  Tai start, stop;
};
TrajectorySpan span_of(const Trajectory& trajectory);

/// "2018-01-21T00:00:00.000 to 2018-01-21T02:00:00.000 UTC", for messages.
std::string span_text(const Trajectory& trajectory);

/// Throws `Error` that names the object and the span when `time` lies outside it.
FramedState state_at(const Trajectory& trajectory, const Tai& time);

/// The same, but the velocity is the slope of the interpolated position: what interpolation between
/// ticks needs. They differ where the file asks for Lagrange or linear interpolation.
FramedState path_at(const Trajectory& trajectory, const Tai& time);

}  // namespace dmise
