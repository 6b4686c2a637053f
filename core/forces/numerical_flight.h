#pragma once
#include <string>
#include <vector>

#include "core/forces/flight_forces.h"
#include "core/forces/manoeuvre.h"
#include "core/frames/geodesy.h"
#include "core/orbit/oem.h"

namespace dmise {

struct NumericalFlightSettings {
  double position_tolerance_m = 1e-5;  // error of one step, > 0
  Ellipsoid ellipsoid{};               // a path ends on it
};

/// A path before it is integrated.
struct NumericalFlight {
  double epoch_s = 0.0;  // simulation time of `state`
  MotionState<Gcrs> state;
  double from_s = 0.0, to_s = 0.0;    // simulation times between which it is wanted, from < to
  std::vector<Manoeuvre> manoeuvres;  // in order, none before the epoch or the end of another
};

/// A path that ends before its time, or that begins after it.
struct FlightEnd {
  double at_s = 0.0;
  std::string why;  // "it enters the Earth"
};

/// An integrated path: segments of states in GCRS at the ends of steps, which polynomials of degree
/// 11 join, and between which lie manoeuvres. Times count from simulation time 0.
struct NumericalPath {
  std::vector<OemSegment> segments;  // in order; none if the path has ended before `from_s`
  std::vector<FlightEnd> ends;       // at most one at either side
};

/// Integrates a path by DOP853, whose steps end at manoeuvres and on the ground. The result depends
/// on the arguments alone. Error of a state, against the forces' exact solution: below 1 cm after a
/// day in a low orbit with the default tolerance. A state below the ellipsoid has no path, one that
/// cannot be integrated ends with a reason.
NumericalPath integrate_flight(const FlightForces& forces, const NumericalFlight& flight,
                               const NumericalFlightSettings& settings = {});

}  // namespace dmise
