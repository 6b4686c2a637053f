#pragma once
#include <memory>
#include <string>

#include "core/forces/numerical_flight.h"
#include "core/time/iso8601.h"

// Flights with which Orekit's are compared.
namespace dmise::test {

/// A flight that Orekit has made, tests/reference/flight_with_orekit.py.
struct OrekitFlight {
  const char* name;
  int degree;
  bool sun_moon;
  double drag_m2_per_kg, radiation_m2_per_kg;
  MotionState<Gcrs> start;
  MotionState<Gcrs> every_six_hours[4];
};
inline constexpr OrekitFlight orekit_flights[] = {
#include "tests/reference/flight_orekit.inc"
};

/// Time 0 of the flights. `finals`: eop/finals2000A.all.gz of the reference data.
inline Clock orekit_clock(const std::string& finals) {
  return Clock(parse_utc("2018-12-24T22:00:00"),
               std::make_shared<const IersTable>(IersTable::read_finals2000a(finals)));
}

inline FlightForces forces_of(const OrekitFlight& flight, const Clock& clock) {
  return {std::make_shared<const EarthSurroundings>(clock, -86400.0, 86400.0),
          {flight.degree, flight.sun_moon, flight.drag_m2_per_kg, flight.radiation_m2_per_kg}};
}

/// The flight that Orekit made, for a day.
inline NumericalFlight flight_of(const OrekitFlight& flight) {
  NumericalFlight out{.state = flight.start, .from_s = 0, .to_s = 86400};
  if (std::string(flight.name) == "manoeuvres")
    out.manoeuvres = {{.at_s = 3600,
                       .duration_s = 600,
                       .thrust_n = 22,
                       .mass_kg = 500,
                       .direction = {0.48, 0.64, -0.6},
                       .specific_impulse_s = 220},
                      {.at_s = 10000, .delta_v_m_per_s = {0.5, -3.0, 2.0}}};
  return out;
}

/// State at a simulation time on a path that is there.
inline MotionState<Gcrs> on_path(const NumericalPath& path, const Clock& clock, double time_s) {
  const Trajectory trajectory{"a flight", clock.tai({0}), path.segments};
  return std::get<MotionState<Gcrs>>(state_at(trajectory, clock.tai(sim_seconds(time_s))));
}

}  // namespace dmise::test
