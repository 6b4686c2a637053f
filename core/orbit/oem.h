#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/orbit/motion_state.h"

namespace dmise {

enum class OemFrame { gcrs, itrs, teme };
/// Axes of the current segment, which `OemSegment::frame` names.
struct OemAxes {};
enum class OemInterpolation { linear, lagrange, hermite };

/// One segment of a trajectory. It is smooth inside; between segments the trajectory may jump (a
/// manoeuvre).
struct OemSegment {
  std::string object_name;
  OemFrame frame = OemFrame::gcrs;
  OemInterpolation interpolation = OemInterpolation::hermite;
  int degree = 7;
  double usable_start_s = 0.0;  // since the trajectory's reference
  double usable_stop_s = 0.0;
  std::vector<double> time_s;                  // since the trajectory's reference, increasing
  std::vector<Vec<OemAxes>> position_m;        // in `frame`
  std::vector<Vec<OemAxes>> velocity_m_per_s;  // empty: the slopes of the positions
};

/// A trajectory from a file: a CCSDS Orbit Ephemeris Message (502.0-B), an SP3 or a track.
struct Trajectory {
  std::string source;  // for messages
  Tai reference;       // first ephemeris time
  std::vector<OemSegment> segments;
};

/// Reads an OEM in KVN or XML: geocentric, in ICRF/GCRF, EME2000 (rotated to GCRS by the frame
/// bias), ITRF or TEME; times in UTC, TAI, TT, TDB or GPS. Without INTERPOLATION, lines are joined
/// by Hermite polynomials of degree 7 on positions and velocities. A segment of one line covers its
/// instant alone. Covariances are ignored. Throws `ConfigError` `file:line: reason, got "value"`,
/// also if segments differ in OBJECT_NAME or OBJECT_ID.
Trajectory read_oem(const std::string& path);
Trajectory parse_oem(std::string_view text, const std::string& source);

/// Whether a segment covers `time`, ends included, to a nanosecond.
bool covers(const Trajectory& trajectory, const Tai& time);

/// First and last time that any segment covers.
struct TrajectorySpan {
  Tai start, stop;
};
TrajectorySpan span_of(const Trajectory& trajectory);

/// "2018-01-21T00:00:00.000 to 2018-01-21T02:00:00.000 UTC", for messages.
std::string span_text(const Trajectory& trajectory);

/// Throws `Error` with the object and the span if `time` is outside it.
FramedState state_at(const Trajectory& trajectory, const Tai& time);

/// State with the derivative of the interpolated position as velocity, which interpolation
/// between ticks needs. They differ if the file asks for Lagrange or linear interpolation.
FramedState path_at(const Trajectory& trajectory, const Tai& time);

}  // namespace dmise
